/// Exact reference values for grids: closest points by Embree, the inside by the winding number.
#pragma once

#include "alcove/mesh/mesh.h"

#include <embree3/rtcore.h>

#include <span>

namespace alcove::test {

/// Exact distances, signs and occlusion of a mesh, all in unit space.
class ExactSurface {
  public:
    ExactSurface(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame);
    ~ExactSurface();
    ExactSurface(const ExactSurface&) = delete;
    ExactSurface& operator=(const ExactSurface&) = delete;

    /// Unsigned distance; the final point-triangle distances are evaluated in double.
    double distance(const Vec3& p) const;

    /// Generalised winding number: 1 inside, 0 outside a closed surface. The sum of the solid angles of all
    /// triangles (Van Oosterom and Strackee 1983).
    double winding_number(const Vec3& p) const;

    /// The reference occlusion: the share of `rays` cosine-weighted directions that are open within `radius`,
    /// two-sided.
    double visibility(const Surfel& surfel, float radius, int rays) const;

    /// The normalized mean of the open directions; zero if there is none.
    Vec3d bent_normal(const Surfel& surfel, float radius, int rays) const;

    /// A point of the given triangle, uniformly distributed for uniform u, v in [0, 1).
    Vec3 point(std::size_t triangle, float u, float v) const;
    std::size_t size() const { return triangles_.size(); }

  private:
    /// Calls open(direction) for each ray that hits nothing.
    template <class Open>
    void cast(const Surfel& surfel, float radius, int rays, Open open) const;
    static bool query(RTCPointQueryFunctionArguments* arguments);

    std::vector<Vec3d> positions_;
    std::vector<Triangle> triangles_;
    RTCDevice device_;
    RTCScene scene_;
};

}
