/// The sparse grids of a surface: a stack of narrow-band level sets. Each level has twice the voxel size of the one
/// before and the same band width in voxels.
#pragma once

#include "alcove/base/types.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alcove {

struct VdbGrid; // an OpenVDB grid (detail/vdb_grid.h), kept out of public headers

/// The meaning of the sign of a grid's distances.
enum class Sign {
    /// Negative inside a solid: closed, consistently oriented surfaces.
    solid,
    /// Negative only up to one and a half voxels behind the faces, so that the surface is a zero crossing when seen
    /// from the front; positive elsewhere on both sides. Suits open, nested, leaking and self-touching surfaces.
    sheet,
};

/// One narrow-band level set. Index space maps to unit space by unit = origin + voxel · index.
struct LevelSet {
    std::shared_ptr<const VdbGrid> grid;
    double voxel = 0.0;      ///< edge of a voxel, unit space
    Vec3d origin{0.0};       ///< centre of the voxel of index (0, 0, 0), unit space; may be far from the surface
    float outer_band = 0.0f; ///< width of the outer band, voxels: values within it are distances
    float inner_band = 0.0f; ///< width of the inner band, voxels; for a sheet both bands count as outside
    std::size_t active_voxels = 0;
    std::size_t bytes = 0; ///< memory of the grid
};

/// Points at whole multiples of `voxel` from `origin` along each axis, scene units. Grids of different meshes on the
/// same lattice can be combined voxel by voxel.
struct Lattice {
    double voxel = 1.0;
    Vec3d origin{0.0};
};

/// Levels from finest to coarsest. Copies share the grids.
///
/// In memory, values are scene units divided by `value_unit`, a power of two near the diagonal. This keeps them in a
/// range that suits floats and OpenVDB, and conversion to scene units and back is exact to the bit.
struct GridStack {
    Frame frame;
    double value_unit = 1.0;
    Sign sign = Sign::solid;
    std::vector<LevelSet> levels;
    /// Levels finer than `levels`, from finest to coarsest, that exist only near walls and gaps thinner than two voxels
    /// of the finest level. A leaf has values if the next leaves along the axes exist, too.
    std::vector<LevelSet> partial{};
    std::optional<Lattice> lattice{};  ///< of all voxel centres, with index (0, 0, 0) at its origin; set if requested
    bool clustered = false;            ///< whether GridOptions::cluster reduced the triangles
    std::vector<std::string> sources;  ///< the names of its grids in the file that it was read from
    std::string creator;               ///< the program that wrote the file, if read from one that names it
    std::vector<std::string> warnings; ///< messages about what was lost in voxelization or reading

    /// Edge of a voxel, scene units; bit for bit the voxel of the lattice, if there is one.
    double scene_voxel(std::size_t level = 0) const;
    /// Largest distance that the last level represents, unit space.
    float reach() const { return (levels.back().outer_band - 1.0f) * static_cast<float>(levels.back().voxel); }
    /// Whether the inner band of every level is as wide as the outer.
    bool knows_inside() const {
        return std::all_of(levels.begin(), levels.end(),
                           [](const LevelSet& level) { return level.inner_band >= 0.999f * level.outer_band; });
    }
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const std::vector<LevelSet>* set : {&levels, &partial})
            for (const LevelSet& level : *set)
                sum += level.bytes;
        return sum;
    }
};

/// The same grids in the unit space of another frame.
GridStack reframed(GridStack stack, const Frame& frame);

/// A position in unit space in double precision.
Vec3d exact_in_unit(const Frame& frame, const Vec3d& scene);

/// The largest power of two not above the diagonal.
double value_unit_of(const Frame& frame);

}
