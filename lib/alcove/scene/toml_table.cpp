#include "alcove/scene/toml_table.h"

#include "alcove/edit_distance.h"
#include "alcove/errors.h"

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
        return "a text";
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

TomlTable::TomlTable(const toml::table& table, std::string file, std::string name)
    : table_(table), file_(std::move(file)), name_(std::move(name)) {}

void TomlTable::fail(std::string_view key, const std::string& what) const {
    const toml::node* node = table_.get(key);
    const auto line = (node ? node->source() : table_.source()).begin.line;
    throw InputError(fmt::format("{}:{}: {}{}{}", file_, line, key, key.empty() ? "" : " ", what));
}

const toml::node* TomlTable::find(std::string_view key) {
    asked_.emplace_back(key);
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

std::optional<int> TomlTable::count(std::string_view key, int least, int most) {
    const std::optional<double> value = number(key);
    if (!value)
        return {};
    if (*value != std::floor(*value) || *value < least || *value > most)
        fail(key, fmt::format("takes a whole number from {} to {}, not {}", least, most, *value));
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
        fail(key, fmt::format("takes a text, not {}", kind(*node)));
    return node->value<std::string>();
}

std::optional<std::size_t> TomlTable::word(std::string_view key,
                                           std::initializer_list<std::string_view> words) {
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

std::optional<Vec3> TomlTable::color(std::string_view key) {
    const toml::node* node = table_.get(key);
    const std::optional<Vec3d> value =
        node && node->is_number() ? std::optional(Vec3d(*number(key))) : vector(key);
    if (!value)
        return {};
    if (value->x < 0.0 || value->y < 0.0 || value->z < 0.0)
        fail(key, "takes no number below 0: red, green and blue of linear light, 1 is white");
    return Vec3(*value);
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    if (!node->is_table())
        fail(key, fmt::format("takes a table, not {}: write [{}]", kind(*node), key));
    return TomlTable(*node->as_table(), file_, fmt::format("[{}]", key));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
    const toml::node* node = find(key);
    if (!node)
        return {};
    if (!node->is_array_of_tables())
        fail(key, fmt::format("takes tables: write [[{}]] before each", key));
    std::vector<TomlTable> result;
    for (const toml::node& element : *node->as_array())
        result.emplace_back(*element.as_table(), file_, fmt::format("[[{}]]", key));
    return result;
}

std::vector<std::pair<std::string, TomlTable>> TomlTable::named_tables() {
    std::vector<std::pair<std::string, TomlTable>> result;
    for (const auto& [key, node] : table_)
        result.emplace_back(key.str(), *table(key.str()));
    return result;
}

void TomlTable::check_all_read() const {
    for (const auto& [key, node] : table_) {
        const std::string_view unknown = key.str();
        if (std::find(asked_.begin(), asked_.end(), unknown) != asked_.end())
            continue;
        const auto nearest =
            std::min_element(asked_.begin(), asked_.end(), [&](const auto& a, const auto& b) {
                return edit_distance(unknown, a) < edit_distance(unknown, b);
            });
        throw InputError(fmt::format("{}:{}: there is no key {} in {}; did you mean {}?", file_,
                                     key.source().begin.line, unknown, name_, *nearest));
    }
}

}
