/// Triangulates the faces of a mesh.
///
/// A triangle is kept. A polygon is cut in the plane of its Newell normal (Newell et al. 1972; Tampieri 1992): into a
/// fan around its first corner if the fan covers the polygon without overlap, as in every convex polygon, otherwise by
/// ear clipping (Meisters 1975). Triangles keep the orientation of their face. No vertex is added or moved.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

struct Triangulation {
    std::vector<Triangle> triangles; ///< in face order; three distinct, finite vertices each
    std::size_t faces_left_out = 0;  ///< fewer than three distinct corners, or a vertex that is not finite
};

/// Triangulates all faces; the result does not depend on the number of threads.
///
/// Consecutive repeated corners count once. A self-intersecting polygon gives as many triangles as a simple one, some
/// of them overlapping. The result does not depend on the scale and position of the mesh. Thread-safe. Cost: about
/// 15 ns per triangle, 50 ns per quad, and n log n for n corners of a polygon.
Triangulation triangulate(const Mesh& mesh);

/// For each triangle of triangulate(mesh), the index of its face. Cost: that of triangulate() on one thread.
std::vector<std::uint32_t> faces_of_triangles(const Mesh& mesh);

/// For each triangle of triangulate(mesh), the indices into Mesh::corners of its corners. Cost: that of triangulate()
/// on one thread.
std::vector<Triangle> corners_of_triangles(const Mesh& mesh);

}
