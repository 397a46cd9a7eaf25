/// Inside and outside of a surface at the voxels, by counting: internal to grid/.
#pragma once

#include "alcove/nearest/nearest.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace alcove {

/// Where the surface crosses the z-columns through the voxel centres, and so its winding number there: the
/// crossings below, those from outside to inside less the others.
///
/// Corners are snapped to a grid as fine as exact integer arithmetic allows, 2⁻²⁹ of the extent, and a column
/// through an edge or a corner belongs to one side by rule: the crossings of a closed surface always cancel.
/// Const use is thread-safe. Cost: about 5 ns a triangle and 50 ns a crossing.
class WindingColumns {
  public:
    /// `positions` in index space, none below 0. All triangles take part, without an area too: they close
    /// what their neighbours leave.
    WindingColumns(std::span<const Vec3d> positions, std::span<const Triangle> triangles);

    /// The share of the columns with crossings in which these do not cancel: 0 for a closed surface.
    double leaking() const;

    /// Whether the winding number is anything but 0 and 1 somewhere.
    bool overlapping() const;

    /// Whether there are crossings, and nowhere a winding number above 0 between them: faces are there from both sides.
    bool hollow() const;

    /// Calls `visit(triangle, bounding)` for each crossing; bounding are those between a winding number below
    /// 1 and one from 1 on.
    void for_each_crossing(const std::function<void(std::uint32_t triangle, bool bounding)>& visit) const;

    /// The voxels of winding number 1 and more of a block of brick_size³, a bit each: one byte a z-row, y
    /// fastest. In columns that do not cancel, those of which this is so counted from either end.
    std::array<std::uint8_t, brick_rows> inside(const Block& brick) const;

  private:
    struct Crossing {
        double z;
        std::uint32_t y, triangle;
        std::int32_t turn; // +1 into the solid, upward
    };
    template <class Visit>
    void for_each_column(Visit&& visit) const;
    static std::vector<Crossing>::const_iterator column_from(std::vector<Crossing>::const_iterator begin,
                                                             std::vector<Crossing>::const_iterator end,
                                                             std::uint32_t y);

    std::vector<std::size_t> row_begin_; // of each x in crossings_
    std::vector<Crossing> crossings_;    // by x, y, z
};

}
