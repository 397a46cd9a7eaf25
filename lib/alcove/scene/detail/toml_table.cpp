#include "alcove/scene/detail/toml_table.h"

#include "alcove/base/detail/edit_distance.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

std::string_view kind(const toml::node& node) {
    switch (node.type()) {
    case toml::node_type::table:
        return "a table";
    case toml::node_type::array:
        return "an array";
    case toml::node_type::string:
        return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return "true or false";
    default:
        return "a date or time";
    }
}

}

TomlTable::TomlTable(const toml::table& table, std::string file, std::string name, std::string path)
    : table_(table), file_(std::move(file)), name_(std::move(name)), path_(std::move(path)) {}

void TomlTable::fail(std::string_view key, const std::string& what, std::string_view between) const {
    const toml::node* node = table_.get(key);
    const auto line = (node ? node->source() : table_.source()).begin.line;
    throw InputError(fmt::format("{}:{}: {}", file_, line,
                                 in_one_line(fmt::format("{}{}{}", key, key.empty() ? "" : between, what))));
}

/// The full name of a table inside this table.
std::string TomlTable::path_of(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

const toml::node* TomlTable::find(std::string_view key) {
    known_.emplace_back(key);
    return table_.get(key);
}

std::optional<double> TomlTable::number(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    const std::optional<double> value = node->value<double>();
    if (!node->is_number() || !value)
        fail(key, fmt::format("takes a number, not {}", kind(*node)));
    if (!std::isfinite(*value))
        fail(key, "takes a finite number");
    return value;
}

std::optional<double> TomlTable::positive(std::string_view key) {
    const std::optional<double> value = number(key);
    if (value && !(*value > 0.0))
        fail(key, fmt::format("takes a number above 0, not {}", *value));
    return value;
}

std::optional<int> TomlTable::count(std::string_view key, int min, int max) {
    const std::optional<double> value = number(key);
    if (!value)
        return {};
    if (*value != std::floor(*value) || *value < min || *value > max)
        fail(key, fmt::format("takes a whole number from {} to {}, not {}", min, max, *value));
    return static_cast<int>(*value);
}

std::optional<bool> TomlTable::flag(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    if (!node->is_boolean())
        fail(key, fmt::format("takes true or false, not {}", kind(*node)));
    return node->value<bool>();
}

std::optional<std::string> TomlTable::text(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    if (!node->is_string())
        fail(key, fmt::format("takes a string, not {}", kind(*node)));
    return node->value<std::string>();
}

std::optional<std::size_t> TomlTable::word(std::string_view key, std::initializer_list<std::string_view> words) {
    const std::optional<std::string> value = text(key);
    if (!value)
        return {};
    const auto found = std::find(words.begin(), words.end(), *value);
    if (found == words.end())
        fail(key, fmt::format("takes one of {}, not \"{}\"", fmt::join(words, ", "), *value));
    return static_cast<std::size_t>(found - words.begin());
}

std::optional<Vec3d> TomlTable::vector(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    const toml::array* array = node->as_array();
    if (!array || array->size() != 3)
        fail(key, fmt::format("takes three numbers: write {} = [1, 2.5, -3]", key));
    Vec3d result;
    for (int axis = 0; axis < 3; ++axis) {
        const toml::node& component = *array->get(static_cast<std::size_t>(axis));
        const std::optional<double> value = component.value<double>();
        if (!component.is_number() || !value || !std::isfinite(*value))
            fail(key, fmt::format("takes three finite numbers: write {} = [1, 2.5, -3]", key));
        result[axis] = *value;
    }
    return result;
}

std::optional<Vec3d> TomlTable::direction(std::string_view key) {
    const std::optional<Vec3d> value = vector(key);
    if (value && *value == Vec3d(0.0))
        fail(key, fmt::format("takes a direction, not [0, 0, 0]: write {} = [0, 1, 0]", key));
    return value;
}

std::optional<Vec3> TomlTable::color(std::string_view key, double max) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    const bool grey = node->is_number();
    const toml::array* array = node->as_array();
    Vec3 result(0.0f);
    bool valid = grey || (array && array->size() == 3);
    for (int channel = 0; valid && channel < 3; ++channel) {
        const toml::node& part = grey ? *node : *array->get(static_cast<std::size_t>(channel));
        const std::optional<double> value = part.value<double>();
        valid = part.is_number() && value && *value >= 0.0 && *value <= max;
        result[channel] = static_cast<float>(value.value_or(0.0));
    }
    if (!valid)
        fail(key, fmt::format("takes linear red, green and blue from 0 to {:g}, or one number for grey: write {} "
                              "= [0.8, 0.5, 0.3]",
                              max, key));
    return result;
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    if (!node->is_table())
        fail(key, fmt::format("takes a table, not {}: write [{}]", kind(*node), path_of(key)));
    return TomlTable(*node->as_table(), file_, fmt::format("[{}]", path_of(key)), path_of(key));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    if (!node->is_array_of_tables())
        fail(key, fmt::format("takes an array of tables: write [[{}]] before each", path_of(key)));
    std::vector<TomlTable> result;
    for (const toml::node& element : *node->as_array())
        result.emplace_back(*element.as_table(), file_, fmt::format("[[{}]]", path_of(key)), path_of(key));
    return result;
}

std::vector<std::pair<std::string, TomlTable>> TomlTable::named_tables() {
    std::vector<std::pair<std::string, TomlTable>> result;
    for (const auto& [key, node] : table_)
        result.emplace_back(key.str(), *table(key.str()));
    return result;
}

void TomlTable::check_all_read() const {
    constexpr std::size_t max_length = 64; // a longer key resembles none of the known keys
    for (const auto& [key, node] : table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) != known_.end())
            continue;
        const std::string_view unknown = key.str().substr(0, max_length);
        const auto nearest = std::min_element(known_.begin(), known_.end(), [&](const auto& a, const auto& b) {
            return edit_distance(unknown, a) < edit_distance(unknown, b);
        });
        throw InputError(fmt::format("{}:{}: unknown key {} in {}; did you mean {}?", file_, key.source().begin.line,
                                     in_one_line(std::string(unknown)), in_one_line(name_), *nearest));
    }
}

}
