/// The level sets of the mesh and .vdb files of a scene. Shapes with the same file and settings share a level set.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/grid/voxelize.h"
#include "alcove/scene/detail/loaded_shapes.h"

#include <compare>
#include <map>

namespace alcove {

/// Settings that the grids of a scene have in common.
struct GridContext {
    Frame frame;         ///< maps unit space to scene space
    float radius;        ///< radius of occlusion, which determines voxels; unit space
    Progress progress{}; ///< progress of one grid
};

class SharedGrids {
  public:
    /// Adds to `memory` what the grids of the shapes take. If the grids do not fit, automatic voxels get coarser.
    /// \throw LimitError if that does not suffice.
    SharedGrids(const std::vector<LoadedShape>& shapes, const GridContext& context, MemoryEstimate& memory);

    /// The field of a mesh or level set in the unit space of the scene. Voxelizes a mesh, and extends a level set to
    /// the reach of the shape. Sets `loaded.stack`, without the OpenVDB grids, and adds the warnings of the grid,
    /// unless another shape already has them. \throw InputError naming the file, as voxelize() and extend_levels();
    /// LimitError as voxelize().
    AnyField field(LoadedShape& loaded);

  private:
    /// A file and the settings of its grid.
    struct Key {
        const void* file;
        SignChoice sign = SignChoice::automatic;
        float largest_voxel = 0.0f, reach = 0.0f, voxel = 0.0f;
        bool inside = false;
        auto operator<=>(const Key&) const = default;
    };
    struct Entry {
        std::size_t users = 0;
        GridStack stack{};
        std::optional<LevelStack> field{}; // set when built; in the frame of the stack if there are several users
    };

    Key key_of(const LoadedShape& loaded) const;
    VoxelizeOptions options_of(const LoadedShape& loaded) const;
    LevelPlan plan_of(const LoadedShape& loaded) const;
    float in_unit_of(const Frame& own, float length, const LoadedShape& loaded) const;
    void share_what_is_left(const std::vector<const LoadedShape*>& automatic, double planned,
                            const MemoryEstimate& memory);
    void voxelize_mesh(LoadedShape& loaded) const;
    void warn_of_mesh(LoadedShape& loaded, const AnyField& field) const;
    void extend_grid(LoadedShape& loaded) const;

    GridContext context_;
    double limit_, limit_of_automatic_; // bytes for a grid
    std::map<Key, Entry> entries_;
};

}
