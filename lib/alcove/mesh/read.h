/// Reads PLY, OBJ, OFF and STL files into a Mesh, losing nothing and trusting nothing.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>

namespace alcove {

/// Reads a mesh; the format follows from the file's first bytes, then from its extension.
///
/// Vertex and face counts and order are the file's, polygons stay polygons. Non-finite vertices and faces of
/// fewer than three corners are kept. Whatever a format holds that the result does not is counted in
/// `Mesh::warnings`.
///  - PLY: ascii, binary of both byte orders. Everything is kept in `source`. nx ny nz become `normals`;
///    s t, u v, texture_u texture_v or s0 t0 `vertex_uvs`; a face list texcoord `corner_uvs`; red green blue
///    alpha colours, floats running to 1, ushorts to 65535.
///  - OBJ: the text is kept in `source`. Texture coordinates are `vertex_uvs` where the corners of each
///  vertex
///    agree, else `corner_uvs`; a vertex with several normals gets the direction of the sum of the different
///    ones. v x y z r g b become colours, running to 1, or to 255 where one is above 1.
///  - OFF: [ST][C][N][4][n]OFF, ascii or BINARY, with comments, without keyword or edge count; 4OFF divided
///  by w.
///    Colours run to 255, or to 1 where one has a fraction or none is above 1.
///  - STL: ascii, binary. Corners are joined where their coordinates are equal, -0 being 0, in order of first
///    appearance. Facet normals are left out: the corners say the same.
///
/// Cost: linear, about 0.2 µs a triangle for text and 0.1 µs for binary PLY; the file and the mesh are in
/// memory at once. Safe to call from several threads.
///
/// \throw InputError naming file, line or byte and mend: unknown format, damaged header, counts larger than
/// what is
///        left of the file, an index out of range, a token that is no number, an early end, no faces at all,
///        vertices that lie further apart than a double holds, or nearer together than the least normal one.
/// \throw IoError if the file cannot be read. \throw LimitError if it does not fit in memory or
/// holds 2^32
///        vertices or corners.
Mesh read_mesh(const std::filesystem::path& file);

}
