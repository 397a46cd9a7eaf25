/// Cuts the faces of a mesh into triangles, for the stages that know nothing else.
///
/// A triangle stays as it is. A polygon is cut in the plane of its Newell normal (Newell 1972, as in
/// Tampieri, "Newell's method for computing the plane equation of a polygon", Graphics Gems III, 1992): as a
/// fan around its first corner where that covers it without overlap (every convex polygon), else by clipping
/// ears (Meisters, "Polygons have ears", 1975). Triangles keep the turning sense of their face. No vertex is
/// added or moved.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

struct Triangulation {
    std::vector<Triangle> triangles; ///< in face order; three different, finite vertices each
    std::size_t faces_left_out = 0;  ///< fewer than three different corners, or a vertex that is not finite
};

/// Triangulates all faces; the result does not depend on the number of threads.
///
/// Corners repeated one after the other count once. Polygons of more than `longest_clipped_polygon` corners
/// that are no fan are cut as one nevertheless: clipping takes the square of the corners. Self-intersecting
/// polygons give as many triangles as simple ones, some of them overlapping. Scale and place of the mesh do
/// not matter. Cost: about 15 ns a face that is a triangle, 50 ns a quad; thread-safe.
Triangulation triangulate(const Mesh& mesh);

inline constexpr std::size_t longest_clipped_polygon = 2048;

}
