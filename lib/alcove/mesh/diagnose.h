/// What a mesh is as a surface: closed or open, oriented, manifold, and what in it is broken.
///
/// Edges and components are those of the surface, not of the index list: vertices at exactly the same place
/// are joined first, corners repeated one after the other count once, and faces with fewer than three corners
/// left or with a vertex that is not finite take no part. Polygons count as they are, not as triangles.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

/// What a bake needs to know about inside and outside.
struct Closedness {
    std::size_t edges = 0;
    std::size_t open_edges = 0;          ///< used by one face
    std::size_t non_manifold_edges = 0;  ///< used by three faces or more
    std::size_t flipped_edges = 0;       ///< used by two faces, both running it the same way
    std::size_t odd_edges = 0;           ///< used by one, three, ... faces: rims, walls that end on others
    std::size_t unbalanced_edges = 0;    ///< run more often one way than the other: all odd and flipped ones
    std::size_t components = 0;          ///< sets of faces connected across edges
    std::size_t closed_components = 0;   ///< without an unbalanced edge
    std::size_t inverted_components = 0; ///< closed, of negative volume: inside out, or a cavity
    double signed_volume = 0.0;          ///< of the closed components, cubic scene units

    /// Whether the surface parts space in inside and outside, whichever way its faces turn.
    bool watertight() const { return components > 0 && odd_edges == 0; }
    /// Whether it does and the faces agree on the side: as many run each edge one way as the other.
    bool closed() const { return components > 0 && unbalanced_edges == 0; }
    bool oriented() const { return flipped_edges == 0; }
};

struct Diagnosis : Closedness {
    std::size_t vertices = 0;
    std::size_t faces = 0; ///< all, sound or not
    std::size_t triangles = 0;
    std::size_t quads = 0;
    std::size_t larger_polygons = 0;
    std::size_t boundary_edges = 0;        ///< used by one face, before coincident vertices are joined
    std::size_t boundary_loops = 0;        ///< closed chains of open edges: holes, or rims of a sheet
    std::size_t non_manifold_vertices = 0; ///< where fans of faces touch in nothing but the vertex
    std::size_t degenerate_faces = 0;      ///< fewer than three corners at different places, or no area
    std::size_t duplicate_faces = 0;       ///< on the same set of places as a face before them
    std::size_t coincident_vertices = 0;   ///< at exactly the place of a vertex before them
    std::size_t unreferenced_vertices = 0; ///< in no face
    std::size_t non_finite_vertices = 0;

    /// Boundary edges that close when coincident vertices are joined.
    std::size_t seam_edges() const { return boundary_edges > open_edges ? boundary_edges - open_edges : 0; }
};

/// The part of diagnose() that tells inside from outside: about 0.15 µs a triangle.
Closedness closedness(const Mesh& mesh);

/// The whole examination, about 0.3 µs a triangle. Never refuses what a Mesh may hold; thread-safe.
Diagnosis diagnose(const Mesh& mesh);

/// What of it matters for a bake and the mend, one line each; a single line for a sound mesh.
std::vector<std::string> describe(const Diagnosis& diagnosis);

}
