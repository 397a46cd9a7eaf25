#include "alcove/mesh/formats/obj/obj_keywords.h"

#include <algorithm>

namespace alcove {

std::optional<std::size_t> obj_text_keyword(std::string_view keyword) {
    const auto* const known = std::find(obj_text_keywords.begin(), obj_text_keywords.end(), keyword);
    if (known == obj_text_keywords.end())
        return {};
    return static_cast<std::size_t>(known - obj_text_keywords.begin());
}

bool names_files(std::string_view keyword) {
    constexpr std::array<std::string_view, 4> keywords{"mtllib", "maplib", "shadow_obj", "trace_obj"};
    return std::find(keywords.begin(), keywords.end(), keyword) != keywords.end();
}

bool hides_data_keyword(std::string_view keyword) {
    constexpr std::array<std::string_view, 4> data{"vt", "vn", "v", "f"};
    constexpr std::string_view numeric = "0123456789+-.";
    return std::any_of(data.begin(), data.end(), [&](std::string_view word) {
        return keyword.ends_with(word) || (keyword.starts_with(word) && keyword.size() > word.size() &&
                                           numeric.find(keyword[word.size()]) != std::string_view::npos);
    });
}

}
