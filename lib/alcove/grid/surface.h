/// Triangles in voxel units with what an exact signed distance needs: closest points and pseudonormals.
#pragma once

#include "alcove/mesh/mesh.h"

#include <span>
#include <vector>

namespace alcove {

/// A closest point of a triangle.
struct ClosestPoint {
    double distance2 = 0.0;
    /// Dot product of the pseudonormal there with the way from it to the query: its sign is the side.
    double side = 0.0;
};

/// The triangles of a mesh, recentred and scaled so that a voxel is 1, in double precision. Triangles without an
/// area are left out: their edges belong to their neighbours, and a direction they have not.
///
/// Signs by angle-weighted pseudonormals of vertices and edges, coincident vertices joined: J. A. Bærentzen,
/// H. Aanæs, "Signed distance computation using the angle weighted pseudonormal" (2005). Right everywhere for
/// closed oriented surfaces, and near the faces for any surface. Const use is thread-safe.
class Surface {
  public:
    Surface(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame, double voxel);

    std::size_t size() const { return triangles_.size(); }
    const Vec3d& vertex(std::size_t triangle, int corner) const {
        return positions_[triangles_[triangle][static_cast<std::size_t>(corner)]];
    }
    /// Squared distance from `p` to a triangle. C. Ericson, "Real-Time Collision Detection" (2005), 5.1.5.
    double distance2(std::size_t triangle, const Vec3d& p) const;
    ClosestPoint closest(std::size_t triangle, const Vec3d& p) const;

  private:
    struct Nearest {
        Vec3d offset;      // from the closest point to the query
        int feature;       // 0..2 a corner, 3..5 the edge from corner feature − 3 to the next, 6 the face
    };
    Nearest nearest(std::size_t triangle, const Vec3d& p) const;
    void weight_normals(std::span<const std::uint32_t> joined);

    std::vector<Vec3d> positions_;
    std::vector<Triangle> triangles_;
    std::vector<Vec3> face_normals_;   // one a triangle, unit length
    std::vector<Vec3> edge_normals_;   // three a triangle
    std::vector<Vec3> vertex_normals_; // three a triangle
};

}
