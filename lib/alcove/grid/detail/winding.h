/// Finds the voxels inside a surface by counting crossings.
#pragma once

#include "alcove/nearest/nearest.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace alcove {

/// The crossings of the surface with the z-columns through the voxel centres. They give the winding number of a
/// voxel: the crossings below it into the solid minus those out of it.
///
/// Corners are snapped to the finest grid that exact integer arithmetic allows, 2⁻²⁹ of the extent, and a tie-break
/// rule assigns a column through an edge or a corner to one triangle: the crossings of a closed surface always
/// cancel. Const use is thread-safe. Cost: about 5 ns per triangle and 50 ns per crossing.
class WindingColumns {
  public:
    /// `positions` are in index space, with no coordinate below 0. Pass all triangles, even those without area: they
    /// close gaps between their neighbours.
    WindingColumns(std::span<const Vec3d> positions, std::span<const Triangle> triangles);
    /// The same if no finite coordinate x or y exceeds `extent`, which is at least 1.
    WindingColumns(std::span<const Vec3d> positions, std::span<const Triangle> triangles, double extent);

    /// Of the columns with crossings, the share whose crossings do not cancel: 0 for a closed surface.
    double leaking() const;

    /// Whether any winding number is other than 0 or 1.
    bool overlapping() const;

    /// Whether there are crossings, but no winding number above 0 between them: every face is double-sided.
    bool hollow() const;

    /// The share of crossings where the winding number is below 1 on both sides, as at faces that do not bound a solid.
    double in_air() const;

    /// Calls `visit(triangle, bounding)` for each crossing. It is bounding if the winding number is below 1 on exactly
    /// one side.
    void for_each_crossing(const std::function<void(std::uint32_t triangle, bool bounding)>& visit) const;

    /// The voxels of a brick whose winding number is 1 or more, one bit each: one byte per z-row, y fastest. Where the
    /// crossings of a column do not cancel, counting from the bottom and from the top must both give 1 or more.
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

    std::vector<std::size_t> row_begin_; // offsets into crossings_, per x
    std::vector<Crossing> crossings_;    // sorted by x, y, z
};

}
