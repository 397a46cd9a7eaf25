/// The normals of a mesh, and its vertices as surfels.
///
/// The area-weighted normal of a vertex is the direction of the sum of the cross products of its triangles
/// (Gouraud's average, weighted by area). It is zero where that sum is shorter than 1e-12 of the sum of its
/// terms' lengths; a triangle whose sides leave its first corner at a sine below `flat_sine` has no area and
/// no say.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

enum class NormalSource {
    automatic, ///< the file's, and where it has none (or a zero one) the area-weighted normal
    file,      ///< the file's; zero where the file has zero
    area,      ///< area-weighted
};

/// What rounding leaves of the sine between two sides in line.
inline constexpr double flat_sine = 1e-14;

/// At unit length, of whatever length it is; zero where it is zero or not finite.
Vec3 unit_or_zero(const Vec3d& n);

/// The power of two that brings the diagonal of the mesh near 1: scaling by it rounds nothing.
double exact_scale(const Mesh& mesh);

/// One a vertex: unit length, or zero where no triangle uses the vertex or its triangles cancel.
///
/// Sums run in double, in units of the diagonal of the mesh, in triangle order: neither scale nor the number
/// of threads matters. Triangles hold finite vertices only (as triangulate() gives). Cost: linear, about
/// 30 ns a triangle.
std::vector<Vec3> area_weighted_normals(const Mesh& mesh, std::span<const Triangle> triangles);

/// One a vertex: its place in the unit space of `frame` and its normal. A vertex that is not finite is at the
/// origin and without a normal. \throw InputError if `source` is `file` and the mesh has no normals.
std::vector<Surfel> make_surfels(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame,
                                 NormalSource source = NormalSource::automatic);

}
