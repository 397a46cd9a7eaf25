/// The field of a grid stack: each distance comes from the finest level whose band contains it.
#pragma once

#include "alcove/field/field.h"
#include "alcove/grid/grid_stack.h"

#include <memory>
#include <vector>

namespace alcove {

class Bricks; // one level, in a layout for fast sampling (field/detail/bricks.h)

/// Distances in unit space, interpolated trilinearly on the finest level whose band contains them. Saturated values and
/// the last voxel of a band are used only if no coarser level has the distance. Beyond the last band the result is a
/// lower bound: the end of that band, or the distance to the bounding box of the surface. The same applies inside if
/// GridStack::knows_inside(); otherwise, distances inside reach only to the end of the finest band. If the caller needs
/// distances only up to `reach`, a single level is sampled, either the finest or one whose voxel is at most half of
/// `reach`. Partial levels replace the distances in their bands.
///
/// Copies share the bricks; const use is thread-safe. Models BatchedField.
class LevelStack {
  public:
    /// Reads every grid of the stack; the stack itself is not needed afterwards.
    explicit LevelStack(const GridStack& stack);

    float map(const Vec3& p) const;
    void map(const Points& points, float reach, float* distances) const;

    /// Edge of the finest voxel.
    float resolution() const;
    /// Whether the stack is a sheet.
    bool two_sided() const { return two_sided_; }
    float extent() const;
    /// The largest distance that is not just a bound.
    float reach() const;
    const std::vector<Bricks>& levels() const { return *levels_; }
    std::size_t bytes() const;

  private:
    std::size_t level_for(float reach) const;
    /// Whether a distance on a level is cut off at the end of the band.
    bool cut(float distance, float usable) const {
        return distance >= usable || (knows_inside_ && distance <= -usable);
    }
    void escalate(const Points& points, float* distances) const;
    void refine(const Points& points, float* distances) const;

    std::shared_ptr<const std::vector<Bricks>> levels_;
    std::shared_ptr<const std::vector<Bricks>> partial_; // from coarsest to finest
    bool two_sided_, knows_inside_;
};

}
