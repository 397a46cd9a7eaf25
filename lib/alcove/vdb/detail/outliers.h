/// Whether the values of a grid of another program are distances, and of which unit. Internal to grid/.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <cstddef>

namespace alcove {

/// How much values change along a unit of length where they are near 0: 1 for distances in scene units. The median
/// of some thousand voxels, which are cubes of edge `voxel`.
double slope_of(const VdbGrid& grid, double voxel);

/// Active voxels whose values no distances are.
struct Outliers {
    std::size_t count = 0; ///< other than those of their neighbours and the background allow
    std::size_t far = 0;   ///< of these, farther from 0 than the grid is wide
};

/// Looks at every active voxel of a grid of distances whose signs were flood filled. Distances of neighbours along an
/// axis differ by a voxel at most (S. Osher and R. Fedkiw, "Level Set Methods and Dynamic Implicit Surfaces", 2003,
/// ch. 2), and so do those at the ends of the band from what is outside it. Odd is what differs by more than 1.15
/// voxels from two neighbours or by more than 1.5 from one; from three and none where it is 2 voxels or more from 0,
/// as OpenVDB 10 makes bands of 5 voxels and more with steps of up to 2.3 there. Odd is also what lies beyond the
/// background, and beside inactive voxels of the other sign their distance counts from 0.
///
/// Level sets of spheres, and filtered, offset, halved and combined ones, have no outliers voxels; OpenVDB makes up to 8 of
/// them from some closed meshes, more from open ones. On a plane, what is wrong by less than 0.72 voxel is not found, nor
/// by less than 1.15 where it is 2 voxels or more from 0; in tips and gaps narrower than the band, more. Thread-safe; by
/// threads of parallel_for. Cost: an eighth of read_grids().
Outliers outliers_of(const VdbGrid& grid, double voxel);

}
