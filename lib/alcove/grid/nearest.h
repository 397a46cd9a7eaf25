/// Nearest triangles to the voxels of a brick, exactly. Internal to grid/.
///
/// A block of voxels keeps the part of the tree that can be nearest to one of them: what is no further from
/// its centre than the nearest bounds are sure to be, plus its diameter. Blocks inherit it from the block
/// eight times their size, down to the voxel, which looks into what is left. No approximation is made, so
/// neither the order of triangles nor the shape of the surface matter to the result.
#pragma once

#include "alcove/grid/triangle_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alcove {

/// A cube of voxels of a level whose voxels are `stride` apart in the tree's units.
struct Block {
    Index3 low; ///< voxel of the level
    int size;   ///< voxels along a side
    int stride;
};

/// What can be nearest somewhere in a block.
struct Candidates {
    std::vector<std::uint32_t> nodes; ///< slots of TriangleTree::bounds: eight times the group, plus the slot
    std::uint32_t nearest = 0;        ///< of these or above, the one to look at first
};

inline constexpr int brick_size = 8;
/// Of voxels along z, y fastest: a byte each in masks.
inline constexpr std::size_t brick_rows = std::size_t{brick_size} * brick_size;
inline constexpr int brick_volume = brick_size * brick_size * brick_size;

/// Per voxel of a brick, z fastest.
struct NearestTriangles {
    float distance2[brick_volume];        ///< squared, in the tree's units; infinite beyond the limit
    std::uint32_t triangle[brick_volume]; ///< where the distance is finite
};

/// Splits a block in eight, x slowest. Parts get what of the candidates is within `reach` (tree's units) of
/// one of their voxels and can be nearest to it; nodes large beside them are replaced by their children.
/// Thread-safe.
void split(const TriangleTree& tree, const Candidates& from, const Block& block, float reach,
           std::array<Candidates, 8>& parts);

/// How far to look, tree's units, at voxels inside (a bit of `rows`, one a z-row) and outside.
struct BrickLimits {
    const std::uint8_t* rows;
    float outer, inner;
};

/// `from` as split() gave them for a brick. Thread-safe. Cost: 200 to 400 ns a voxel within the limits.
void nearest_triangles(const TriangleTree& tree, const Candidates& from, const Block& brick,
                       const BrickLimits& limits, NearestTriangles& out);

}
