/// Determines on which side of its nearest triangle a point is.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// Angle-weighted pseudonormals of faces, edges and vertices (Bærentzen and Aanæs 2005), with
/// coincident vertices joined. The sign is correct near the faces of any surface. Ignores triangles without area.
/// Const use is thread-safe.
class Pseudonormals {
  public:
    /// Positions and triangles must outlive this object.
    Pseudonormals(std::span<const Vec3d> positions, std::span<const Triangle> triangles);

    /// Negative if `p` is behind `triangle`, its nearest one; 0 if the nearest point is on the boundary of an open
    /// surface, where there are no sides.
    double side(std::size_t triangle, const Vec3d& p) const;

  private:
    void weight_normals();

    std::span<const Vec3d> positions_;
    std::span<const Triangle> triangles_;
    std::vector<std::uint32_t> joined_; // the first vertex at the same position, per vertex
    std::vector<Vec3> face_normals_;    // one per triangle, unit length or zero
    std::vector<Vec3> edge_normals_;    // three per triangle; zero on the boundary
    std::vector<Vec3> vertex_normals_;  // one per joined vertex; zero on the boundary
};

}
