/// The sparse grids of a surface: narrow-band level sets of one surface, each with twice the voxel of the one
/// before and the same band counted in voxels.
#pragma once

#include "alcove/base/types.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace alcove {

struct VdbGrid; // an OpenVDB grid (grid/vdb.h), kept out of public headers

/// What the sign of a grid's distances says.
enum class Sign {
    /// Negative inside a solid: closed, consistently oriented surfaces.
    solid,
    /// Negative only up to a voxel and a half behind the faces, so that the surface still is a zero crossing seen
    /// from the front; positive elsewhere on both sides. Right for open, nested, leaking and self-touching surfaces.
    sheet,
};

/// One narrow-band level set. Where its index space lies in unit space: unit = origin + voxel · index.
struct LevelSet {
    std::shared_ptr<const VdbGrid> grid;
    float voxel = 0.0f;      ///< edge of a voxel, unit space
    Vec3 origin{0.0f};       ///< centre of the voxel of index (0, 0, 0), unit space
    float outer_band = 0.0f; ///< voxels from the surface outward where values are distances
    float inner_band = 0.0f; ///< the same inward; of a sheet both are air
    std::size_t active_voxels = 0;
    std::size_t bytes = 0; ///< memory of the grid
};

/// Levels from finest to coarsest. Copies share the grids.
///
/// In memory values are scene units divided by `value_unit`, a power of two near the diagonal: of a size that
/// floats and OpenVDB are good at, and yet written as scene units and read again to the same bits.
struct GridStack {
    Frame frame;
    double value_unit = 1.0;
    Sign sign = Sign::solid;
    std::vector<LevelSet> levels;
    bool clustered = false; ///< of fewer triangles than the surface has, as GridOptions::cluster has it
    std::string creator;    ///< the program that wrote the file these were read from, if it says so
    std::vector<std::string> warnings; ///< what the surface lost on its way into the grid, in words

    /// Largest distance, unit space, that the last level holds.
    float reach() const { return (levels.back().outer_band - 1.0f) * levels.back().voxel; }
    /// Whether every level knows the inside as far as the outside.
    bool knows_inside() const {
        return std::all_of(levels.begin(), levels.end(), [](const LevelSet& level) {
            return level.inner_band >= 0.999f * level.outer_band;
        });
    }
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const LevelSet& level : levels)
            sum += level.bytes;
        return sum;
    }
};

/// The same grids in the unit space of another frame.
GridStack reframed(GridStack stack, const Frame& frame);

/// The largest power of two that is not above the diagonal.
double value_unit_of(const Frame& frame);

}
