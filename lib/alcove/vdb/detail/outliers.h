/// Checks whether the values of a grid that another program wrote are distances, and in which unit.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <cstddef>

namespace alcove {

/// How much values change per unit of length near the zero isosurface: 1 for distances in scene units. This is the
/// median over a few thousand voxels, which must be cubes of edge `voxel`.
double slope_of(const VdbGrid& grid, double voxel);

/// Counts active voxels whose values are not distances.
struct Outliers {
    std::size_t count = 0; ///< inconsistent with their neighbours or the background
    std::size_t far = 0;   ///< among these, larger than the extent of the grid
};

/// Defects of the active tiles of a grid: blocks of 8³ voxels and more with one value.
struct Tiles {
    std::size_t at_surface = 0;    ///< tiles next to a value of the other sign: the surface has no voxels there
    std::size_t voxels_within = 0; ///< voxels of tiles whose value is within the band
};

/// Makes active tiles inactive, with plus or minus the background as value: in a level set, tiles only distinguish
/// inside from outside. Cost: linear in the tiles, and in the nodes next to active ones.
Tiles simplify_tiles(const VdbGrid& grid);

/// Checks every active voxel of a grid of distances whose signs were flood-filled. Along an axis, the distances of
/// neighbours differ by at most one voxel (Osher and Fedkiw 2003, ch. 2); this also holds between the ends of the band
/// and the values just outside it. A value within 2 voxels of 0 is an outlier if it differs by more than 1.15 voxels
/// from two neighbours or by more than 1.5 voxels from one. Other values are outliers if they differ by more than 1.15
/// voxels from three neighbours; the 1.5-voxel test does not apply to them, because in bands of 5 voxels or more
/// OpenVDB 10 produces steps of up to 2.3 voxels at such values. Values farther from 0 than the background may be
/// valid, since some grids store distances throughout the inside. Next to an inactive voxel of the other sign, a value
/// is compared with 0.
///
/// Level sets of spheres have no outliers, nor do level sets that were filtered, offset, combined or saved as half
/// floats. Level sets that OpenVDB creates from closed meshes may have up to 8 outliers, those from open meshes more.
/// On a plane, errors below 0.72 voxel are not detected, nor are errors below 1.15 voxels in values that are 2 voxels
/// or more from 0; in tips and gaps narrower than the band, larger errors are missed too. Thread-safe; uses the threads
/// of parallel_for. Cost: an eighth of read_grids().
Outliers outliers_of(const VdbGrid& grid, double voxel);

}
