/// Nearest triangles to the voxels of a brick, exactly. Internal to grid/.
///
/// A block of voxels keeps the part of the tree of which something may be nearest to one of them, by what is known
/// to be near its centre. Blocks inherit it from the block eight times their size, down to 2³ voxels, which look
/// into what is left. No approximation is made, so neither the order of triangles nor the shape of the surface
/// matter to the result.
#pragma once

#include "alcove/nearest/detail/triangle_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alcove {

using Nodes = std::vector<std::uint32_t>; ///< of a TriangleTree

/// A cube of voxels of a level whose voxels are `stride` apart in the tree's units.
struct Block {
    Index3 low; ///< voxel of the level
    int size;   ///< voxels along a side
    int stride;
};

inline constexpr int brick_size = 8;
/// Of voxels along z, y fastest: a byte each in masks.
inline constexpr std::size_t brick_rows = std::size_t{brick_size} * brick_size;
inline constexpr int brick_volume = brick_size * brick_size * brick_size;

/// Per voxel of a brick, z fastest.
struct NearestTriangles {
    float distance2[brick_volume];        ///< squared, in the tree's units; infinite where it is not known
    std::uint32_t triangle[brick_volume]; ///< where nearest_triangles() found the distance
};

/// Splits a block in eight, x slowest. Parts get what of the nodes is within `reach` (tree's units) of
/// one of their voxels and can be nearest to it; nodes large beside them are replaced by their children.
/// Thread-safe.
void split(const TriangleTree& tree, const Nodes& nodes, const Block& block, float reach,
           std::array<Nodes, 8>& parts);

/// How far to look, tree's units, at voxels inside (a bit of `rows`, one a z-row) and outside.
struct BrickLimits {
    const std::uint8_t* rows;
    float outer, inner;
};

/// Finds the distances within the limits that `nearest` does not hold yet. `nodes` as split() gave them for the brick.
/// Thread-safe. Cost: 100 ns a voxel within the limits where a triangle is in a voxel, 500 where twenty are.
void nearest_triangles(const TriangleTree& tree, const Nodes& nodes, const Block& brick,
                       const BrickLimits& limits, NearestTriangles& nearest);

}
