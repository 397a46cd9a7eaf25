/// What a picture can show, and what it is called.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace alcove {

enum class Pass : std::uint8_t { beauty, ao, depth, normal, position, convexity, shadow, steps, object };

struct PassInfo {
    Pass pass;
    std::string_view name;
    std::string_view channels; ///< of an OpenEXR file
    std::string_view summary;
};

inline constexpr std::array<PassInfo, 9> all_passes{{
    {Pass::beauty, "beauty", "R G B A", "light that the eye sees, multiplied by alpha"},
    {Pass::ao, "ao", "AO.R AO.G AO.B", "visibility, multiplied by alpha"},
    {Pass::depth, "depth", "Z", "along the view axis, scene units; 1e10 where nothing is"},
    {Pass::normal, "normal", "N.X N.Y N.Z", "scene directions; 0 where nothing is"},
    {Pass::position, "position", "P.X P.Y P.Z", "scene units; 0 where nothing is"},
    {Pass::convexity, "convexity", "Convexity.R Convexity.G Convexity.B",
     "0.5 flat, above convex, below concave, multiplied by alpha"},
    {Pass::shadow, "shadow", "Shadow.R Shadow.G Shadow.B",
     "share of the sun that arrives, multiplied by alpha"},
    {Pass::steps, "steps", "Steps.V",
     "map() calls of a ray of the eye, of its own and after the start of its tile"},
    {Pass::object, "object", "Object.V", "number of the object, counted from 1; 0 where nothing is"},
}};

using PassSet = EnumSet<Pass>;

constexpr PassSet operator|(Pass a, Pass b) {
    return PassSet(a) | b;
}

// What must be known of the places of a picture to draw its passes.
constexpr bool need_ao(PassSet wanted) {
    return wanted.has(Pass::ao) || wanted.has(Pass::beauty);
}
constexpr bool need_convexity(PassSet wanted, bool has_edge_colors) {
    return wanted.has(Pass::convexity) || (wanted.has(Pass::beauty) && has_edge_colors);
}
constexpr bool need_shadow(PassSet wanted, bool casts_shadow) {
    return wanted.has(Pass::shadow) || (wanted.has(Pass::beauty) && casts_shadow);
}

/// What is drawn where nobody says what.
inline constexpr PassSet standard_passes = Pass::beauty | Pass::ao | Pass::depth | Pass::normal;

}
