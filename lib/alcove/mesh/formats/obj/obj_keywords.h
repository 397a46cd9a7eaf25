/// The keywords of OBJ lines (Wavefront 1993), including the superseded ones.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace alcove {

/// Keywords of lines that are kept as text only.
inline constexpr std::array<std::string_view, 40> obj_text_keywords{
    "usemtl",    "mtllib", "g",      "o",     "s",        "l",        "p",    "vp",     "mg",     "deg",
    "bmat",      "step",   "cstype", "curv",  "curv2",    "surf",     "parm", "trim",   "hole",   "scrv",
    "sp",        "end",    "con",    "bevel", "c_interp", "d_interp", "lod",  "maplib", "usemap", "shadow_obj",
    "trace_obj", "ctech",  "stech",  "call",  "csh",      "res",      "bzp",  "bsp",    "cdc",    "cdp"};

/// The index of a keyword in `obj_text_keywords`.
std::optional<std::size_t> obj_text_keyword(std::string_view keyword);

/// Whether lines with this keyword name other files.
bool names_files(std::string_view keyword);

/// Whether an unknown keyword is one of `v`, `vt`, `vn` and `f` with any characters before it, or with a number
/// directly after it.
bool hides_data_keyword(std::string_view keyword);

}
