/// The triangles of a mesh in UV space and on the surface.
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/maps/detail/charts.h"
#include "alcove/maps/detail/projection.h"
#include "alcove/maps/detail/rasterize.h"
#include "alcove/maps/detail/tangent_frames.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"

#include <span>
#include <string>
#include <vector>

namespace alcove {

/// The UDIM tile whose lower left corner is (u, v) has the number 1001 + u + 10 v.
inline constexpr int first_udim = 1001, udims_per_row = 10;

struct UvFacesOptions {
    NormalSource normals = NormalSource::automatic;
    int uv_set = 0;
    std::span<const std::uint8_t> wanted{}; ///< empty, or 1 for each face to include
};

/// The triangles of a mesh that have usable UVs. `const` use is thread-safe.
class UvFaces {
  public:
    /// \throw InputError if the mesh does not have the set of UVs.
    UvFaces(const Mesh& mesh, const UvFacesOptions& options);

    std::span<const UvTriangle> uvs() const { return uvs_; }
    /// The number of triangles with an area whose UVs are unusable or have no area.
    std::size_t without_texels() const { return without_texels_; }
    /// The face of a triangle.
    std::uint32_t face(std::uint32_t triangle) const { return faces_[triangle]; }
    /// The point of a triangle with the barycentric coordinates `weights`. The length of its normal may differ from 1.
    SurfacePoint point(std::uint32_t triangle, const Vec3d& weights) const;
    /// Computes what chart() needs.
    void add_charts();
    std::uint32_t chart(std::uint32_t triangle) const { return charts_[triangle]; }
    /// Computes what projected_from() needs.
    void add_directions();
    /// The point of a triangle, ready to be projected. The direction is the mean of the normals around its vertices,
    /// which leaves no gaps at hard edges; the ray starts `front` in front of the point. If there is a cage, the ray
    /// starts at the cage and is directed at the point.
    ProjectedFrom projected_from(std::uint32_t triangle, const Vec3d& weights, double front) const;
    /// Sets the cage: a copy of the mesh whose vertices are moved outward. Keeps a reference to it. \throw InputError
    /// if it has a different number of vertices, or if no vertex has moved.
    void set_cage(const Mesh& cage);
    /// Computes what to_tangent() needs.
    void add_tangents();
    /// Converts a direction to the frame that shaders interpolate between the corners. Zero if the frame is degenerate.
    Vec3 to_tangent(std::uint32_t triangle, const Vec3d& weights, const Vec3& direction) const;
    /// The numbers of the UDIM tiles that triangles reach, in ascending order; only 1001 without `udim`.
    std::vector<int> tiles(bool udim) const;
    /// Warnings about triangles that were left out, and about triangles outside the tiles.
    std::vector<std::string> warnings(bool udim) const;

  private:
    const Mesh& mesh_;
    std::vector<UvTriangle> uvs_;
    std::vector<std::uint32_t> faces_;
    std::vector<Triangle> vertices_;
    std::vector<std::array<Vec3, 3>> normals_;
    std::vector<TangentTriangle> tangents_;
    std::vector<std::uint32_t> charts_;
    std::vector<Vec3> vertex_normals_;
    const Mesh* cage_ = nullptr;
    std::size_t without_texels_ = 0;
    std::size_t unusable_ = 0, flat_ = 0; // triangles left out: UVs not finite or far away; no UV area
};

}
