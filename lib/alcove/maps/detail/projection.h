/// Projects points of a low-poly mesh onto the surface of a high-poly mesh.
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/mesh/mesh.h"
#include "alcove/occlusion/occluders.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// A point of the low mesh and the direction in which it is projected.
struct ProjectedFrom {
    Vec3d position{0.0};
    Vec3 direction{0.0f}; ///< outward, unit length
    double front = 0.0;   ///< the inward ray starts this far in front of the position, scene units
};

/// Where a point lies on the high mesh.
struct ProjectedTo {
    SurfacePoint point;  ///< with the normal of the high mesh, smooth except at hard edges
    float height = 0.0f; ///< along the direction, scene units
    bool hit = false;
};

/// The surface of a high mesh, onto which points are projected. `const` use is thread-safe.
class Projection {
  public:
    /// Cost: about 0.3 µs per triangle. Keeps a reference to the mesh.
    Projection(const Mesh& high, NormalSource normals);

    /// For each point, traces a ray inward, from in front of the point to `behind` (scene units) behind it, and finds
    /// the first face that faces outward. Cost: about 0.5 µs per point.
    std::vector<ProjectedTo> project(std::span<const ProjectedFrom> points, double behind) const;
    /// Five times the distance within which 95 % of the points find the surface, in front or behind. Only points that
    /// find it within a tenth of diagonal() count. If there are none, a tenth of diagonal().
    double reach_for(std::span<const ProjectedFrom> points) const;
    double diagonal() const { return frame_.diagonal; }

  private:
    void project_block(std::span<const ProjectedFrom> points, double behind, const Vec2& shift,
                       std::span<ProjectedTo> to) const; // projects those without a hit

    const Mesh& mesh_;
    Frame frame_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> faces_;
    std::vector<std::array<Vec3, 3>> normals_;
    RaySurface surface_; // each triangle has corners of its own, so that a hit identifies it
};

}
