/// The triangles of a surface cut to a few voxels, in an order in which neighbours lie side by side.
/// Internal to grid/.
#pragma once

#include "alcove/types.h"

#include <glm/gtc/type_precision.hpp>

#include <span>
#include <vector>

namespace alcove {

using Index3 = glm::i32vec3; ///< a voxel

/// A triangle, or a part of one, no longer than a few voxels: near its origin, so floats hold it to 1e-6
/// voxels wherever in the grid it is.
struct Piece {
    Index3 origin;          ///< the voxel that corner 0 lies in
    Vec3 corners[3];        ///< from the origin; the longest side runs from corner 1 to corner 2
    std::uint32_t triangle; ///< the one it is of
};

/// Longest side of a piece, voxels. Longer triangles are cut across their longest sides, so that what a
/// voxel has to look at does not grow with the size of triangles.
inline constexpr double longest_piece = 4.0;

/// Pieces in groups of neighbours.
struct GroupedPieces {
    static constexpr std::size_t largest_group = 8;

    std::vector<Piece> pieces;
    std::vector<std::uint32_t> begin; ///< groups + 1 offsets into `pieces`
};

/// All pieces along a Morton curve (G. M. Morton, 1966), grouped by the cells of the octree that the curve
/// runs through, so that no group spans a jump of the curve. `positions` are in index space, none below 0;
/// triangles without an area are left out: their edges belong to their neighbours. The result does not depend
/// on the number of threads. Cost: linear, about 150 ns a piece.
GroupedPieces grouped_pieces(std::span<const Vec3d> positions, std::span<const Triangle> triangles);

}
