/// Writes a Mesh with its added attributes, as PLY or OBJ, whole or not at all.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace alcove {

enum class ColorEncoding {
    srgb, ///< bytes that decode to the value as sRGB (IEC 61966-2-1, 1999): what viewers and Blender assume
    raw,  ///< 255 × value
};

/// One opaque grey a value of [0, 1], rounded to the nearest byte; values beyond are clamped.
std::vector<Color> grey_colors(std::span<const float> values, ColorEncoding encoding = ColorEncoding::srgb);

struct WriteOptions {
    std::vector<Color> colors;         ///< empty, or one a vertex: replaces the file's own colours
    std::vector<std::string> comments; ///< provenance: one line each, the first word naming the program
};

/// Whether write_mesh() knows the extension of `file`. \throw IoError if nothing can be written there: asked
/// before long work, so that it is not in vain.
bool can_write_mesh(const std::filesystem::path& file);

/// Writes to a temporary file beside `file` and renames it, so that a failure leaves the old file as it was.
///
/// PLY: binary little endian. All elements, properties and comments the input held, byte for byte where the
/// input was binary little endian too, then the added attributes as float vertex properties in the order they
/// were added (a property of the same name is replaced in place): NAME, of three components NAME_x NAME_y
/// NAME_z, those of `bent_normal` bent_x bent_y bent_z. `colors` become uchar red green blue alpha. A comment
/// of the file that begins with the first word of one of `comments` gives way to it. Other inputs get float
/// coordinates, double where float would move a vertex by more than 1e-6 of the diagonal.
///
/// OBJ: the input's text, in which only what follows x y z on the `v` lines changes, and that only if there
/// are `colors`: a fourth coordinate gives way to r g b. No comments are added to it. Other inputs are
/// written with the shortest decimals that read back as the same float, where the value is one, else as the
/// same double.
///
/// What the file held is written as it was, whatever the Mesh's own fields say now: reset `Mesh::source`
/// after moving, adding or removing vertices or faces.
///
/// \return what the format could not hold, in words, one line each; empty when nothing was lost.
/// \throw InputError for another extension, naming the ones that work; IoError if the file cannot be written.
std::vector<std::string> write_mesh(const Mesh& mesh, const std::filesystem::path& file,
                                    const WriteOptions& options = {});

}
