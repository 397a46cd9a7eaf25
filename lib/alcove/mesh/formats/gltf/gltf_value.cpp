#include "alcove/mesh/formats/gltf/gltf_value.h"

#include "alcove/base/detail/messages.h"

#include <fmt/format.h>

#include <cmath>

namespace alcove {

void GltfValue::fail(std::string_view message) const {
    file_->fail(fmt::format("{}: {}", place_.empty() ? "the JSON" : place_, message));
}

GltfValue GltfValue::operator[](const char* key) const {
    if (!json_->is_object())
        fail("is not an object; export the file again");
    const auto found = json_->find(key);
    if (found == json_->end())
        fail(fmt::format("has no {}; export the file again", key));
    return {*file_, *found, place_.empty() ? key : fmt::format("{}.{}", place_, key)};
}

std::optional<GltfValue> GltfValue::find(const char* key) const {
    if (!has(key))
        return {};
    return (*this)[key];
}

GltfValue GltfValue::element(std::size_t i) const {
    if (i >= size())
        fail(fmt::format("has no element {}; export the file again", i));
    return {*file_, (*json_)[i], fmt::format("{}[{}]", place_, i)};
}

std::size_t GltfValue::size() const {
    if (!json_->is_array())
        fail("is not an array; export the file again");
    return json_->size();
}

std::size_t GltfValue::count() const {
    constexpr double limit = 281474976710656.0; // 2^48: sums and products with a stride stay in range
    if (json_->is_number()) {
        const double value = json_->get<double>(); // some exporters write 3.0
        if (value >= 0.0 && value < limit && value == std::floor(value))
            return static_cast<std::size_t>(value);
    }
    fail(fmt::format("is not a whole number: {}; export the file again", in_quotes(json_->dump())));
}

std::size_t GltfValue::index(std::size_t limit) const {
    const std::size_t value = count();
    if (value >= limit)
        fail(fmt::format("is {}, but there are only {}; export the file again", value, limit));
    return value;
}

double GltfValue::number() const {
    if (!json_->is_number())
        fail("is not a number; export the file again");
    return json_->get<double>();
}

bool GltfValue::flag() const {
    if (!json_->is_boolean())
        fail("is not true or false; export the file again");
    return json_->get<bool>();
}

const std::string& GltfValue::text() const {
    if (!json_->is_string())
        fail("is not a string; export the file again");
    return json_->get_ref<const std::string&>();
}

std::size_t GltfValue::count_or(const char* key, std::size_t missing) const {
    return has(key) ? (*this)[key].count() : missing;
}

std::string GltfValue::text_or(const char* key, std::string_view missing) const {
    return has(key) ? (*this)[key].text() : std::string(missing);
}

GltfValue GltfValue::target(const GltfValue& root, const char* array) const {
    if (!root.has(array))
        fail(fmt::format("refers to {}, but the file has none; export it again", array));
    const GltfValue all = root[array];
    return all[index(all.size())];
}

}
