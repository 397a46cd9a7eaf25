/// Reads PLY, OBJ, OFF and STL files into a Mesh, without loss and without trusting the file.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>

namespace alcove {

/// Reads a mesh. The format is determined by the first bytes of the file, or else by its extension. In text, a
/// byte-order mark of UTF-8 before it and NUL and Ctrl-Z bytes after it are skipped, and 1.#INF, 1.#IND, 1.#QNAN are
/// numbers.
///
/// The vertices and faces keep the count and order of the file, and polygons stay polygons. Non-finite vertices and
/// faces of fewer than three corners are kept. `Mesh::warnings` counts what the result lacks.
///  - PLY: ascii, and binary of both byte orders. `source` keeps everything. nx ny nz become `normals`; s t, u v,
///    texture_u texture_v or s0 t0 become `vertex_uvs`; a face list texcoord becomes `corner_uvs`; red green blue
///    alpha, diffuse_red ..., or r g b a become colours, which range up to 255, or up to 1 for floats of which none is
///    above 1, or up to 65535 if one is above 255. Without faces, `tristrips` become triangles.
///  - OBJ: `source` keeps the text. Texture coordinates become `vertex_uvs` if the corners of each vertex agree,
///    otherwise `corner_uvs`. A vertex with several normals gets the normalized sum of the distinct ones. v x y z r g b
///    become colours, which range up to 1, or up to 255 if one is above 1; else the `#MRGB` comments of ZBrush do.
///    Texture coordinates and normals that are damaged, and references to missing ones, are left out and counted.
///  - OFF: [ST][C][N][4][n]OFF, ascii or BINARY, optionally with comments and without keyword or edge count. Vertices
///    of 4OFF are divided by w. Colours range up to 255, or up to 1 if one has a fraction or none is above 1. Normals,
///    colours and texture coordinates are read in the order that fits the numbers best.
///  - STL: ascii and binary. Corners with equal coordinates are joined (-0 equals 0), in the order of their first
///    appearance. Facet normals are ignored, as the corners determine them. The 15-bit colours of VisCAM and Magics
///    become `face_colors`. A binary count of 0 or -1 means as many facets as the file has room for.
///
/// Thread-safe. Cost: linear, about 0.2 µs per triangle for text and 0.1 µs for binary PLY; the file and the mesh
/// are in memory at the same time.
///
/// \throw InputError with the file, the line or byte and a fix: it cannot be read, unknown format, text in UTF-16,
///        damaged header, counts larger than the rest of the file, an index out of range, a token that is not a number,
///        an early end, no faces at all, vertices farther apart than the largest double or closer together than the
///        smallest normal one.
/// \throw LimitError if it is larger than 4 GB or a quarter of the memory, or has 2^32 vertices or corners.
/// \throw MemoryError if the system has too little memory for it.
Mesh read_mesh(const std::filesystem::path& file);

}
