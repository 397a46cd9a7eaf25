/// A tile of a map that is being baked, and the order of its texels.
#pragma once

#include "alcove/maps/detail/rasterize.h"
#include "alcove/maps/detail/uv_faces.h"
#include "alcove/maps/maps.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alcove {

/// A tile that is being baked.
struct OpenTile {
    const UvFaces* faces = nullptr;
    UvTile uvs{};
    TexelOwners owners;
    MapTile map;
    std::vector<std::uint16_t> counts{}; ///< samples per texel
    std::vector<std::uint8_t> wanted{};  ///< 1 for texels of a face
    bool is_sparse = false;              ///< texels between samples are interpolated, see texels_around()
    int sampled_rows = 0;                ///< rows from the top whose samples have been taken
    int interpolated_rows = 0;           ///< rows whose texels between samples have been interpolated
};

/// The texels from which one is interpolated.
struct TexelsAround {
    std::array<std::size_t, 4> texels;
    std::size_t count = 0; ///< 0 if it is not interpolated
};

/// A texel in an odd row or column is interpolated from its two or four neighbours in even ones, if they are in its
/// chart.
TexelsAround texels_around(const OpenTile& tile, std::size_t texel);

/// Interpolates texels whose neighbours differ by at most `tolerance`, in the rows whose neighbours have values, and
/// adds their number to `count`. \return the other texels between samples
std::vector<std::uint32_t> interpolate_between(OpenTile& tile, float tolerance, std::size_t& count);

struct TexelCounts {
    std::size_t covered = 0; ///< texels with a value
    std::size_t missed = 0;  ///< texels of faces without one
};

/// Turns sums into means, and fills the margin and texels that were missed.
TexelCounts finish(OpenTile& tile, const MapOptions& options, bool has_tangents);

/// Visits the texels of a tile block by block, so that texels nearby on the surface are nearby in memory. Also passes
/// the number of rows from the top that are complete.
template <class Visit>
void each_texel_in_blocks(const UvTile& tile, const Visit& visit) {
    constexpr int side = 64;
    for (int top = 0; top < tile.height; top += side)
        for (int left = 0; left < tile.width; left += side)
            for (int y = top; y < std::min(top + side, tile.height); ++y)
                for (int x = left; x < std::min(left + side, tile.width); ++x)
                    visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.width) +
                              static_cast<std::size_t>(x),
                          top);
}

}
