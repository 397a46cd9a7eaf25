/// The triangles of a surface cut to a few voxels, in groups of neighbours.
/// Internal to grid/.
#pragma once

#include "alcove/base/types.h"
#include "alcove/nearest/detail/fragment_leaves.h"

#include <glm/gtc/type_precision.hpp>

#include <span>
#include <vector>

namespace alcove {

using Index3 = glm::i32vec3; ///< a voxel

/// A triangle, or a part of one, no longer than a few voxels: near its origin, so floats hold it to 1e-6
/// voxels wherever in the grid it is.
struct Fragment {
    Index3 origin;          ///< the voxel that corner 0 lies in
    Vec3 corners[3];        ///< from the origin
    std::uint32_t triangle; ///< the one it is of
};

/// Longest side of a fragment, voxels. Longer triangles are cut across their longest sides, so that what a
/// voxel has to look at does not grow with the size of triangles: into half as many fragments as they are voxels long, and a
/// sixth as many as their area has.
inline constexpr double longest_fragment = 4.0;

/// All fragments of a surface, in groups that lie along a Morton curve. Triangles without an area are left out: their edges
/// belong to their neighbours. The result does not depend on the number of threads. Const use is thread-safe. Cost:
/// linear, about 60 ns a fragment, 20 more to ask for it.
class FragmentLeaves {
  public:
    /// `positions` are in index space, none below 0, and finite where a triangle names them; they and the triangles must outlive this.
    FragmentLeaves(std::span<const Vec3d> positions, std::span<const Triangle> triangles);

    std::size_t count() const { return begin_.size() - 1; } ///< of groups
    std::size_t begin(std::size_t group) const { return begin_[group]; }
    Fragment fragment(std::size_t i) const; ///< from begin() of its group to that of the next
    /// Fetches what later fragments are made of, which lies all over memory: to be called with one after the other.
    void expect(std::size_t i) const;

  private:
    std::span<const Vec3d> positions_;
    std::span<const Triangle> triangles_;
    HugeVector<FragmentKey> order_;   // by triangle, or index in parts_ beyond the triangles
    std::vector<Fragment> parts_;     // of triangles that were cut
    HugeVector<std::uint32_t> begin_; // groups + 1 offsets into order_
};

}
