/// Reads and writes mesh files without loss: PLY, OBJ, OFF, STL and glTF into a Mesh, and a Mesh as PLY, OBJ or glTF.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace alcove {

/// Reads a mesh. The format is determined by the first bytes of the file, or else by its extension. In text files, a
/// UTF-8 byte-order mark at the start and NUL and Ctrl-Z bytes at the end are skipped, and 1.#INF, 1.#IND and 1.#QNAN
/// are read as infinity and NaN.
///
/// The vertices and faces keep the count and order of the file, and polygons stay polygons. Non-finite vertices and
/// faces of fewer than three corners are kept. `Mesh::warnings` says what the result lacks, with counts.
///  - PLY: ascii, and binary in both byte orders. `source` keeps the whole file. nx ny nz become `normals`; s t, u v,
///    texture_u texture_v or s0 t0 become `vertex_uvs`; the list texcoord of the faces becomes `corner_uvs`; red green
///    blue alpha, diffuse_red ..., or r g b a become colours. These range up to 255, but up to 1 if they are floats and
///    none is above 1, and up to 65535 if one is above 255. If there are no faces, `tristrips` become triangles.
///  - OBJ: `source` keeps the text. Texture coordinates become `vertex_uvs` if the corners of each vertex agree,
///    otherwise `corner_uvs`. A vertex with several normals gets the normalized sum of the distinct ones. v x y z r g b
///    become colours, which range up to 1, or up to 255 if one is above 1. If no vertex has a colour, the `#MRGB`
///    comments of ZBrush become colours. Damaged texture coordinates and normals, and references to missing ones, are
///    left out and counted.
///  - OFF: [ST][C][N][4][n]OFF, ascii or BINARY. There may be comments, and the keyword and the edge count may be
///    missing. Vertices of 4OFF are divided by w. Colours range up to 255, or up to 1 if one has a fraction or none is
///    above 1. Normals, colours and texture coordinates are read in the order that fits the numbers best.
///  - STL: ascii and binary. Corners with equal coordinates become one vertex (-0 equals 0); vertices are in the order
///    of their first appearance. Facet normals are ignored, as the corners determine them. The 15-bit colours of VisCAM
///    and Magics become `face_colors`. In a binary file, a count of 0 or -1 means as many facets as the file has room
///    for.
///  - glTF 2.0: .glb, or .gltf with its buffers; the meshes of the default scene, instance by instance, in the
///    coordinates of the scene. Coordinates are rounded to floats if this moves no vertex by more than 1e-6 of the
///    diagonal. Skinned meshes are in their bind pose; morph targets are ignored. KHR_mesh_quantization,
///    EXT_meshopt_compression, KHR_draco_mesh_compression and EXT_mesh_gpu_instancing are read. `groups` have the names
///    of nodes, meshes and materials. TEXCOORD_0 becomes `vertex_uvs`, COLOR_0 `vertex_colors`, and the base colours of
///    materials become `face_colors`.
///
/// Thread-safe. Cost: linear, about 0.2 µs per triangle for text and 0.1 µs for binary PLY; the file and the mesh are
/// in memory at the same time. The data of a .glb of more than 1 MB stays on the disk, and is read again when the mesh
/// is written. Until then, the file must not be changed, but it may be replaced by another file.
///
/// \throw InputError, which names the file, the line or byte, and a fix. Reasons: an unreadable file, an unknown
///        format, text in UTF-16, a damaged header, counts larger than the rest of the file, an index out of range, a
///        token that is not a number, an early end, no faces at all, vertices farther apart than the largest double or
///        closer together than the smallest normal one.
/// \throw LimitError if the file is larger than 4 GB or a quarter of the memory, or has 2^32 vertices or corners.
/// \throw MemoryError if the system has too little memory for the mesh.
Mesh read_mesh(const std::filesystem::path& file);

/// One opaque grey per value in [0, 1], rounded to the nearest byte; other values are clamped.
std::vector<Color> grey_colors(std::span<const float> values, ColorEncoding encoding = ColorEncoding::srgb);

/// Whether write_mesh() knows the extension of `file`. Call this before a long computation, to find out early.
/// \throw IoError if nothing can be written there, InputError if it is a pipe, a device or a dangling symbolic link.
bool can_write_mesh(const std::filesystem::path& file);

/// Writes the mesh to a temporary file in the same folder and renames it, so that a failure leaves the old file
/// unchanged.
///
/// PLY: binary little endian. Writes all elements, properties and comments of a PLY input, byte for byte if the input
/// was binary little endian too. The added attributes follow as float vertex properties, in the order in which they
/// were added; a property of the same name is replaced in place. Their names are NAME, or NAME_x NAME_y NAME_z for
/// three components, and bent_x bent_y bent_z for `bent_normal`. `added_colors` become uchar red green blue alpha. Each
/// of `added_comments` replaces the comments of the file that begin with the same word. For other inputs, coordinates
/// are float, or double if float would move a vertex by more than 1e-6 of the diagonal.
///
/// OBJ: writes the text of an OBJ input. `added_colors` replace whatever follows x y z on the `v` lines, including a
/// fourth coordinate. In another folder, relative paths of other files (mtllib, maplib, shadow_obj, trace_obj) are
/// rewritten to point to the same files, if these exist. Nothing else changes, and no comments are added. For other
/// inputs, numbers are the shortest decimals that read back as the same value, as a float if the value is a float,
/// otherwise as a double.
///
/// glTF (.glb, .gltf): writes everything in a glTF input, and adds values to its vertices: attributes as float _AO,
/// _CONVEXITY, _BENT_NORMAL (in the space of the node), ..., and `added_colors` as COLOR_0. New data follows the old in
/// the buffers; in a .gltf, it is embedded. Instances of a mesh share values, or get copies of the mesh; see
/// Mesh::instance_error. `added_comments` become `extras` of the asset. For other inputs, writes a node with one
/// primitive per material.
///
/// The contents of the input are written even if the fields of the Mesh have changed: reset `Mesh::source` after
/// moving, adding or removing vertices or faces.
///
/// \return messages about data that the format could not store, paths that changed, and values that attributes replaced
/// (except values that, according to a comment in the file, an earlier run made). Empty if there are none.
/// \throw InputError for an unknown extension (the message lists the known ones), or if a large .glb has changed since
/// it was read; IoError if the file cannot be written.
std::vector<std::string> write_mesh(const Mesh& mesh, const std::filesystem::path& file);

}
