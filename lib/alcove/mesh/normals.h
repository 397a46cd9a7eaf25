/// Computes the normals of a mesh, and its vertices as surfels.
///
/// The normal of a vertex is the normalized mean of the normals of its triangles (Gouraud 1971), weighted either by
/// their angles at the vertex (Thürmer and Wüthrich 1998), so that it does not depend on how faces are triangulated, or
/// by their areas. It is zero if the weighted sum is shorter than 1e-12 times the sum of the lengths of its terms. A
/// triangle whose sides meet at its first corner with a sine of `flat_sine` or less counts as having no area and is
/// ignored.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

enum class NormalSource {
    automatic, ///< those of the file; angle-weighted where these are missing or zero
    file,      ///< those of the file, even where they are zero
    angle,     ///< angle-weighted
    area,      ///< area-weighted
};

/// The rounding error of the sine between two collinear sides.
inline constexpr double flat_sine = 1e-14;

/// Normalizes a vector of any length. Returns zero if the vector is zero or not finite.
Vec3 unit_or_zero(const Vec3d& n);

/// The power of two that scales the diagonal of the mesh to near 1. Scaling by it is exact.
double exact_scale(const Mesh& mesh);

/// One normal per vertex: unit length, or zero if no triangle uses the vertex or the normals of its triangles cancel.
///
/// Sums are in double, in units of the diagonal of the mesh and in triangle order, so the result depends neither on the
/// scale nor on the number of threads. All vertices of the triangles must be finite, as those of triangulate() are.
/// Cost: linear, about 80 ns per triangle with weights by angle, 30 ns by area.
std::vector<Vec3> angle_weighted_normals(const Mesh& mesh, std::span<const Triangle> triangles);
std::vector<Vec3> area_weighted_normals(const Mesh& mesh, std::span<const Triangle> triangles);

/// One surfel per vertex: the vertex's position in the unit space of `frame`, and its normal. A vertex that is not
/// finite, or that no face uses (in a mesh that has faces), gives a surfel at the origin without a normal. \throw
/// InputError if `source` is `file` and the mesh has no normals.
std::vector<Surfel> make_surfels(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame,
                                 NormalSource source = NormalSource::automatic);

}
