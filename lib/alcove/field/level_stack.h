/// The field of a grid stack: each distance from the finest level that knows it.
#pragma once

#include "alcove/field/field.h"
#include "alcove/grid/grid_stack.h"

#include <memory>
#include <vector>

namespace alcove {

class Bricks; // one level as the sampler reads it (field/detail/bricks.h)

/// Distances in unit space, trilinear on the finest level whose band holds them: neither saturated values nor
/// the last voxel of a band are ever returned while a coarser level knows better. Beyond the last band the
/// answer is a lower bound: the end of that band, or the distance to the box around the surface. Inside, all this holds
/// where every level knows the inside as far as the outside; else the end of the finest band is the answer. A probe known to be no further than `reach`
/// from the surface reads the one level made for that height, its voxel at most half of it.
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
    /// Whether it is that of a sheet.
    bool two_sided() const { return two_sided_; }
    float extent() const;
    /// Largest distance that is right.
    float reach() const;
    const std::vector<Bricks>& levels() const { return *levels_; }
    std::size_t bytes() const;

  private:
    std::size_t level_for(float reach) const;
    /// Whether a value of a level is only the end of its band.
    bool cut(float distance, float usable) const {
        return distance >= usable || (knows_inside_ && distance <= -usable);
    }
    void escalate(const Points& points, float* distances) const;

    std::shared_ptr<const std::vector<Bricks>> levels_;
    bool two_sided_, knows_inside_;
};

}
