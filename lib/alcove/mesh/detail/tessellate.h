/// Splits large faces, so that vertex values can represent details within them.
///
/// A triangle is split along the line from the midpoint of its longest edge to the opposite corner (Rivara 1984), as in
/// OpenMesh's LongestEdgeT. An edge is split in all faces that use it, even if it is non-manifold, so no vertex ends up
/// inside an edge.
#pragma once

#include "alcove/mesh/mesh.h"

#include <array>
#include <cstddef>
#include <functional>

namespace alcove {

struct TessellateOptions {
    double longest = 0.0;               ///< longest edge that is not split, scene units; 0: no limit
    std::size_t most_faces = 4'000'000; ///< of the result; the longest edges are split first
};

/// Splits all edges longer than `longest`.
///
/// The existing vertices keep their indices and positions. The new ones follow; each is the midpoint of an edge. A face
/// that is split is replaced by triangles of the same orientation. The other faces are kept: polygons with no side
/// longer than `longest` and all corners within twice that distance of the first corner, and faces with a non-finite
/// vertex or fewer than three distinct vertices.
///
/// Normals, texture coordinates, vertex colours and attributes are interpolated; face colours are copied. If the mesh
/// was read from a PLY file, its other properties are also kept: numeric properties of vertices are interpolated and
/// rounded to the type of the property, list properties of vertices are copied from the nearest vertex, and properties
/// of faces are copied. Contents of an OBJ or glTF file that a Mesh does not represent are lost. If nothing is split,
/// the mesh stays unchanged.
///
/// \return the mesh, with additional warnings about lost data and about edges that stay too long because of
/// `most_faces`.
/// \throw InputError if the length is negative or NaN, or the mesh has infinite extent.
/// Cost: about 0.5 µs per new face, several times that if `most_faces` takes effect; single-threaded.
Mesh tessellate(const Mesh& mesh, const TessellateOptions& options);

/// A point on an edge or a face, and its weights for interpolation between other points.
struct PointBetween {
    Vec3d position; ///< scene units
    /// Unit length or zero: interpolated if the mesh has normals, otherwise the area-weighted normal of the faces
    /// around the point.
    Vec3 normal;
    std::uint32_t face; ///< index in the mesh; for an edge, one of its faces
    /// Numbers below Mesh::vertex_count() are vertices. The number vertex_count() + i is the i-th point that was passed
    /// to the predicate, counted over all calls.
    std::array<std::uint32_t, 3> ends;
    Vec3d weights; ///< of `ends`; their sum is 1, and the last one is 0 on an edge
};

/// Returns for each point whether its edge or face should be split. Each call passes up to about 262,144 points.
using SplitPredicate = std::function<std::vector<bool>(std::span<const PointBetween>)>;

struct AdaptiveTessellateOptions {
    double shortest = 0.0; ///< edges up to this length are not split, scene units; limits the splits at discontinuities
    /// Approximate distance between tested points, scene units, with at most 63 points per edge. 0: one point per edge
    /// and one per face.
    double spacing = 0.0;
    std::size_t most_faces = 4'000'000; ///< of the result; in the last round, the longest edges are split first
};

/// Splits edges and faces until `split` returns false for all their points.
///
/// An edge is split if `split` returns true for one of its points. The longest edge of a face is split if `split`
/// returns true for a point inside the face, and whenever another edge of the face is split, so that angles are bounded
/// from below. Each edge and face is tested once. The rest is as in the overload above.
///
/// \throw InputError as the overload above; std::invalid_argument if the predicate does not return one value per point;
/// any exception of the predicate. Cost: about 3 µs per new face, in addition to the predicate; single-threaded.
Mesh tessellate(const Mesh& mesh, const SplitPredicate& split, const AdaptiveTessellateOptions& options);

}
