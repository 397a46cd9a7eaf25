/// Bakes several UV layouts of one mesh at once, so that they share its grids.
#pragma once

#include "alcove/maps/maps.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// The most texels along a side of a map.
inline constexpr int largest_map = 16384;

/// Faces that share a texture.
struct UvLayout {
    int uv_set = 0;
    std::vector<std::uint8_t> wanted; ///< empty, or 1 for each face that belongs to the layout
};

/// Like bake_maps(), but with the tiles of all layouts, in order. Without UDIM, each layout has one tile. The uv_set of
/// the options has no effect.
BakedMaps bake_layouts(const Mesh& mesh, const BakeOptions& bake, const MapOptions& options,
                       std::span<const UvLayout> layouts);

}
