/// Adds the values of a mesh to the glTF file that it was read from.
#pragma once

#include "alcove/mesh/formats/gltf/gltf_document.h"
#include "alcove/mesh/formats/gltf/gltf_output.h"
#include "alcove/mesh/mesh.h"

#include <string>
#include <vector>

namespace alcove {

/// "_AO" for "ao".
std::string gltf_attribute_name(std::string_view name);

/// Linear colours of 16 bits.
std::vector<std::array<std::uint16_t, 4>> linear_colors(std::span<const Color> colors, ColorEncoding encoding);

/// Whether the added colours are the attribute `ao`, so that COLOR_0 can be computed from `ao` without rounding to
/// bytes.
bool colors_are_ao(const Mesh& mesh);
/// One grey per value.
std::vector<std::array<std::uint16_t, 4>> linear_greys(std::span<const float> values);

/// Adds the attributes and colours of `mesh`. Instances of one glTF mesh share values that differ by an RMSE of at most
/// Mesh::instance_error; the others get copies of the glTF mesh. \return messages about copies and replaced values.
std::vector<std::string> add_values(GltfOutput& output, const GltfDocument& document, const Mesh& mesh);

/// Puts comments into the extras of an asset or image. Each comment replaces those that begin with the same word.
void add_comments(Json& owner, std::span<const std::string> comments);

}
