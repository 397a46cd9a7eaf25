/// Tiles of a map while they are baked, and the order of their texels.
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

/// A tile of a map whose texels do not all have values yet.
struct OpenTile {
    const UvFaces* faces = nullptr;
    UvTile uvs{};
    TexelOwners owners;
    MapTile map;
    std::vector<std::uint16_t> counts{};    ///< samples per texel
    std::vector<std::uint8_t> wanted{};     ///< 1 for texels of a face
    int stride = 1;                         ///< texels from one sample to the next, see texels_around()
    int sampled_rows = 0;                   ///< rows from the top whose samples have values
    std::array<int, 2> interpolated_rows{}; ///< rows done at the distances 1 and 2
};

/// The distance between samples, in texels, for a map with the RMSE `error`. It grows with the number of covered
/// texels, and with their number per triangle.
int stride_of_samples(std::size_t covered_texels, std::size_t triangles, float error);

/// The distances, along the row and along the column, to the texels from which a texel is interpolated. If one of the
/// distances is 0, there are two such texels, otherwise four. If both are 0, the texel is not interpolated.
struct TexelsAround {
    std::size_t across = 0, down = 0;

    bool any() const { return across > 0 || down > 0; }
};

/// Finds the largest power of two that divides both the column and the row of a texel. If this is less than the stride,
/// the texel is interpolated from neighbours at this distance, provided that they are in its chart.
TexelsAround texels_around(const OpenTile& tile, std::size_t x, std::size_t y);

/// Interpolates the texels in the rows whose neighbours have values, from large distances to small, and adds their
/// number to `count`. \return texels whose neighbours differ by more than `tolerance`, all at one distance. These
/// texels must get values before the next call, which continues with the next distance. Empty if no texels are left.
std::vector<std::uint32_t> interpolate_between(OpenTile& tile, float tolerance, std::size_t& count);

struct TexelCounts {
    std::size_t covered = 0; ///< texels with a value
    std::size_t missed = 0;  ///< texels of faces without a value
};

/// Turns sums into means, and fills the margin and the missed texels.
TexelCounts finish(OpenTile& tile, const MapOptions& options, bool has_tangents);

/// Visits the texels of a tile block by block, so that texels nearby on the surface are nearby in memory. Passes the
/// column, the row, and the number of rows from the top that are complete.
template <class Visit>
void each_texel_in_blocks(const UvTile& tile, const Visit& visit) {
    constexpr std::size_t side = 64;
    const auto width = static_cast<std::size_t>(tile.width), height = static_cast<std::size_t>(tile.height);
    for (std::size_t top = 0; top < height; top += side)
        for (std::size_t left = 0; left < width; left += side)
            for (std::size_t y = top; y < std::min(top + side, height); ++y)
                for (std::size_t x = left; x < std::min(left + side, width); ++x)
                    visit(x, y, static_cast<int>(top));
}

}
