/// Writes a Mesh with its added attributes as PLY or OBJ, completely or not at all.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace alcove {

enum class ColorEncoding {
    srgb, ///< bytes that decode to the value as sRGB (IEC 61966-2-1, 1999), which viewers and Blender assume
    raw,  ///< 255 × value
};

/// One opaque grey per value in [0, 1], rounded to the nearest byte; other values are clamped.
std::vector<Color> grey_colors(std::span<const float> values, ColorEncoding encoding = ColorEncoding::srgb);

/// Whether write_mesh() knows the extension of `file`. Call this before a long computation, to find out early.
/// \throw IoError if nothing can be written there, InputError if it is a pipe, a device or a dangling symbolic link.
bool can_write_mesh(const std::filesystem::path& file);

/// Writes to a temporary file in the same folder and renames it, so that a failure leaves the old file unchanged.
///
/// PLY: binary little endian. Writes all elements, properties and comments of a PLY input, byte for byte if that
/// was binary little endian too, then the added attributes as float vertex properties in the order in which they
/// were added (a property of the same name is replaced in place). Their name is NAME, or NAME_x NAME_y NAME_z for
/// three components, and bent_x bent_y bent_z for `bent_normal`. `added_colors` become uchar red green blue alpha.
/// Each of `added_comments` replaces the comments of the file that begin with the same word. For other inputs,
/// coordinates are float, or double if float would move a vertex by more than 1e-6 of the diagonal.
///
/// OBJ: writes the text of an OBJ input. `added_colors` replace whatever follows x y z on the `v` lines, including a
/// fourth coordinate. In another folder, relative paths of other files (mtllib, maplib, shadow_obj, trace_obj) are
/// rewritten to point to the same files, if these exist. Nothing else changes, and no comments are added. For other
/// inputs, numbers are the shortest decimals that read back as the same float if the value is one, otherwise as the
/// same double.
///
/// The contents of the input are written even if the fields of the Mesh have changed: reset `Mesh::source` after
/// moving, adding or removing vertices or faces.
///
/// \return what the format could not store, which paths changed, and which values attributes replaced, except those
/// that an earlier run made according to a comment in the file; one message each; empty if there is nothing to say.
/// \throw InputError for another extension, with the ones that work; IoError if the file cannot be written.
std::vector<std::string> write_mesh(const Mesh& mesh, const std::filesystem::path& file);

}
