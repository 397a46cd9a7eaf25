/// Whether the values of a grid of another program are distances, and of which unit. Internal to grid/.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <cstddef>

namespace alcove {

/// How much values change along a unit of length where they are near 0: 1 for distances in scene units. The median
/// of some thousand voxels, which are cubes of edge `voxel`.
double slope_of(const VdbGrid& grid, double voxel);

/// Active voxels whose values no distances are.
struct Doubts {
    std::size_t odd = 0; ///< other than those of their neighbours and the background allow
    std::size_t far = 0; ///< of these, farther from 0 than the grid is wide
};

/// Looks at every active voxel of a grid of distances whose signs were flood filled. Distances of neighbours along an
/// axis differ by a voxel at most (S. Osher and R. Fedkiw, "Level Set Methods and Dynamic Implicit Surfaces", 2003,
/// ch. 2), those at the ends of the band from what is outside it, too. Odd is what differs by more than 1.15 voxels from two neighbours, or by more than 1.5 from one, of three and none where
/// it is 2 voxels or more from 0; so is what is that far from 0 beside inactive voxels of the other sign, and what is
/// beyond the background. Level sets that OpenVDB 10 makes, filters, offsets, combines and halves have steps of up to
/// 1.4 voxels, in bands of 5 voxels and more of up to 2.3, but few or none of these. On a plane, what is wrong by
/// less than 0.72 voxel is not found, nor by less than 1.15 where it is 2 voxels or more from 0; in tips and gaps
/// narrower than the band, more. Thread-safe; by threads of parallel_for. Cost: a tenth of read_grids().
Doubts doubts_of(const VdbGrid& grid, double voxel);

}
