/// The occluders of a target as triangles and as fields, each built on first use.
#pragma once

#include "alcove/bake/detail/target.h"

#include <map>

namespace alcove {

class TargetOccluders {
  public:
    TargetOccluders(const BakeTarget& target, Surroundings& surroundings, bool keep_grid, const BakeProgress& progress)
        : target_(target), surroundings_(surroundings), keep_grid_(keep_grid), progress_(progress) {}

    /// The triangles of the target and its surroundings.
    const RaySurface& rays();
    /// `largest_voxel` as in GridOptions; ignored if the target has a grid. \throw LimitError if the grid does not fit
    /// in memory.
    const AnyField& field(float largest_voxel);
    Occluders get(OccluderNeeds needs, float largest_voxel);

    /// The summary of the field that get() or field() returned last. It has no levels if get() returned only triangles.
    const GridSummary& summary() const { return current_ ? current_->summary : none_; }
    const std::vector<std::string>& warnings() const { return current_ ? current_->warnings : no_warnings_; }
    /// Moves out the level sets of a field. \pre `keep_grid`
    GridStack take_stack(float largest_voxel);
    double seconds() const { return seconds_; } ///< wall-clock seconds spent on building

  private:
    struct BuiltField {
        AnyField field;
        GridSummary summary;
        GridStack stack; ///< only if `keep_grid`
        std::vector<std::string> warnings;
    };
    BuiltField build(float largest_voxel);

    const BakeTarget& target_;
    Surroundings& surroundings_;
    bool keep_grid_;
    const BakeProgress& progress_;
    std::optional<RaySurface> rays_;
    std::map<float, BuiltField> fields_; ///< by largest voxel
    BuiltField* current_ = nullptr;
    double seconds_ = 0.0;
    GridSummary none_;
    std::vector<std::string> no_warnings_;
};

GridSummary summary_of(const GridStack& stack);

}
