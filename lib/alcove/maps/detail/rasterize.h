/// Finds the triangle of each texel.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// The UVs of a triangle's corners.
using UvTriangle = std::array<Vec2, 3>;

inline constexpr float furthest_uv = 100.0f;
inline constexpr int most_texels = 1 << 15;
inline constexpr std::uint32_t no_triangle = ~std::uint32_t{0};

/// The texels of one tile, row by row from the top, where v is 1.
struct TexelOwners {
    int width = 0, height = 0;
    std::vector<std::uint32_t> triangles; ///< per texel, or no_triangle
    std::size_t overlaps = 0;             ///< texels whose centre lies in several triangles

    std::size_t size() const { return triangles.size(); }
};

/// A tile: the unit square of UVs whose lower left corner is `corner`.
struct UvTile {
    int width, height; ///< texels
    Vec2 corner{0.0f};
};

/// A texel belongs to the first triangle that contains its centre, else to the first that touches it at all, so that
/// textures have no gaps at the borders of islands. Shared edges do not overlap. Cost: about 3 ns per texel and 1 ns
/// per triangle and row, however many triangles overlap.
/// \pre all UVs are finite and within `furthest_uv` of 0; a tile has at most `most_texels` along each side
TexelOwners rasterize(std::span<const UvTriangle> triangles, const UvTile& tile);

/// The barycentric coordinates of the point of a triangle, in UV space, that is nearest to the centre of a texel. \pre
/// the triangle has an area
Vec3d weights_at(const UvTriangle& triangle, const UvTile& tile, std::size_t texel);

}
