/// On which side of its nearest triangle a point is. Internal to grid/.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// Angle-weighted pseudonormals of faces, edges and vertices, coincident vertices joined: J. A. Bærentzen,
/// H. Aanæs, "Signed distance computation using the angle weighted pseudonormal" (2005). Right near the faces
/// of any surface. Triangles without an area take no part. Const use is thread-safe.
class Pseudonormals {
  public:
    /// Positions and triangles must outlive this.
    Pseudonormals(std::span<const Vec3d> positions, std::span<const Triangle> triangles);

    /// The sign of the side of `triangle`, the nearest to `p`: negative behind it; 0 at the rim of an open
    /// surface, which has no side.
    double side(std::size_t triangle, const Vec3d& p) const;

  private:
    struct Nearest {
        Vec3d offset; // from the closest point to the query
        int feature;  // 0..2 a corner, 3..5 the edge from corner feature − 3 to the next, 6 the face
    };
    Nearest nearest(std::size_t triangle, const Vec3d& p) const;
    void weight_normals();

    std::span<const Vec3d> positions_;
    std::span<const Triangle> triangles_;
    std::vector<std::uint32_t> joined_; // of each vertex: the first of those at its place
    std::vector<Vec3> face_normals_;    // one a triangle, unit length or zero
    std::vector<Vec3> edge_normals_;    // three a triangle; zero at a rim
    std::vector<Vec3> vertex_normals_;  // one a joined vertex; zero at a rim
};

}
