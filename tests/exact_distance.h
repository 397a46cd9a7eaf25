/// Exact answers to hold grids against: closest points by Embree, inside and outside by the winding number.
#pragma once

#include "alcove/mesh/mesh.h"

#include <embree3/rtcore.h>

#include <span>

namespace alcove::test {

/// Everything in unit space.
class ExactSurface {
  public:
    ExactSurface(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame);
    ~ExactSurface();
    ExactSurface(const ExactSurface&) = delete;
    ExactSurface& operator=(const ExactSurface&) = delete;

    /// Unsigned distance; the final point-triangle distances are evaluated in double.
    double distance(const Vec3& p) const;

    /// Generalised winding number: 1 inside, 0 outside a closed surface. A. Van Oosterom, J. Strackee, "The
    /// solid angle of a plane triangle" (1983), summed over all triangles.
    double winding_number(const Vec3& p) const;

    /// The reference occlusion: visibility of `rays` cosine-weighted directions within `radius`, two-sided.
    double visibility(const Surfel& surfel, float radius, int rays) const;

    /// The mean of those directions that are open, unit length; zero where none is.
    Vec3d bent_normal(const Surfel& surfel, float radius, int rays) const;

    /// A point of the surface: of the given triangle, at barycentric coordinates from u, v in [0, 1).
    Vec3 point(std::size_t triangle, float u, float v) const;
    std::size_t size() const { return triangles_.size(); }

  private:
    /// Calls open(direction) for each of the rays that meets nothing.
    template <class Open>
    void cast(const Surfel& surfel, float radius, int rays, Open open) const;
    static bool query(RTCPointQueryFunctionArguments* arguments);

    std::vector<Vec3d> positions_;
    std::vector<Triangle> triangles_;
    RTCDevice device_;
    RTCScene scene_;
};

}
