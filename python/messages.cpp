#include "messages.h"

#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/channels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <string_view>
#include <utility>

namespace alcove::python {
namespace {

/// Arguments of bake(), bake_maps() and add() that have the same names as options of the program.
constexpr std::array<std::string_view, 24> arguments{
    "attributes", "color",   "error",      "ground", "high",   "margin", "method", "normals",
    "point_size", "quality", "radius",     "reach",  "seed",   "sign",   "size",   "space",
    "subsamples", "threads", "time_limit", "up",     "uv_set", "via",    "voxel",  "weld"};
/// Options of the program that have other names in the module.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> others{{{"max_memory", "limit_memory()"},
                                                                               {"max_read", "limit_reading()"},
                                                                               {"occluder", "occluders"},
                                                                               {"rays", "parameters[\"rays\"]"},
                                                                               {"samples", "parameters[\"samples\"]"},
                                                                               {"self", "self_only"},
                                                                               {"set", "parameters"}}};

template <class Range, class T>
bool contains(const Range& range, const T& value) {
    return std::find(std::begin(range), std::end(range), value) != std::end(range);
}

/// Whether a word after an option is the value of the option, rather than the next word of the sentence.
bool is_value(const std::string& word) {
    constexpr std::array<std::string_view, 9> words{"auto", "file", "angle", "area", "grid",
                                                    "mesh", "none", "solid", "sheet"};
    return std::isdigit(static_cast<unsigned char>(word.front())) != 0 || contains(words, word) ||
           std::any_of(channels.begin(), channels.end(), [&](const auto& channel) { return channel.name == word; }) ||
           std::any_of(catalog().begin(), catalog().end(), [&](const auto& method) { return method.name == word; });
}

bool is_number(const std::string& word) {
    return word.find_first_not_of("0123456789.e+-") == std::string::npos;
}

/// The argument of the module that corresponds to an option. \param value empty if there is none
std::string argument_for(const std::string& option, const std::string& value) {
    std::string name = option;
    std::replace(name.begin(), name.end(), '-', '_');
    const std::string known_value = is_number(value) ? value : '"' + value + '"';
    if (contains(arguments, name)) {
        if (name == "voxel" && value == "auto")
            return "voxel=None";
        return value.empty() ? name : name + "=" + known_value;
    }
    const auto* const other =
        std::find_if(others.begin(), others.end(), [&](const auto& pair) { return pair.first == name; });
    if (other == others.end())
        return "the program's --" + option + (value.empty() ? "" : " " + value);
    return std::string(other->second) + (value.empty() ? "" : "=" + known_value);
}

}

std::string in_python(const std::string& message) {
    static const std::regex option("--([a-z]+(?:-[a-z]+)*)(?: ([a-z_]+|[0-9][0-9.e+-]*(?:%|vx)?))?");
    std::string result;
    std::size_t copied = 0;
    for (std::sregex_iterator found(message.begin(), message.end(), option), end; found != end; ++found) {
        const std::string next = found->str(2), value = !next.empty() && is_value(next) ? next : "";
        const auto at = static_cast<std::size_t>(found->position());
        result.append(message, copied, at - copied);
        result += argument_for(found->str(1), value);
        copied = at + 2 + found->str(1).size() + (value.empty() ? 0 : 1 + value.size());
    }
    return result.append(message, copied);
}

std::vector<std::string> in_python(std::vector<std::string> messages) {
    for (std::string& message : messages)
        message = in_python(message);
    return messages;
}

}
