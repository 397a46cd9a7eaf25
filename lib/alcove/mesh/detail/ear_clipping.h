/// Cuts polygons in the plane into triangles by ear clipping (Meisters 1975).
#pragma once

#include "alcove/mesh/detail/corner_tree.h"
#include "alcove/mesh/detail/number_set.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// Clips one polygon after another and reuses its buffers. Cost: about n log n for n corners.
class EarClipper {
  public:
    /// Triangulates a counterclockwise outline with an extent of about 1. Returns triangles of corner indices, two
    /// fewer than the outline has corners. Where the outline crosses itself, some triangles overlap. The result is
    /// valid until the next call.
    std::span<const std::array<std::uint32_t, 3>> clip(std::span<const glm::dvec2> outline);

  private:
    double turn_at(std::size_t i) const;
    bool is_convex(std::size_t i) const;
    bool is_ear(std::size_t i) const;
    void link();
    void clip_ear(std::size_t i);
    void update_ear(std::size_t i);
    void find_ears(std::size_t start);
    std::size_t sharpest_from(std::size_t start) const;

    std::span<const glm::dvec2> outline_;
    std::vector<std::uint32_t> previous_, next_;
    std::vector<char> is_reflex_;
    CornerTree reflex_; ///< corners that are not convex: only these can be inside an ear
    NumberSet ears_;
    bool may_touch_ = false; ///< whether corners may lie on the sides of an ear, for outlines that touch themselves
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}
