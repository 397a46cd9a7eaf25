/// Triangles in voxel units with what an exact signed distance needs: closest points and pseudonormals.
#pragma once

#include "alcove/mesh/mesh.h"

#include <span>
#include <vector>

namespace alcove {

/// A closest point of a triangle.
struct ClosestPoint {
    double distance2 = 0.0;
    /// Dot product of the pseudonormal there with the way from it to the query: its sign is the side. 0 at
    /// the rim of an open surface, which has none.
    double side = 0.0;
};

/// The triangles of a mesh in index space, index = (unit − origin) / voxel, in double precision. Triangles
/// without an area are left out: their edges belong to their neighbours, and a direction they have not.
///
/// Signs by angle-weighted pseudonormals of vertices and edges, coincident vertices joined: J. A. Bærentzen,
/// H. Aanæs, "Signed distance computation using the angle weighted pseudonormal" (2005). Right everywhere for
/// closed oriented surfaces, and near the faces for any surface. Const use is thread-safe.
class Surface {
  public:
    Surface(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame, const Vec3d& origin,
            double voxel);

    std::size_t size() const { return triangles_.size(); }
    const Vec3d& vertex(std::size_t triangle, int corner) const {
        return positions_[triangles_[triangle][static_cast<std::size_t>(corner)]];
    }
    /// Squared distance from `p` to a triangle. C. Ericson, "Real-Time Collision Detection" (2005), 5.1.5.
    double distance2(std::size_t triangle, const Vec3d& p) const;
    ClosestPoint closest(std::size_t triangle, const Vec3d& p) const;

    /// A triangle at least as near to `p`, found by walking from `triangle` to the nearest of those around
    /// its nearest corner until none is nearer. Finds what neighbouring voxels do not know where triangles
    /// are much smaller than a voxel.
    std::size_t descend(std::size_t triangle, const Vec3d& p) const;

  private:
    struct Nearest {
        Vec3d offset; // from the closest point to the query
        int feature;  // 0..2 a corner, 3..5 the edge from corner feature − 3 to the next, 6 the face
    };
    Nearest nearest(std::size_t triangle, const Vec3d& p) const;
    void weight_normals();
    void collect_rings();

    std::vector<Vec3d> positions_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> joined_;     // of each vertex: the first of those at its place
    std::vector<Vec3> face_normals_;        // one a triangle, unit length
    std::vector<Vec3> edge_normals_;        // three a triangle; zero at a rim
    std::vector<Vec3> vertex_normals_;      // one a joined vertex; zero at a rim
    std::vector<std::uint32_t> ring_begin_; // where the triangles around a joined vertex begin in ring_
    std::vector<std::uint32_t> ring_;
};

}
