#include "facts.h"

#include "alcove/base/detail/messages.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove::cli {
namespace {

constexpr std::size_t label_width = 14;

nlohmann::ordered_json triple(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

}

void Facts::add(const std::string& key, nlohmann::ordered_json value, const std::vector<std::string>& lines) {
    json_[key] = std::move(value);
    std::string label = key;
    std::replace(label.begin(), label.end(), '_', ' ');
    for (const std::string& line : lines) {
        text_ += fmt::format("  {:<{}}{}\n", label, label_width, in_one_line(line));
        label.clear();
    }
}

void Facts::add_count(const std::string& key, std::size_t count) {
    add(key, count, grouped(count));
}

void Facts::add_box(const Box& box) {
    const Vec3d size = box.empty() ? Vec3d(0.0) : box.max - box.min;
    if (box.empty()) {
        add("box", nullptr, "empty");
    } else {
        add("box", {{"min", triple(box.min)}, {"max", triple(box.max)}},
            fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", box.min.x, box.min.y, box.min.z,
                        box.max.x, box.max.y, box.max.z));
        add("size", triple(size), fmt::format("{:.6g} x {:.6g} x {:.6g}", size.x, size.y, size.z));
    }
}

nlohmann::ordered_json Facts::json(const std::string& file) const {
    nlohmann::ordered_json all{{"file", file}};
    all.update(json_);
    return all;
}

std::string Facts::text(const std::string& file) const {
    return fmt::format("{}: {}\n{}", in_one_line(file), json_.at("kind").get<std::string>(), text_);
}

}
