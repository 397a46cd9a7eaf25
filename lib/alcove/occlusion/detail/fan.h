/// Many triangles around one vertex, in a tree sorted by direction.
///
/// The bounding boxes of long thin triangles around a vertex overlap so much that the cost of a ray through a tree of
/// such boxes is proportional to the number of triangles. Seen from that vertex, however, each triangle is a short arc
/// of directions, and a ray is an arc too.
#pragma once

#include "alcove/base/types.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alcove {

/// The part of a ray from `near` to `far`; `far` may be infinite.
struct RaySegment {
    Vec3d origin, direction;
    double near, far;
};

class Fan {
  public:
    struct Hit {
        std::uint32_t triangle; ///< index into triangles()
        double distance;
        Vec3d weights; ///< barycentric coordinates
        Vec3d normal;  ///< not normalised
    };

    /// The first corner of each triangle is the hub, which all triangles share. Triangles must be finite and have an
    /// area.
    Fan(std::span<const Vec3> positions, std::vector<Triangle> triangles);

    const std::vector<Triangle>& triangles() const { return triangles_; }

    /// Whether find() looks for the nearest hit or for any hit. Cost of find(): logarithmic in the number of triangles,
    /// if they are thin.
    enum class Wanted { nearest, any };
    std::optional<Hit> find(const RaySegment& ray, Wanted wanted) const;

  private:
    /// The other two corners of a triangle, relative to the hub.
    struct Arc {
        Vec3d a, b;
    };
    /// A box around the directions of arcs. The first child follows its parent in the array.
    struct Node {
        Vec3d center, half;
        std::uint32_t begin, end;
        std::uint32_t second = 0; ///< second child; 0: a leaf
    };
    struct Search;

    void add_node(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order,
                  std::span<const Arc> directions);
    std::optional<Hit> hit(std::uint32_t triangle, const RaySegment& from_hub) const;

    Vec3d hub_{0.0};
    double reach2_ = 0.0; ///< square of the distance from the hub to the farthest corner
    std::vector<Triangle> triangles_;
    std::vector<Arc> arcs_; ///< one per triangle
    std::vector<Node> nodes_;
};

/// The fewest triangles around a vertex for which a Fan is faster than the BVH.
inline constexpr std::size_t smallest_fan = 8192;

/// Fans around all vertices that have at least `smallest_fan` triangles. If there are any fans, `others` gets the
/// remaining triangles. The fans leave out triangles that no ray can hit. Cost if there are no fans: about 2 ns per
/// triangle.
std::vector<Fan> fans_of(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         std::vector<Triangle>& others);

}
