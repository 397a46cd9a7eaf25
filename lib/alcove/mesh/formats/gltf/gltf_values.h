/// Adds the values of a mesh to the glTF file that it was read from.
#pragma once

#include "alcove/mesh/formats/gltf/gltf_document.h"
#include "alcove/mesh/formats/gltf/gltf_output.h"
#include "alcove/mesh/mesh.h"

#include <string>
#include <vector>

namespace alcove {

/// The name of an attribute in glTF: "_AO" for "ao".
std::string gltf_attribute_name(std::string_view name);

/// Converts colours to linear ones with 16 bits per component.
std::vector<std::array<std::uint16_t, 4>> linear_colors(std::span<const Color> colors, ColorEncoding encoding);

/// Whether the added colours show the attribute `ao`, so that COLOR_0 can be computed from `ao` without rounding to
/// bytes.
bool colors_are_ao(const Mesh& mesh);
/// One linear grey per value, with 16 bits per component.
std::vector<std::array<std::uint16_t, 4>> linear_greys(std::span<const float> values);

/// Adds the attributes and colours of `mesh`. Instances of one glTF mesh share one set of values if their values differ
/// by an RMSE of at most Mesh::instance_error; the other instances get copies of the glTF mesh. \return messages about
/// copies and replaced values.
std::vector<std::string> add_values(GltfOutput& output, const GltfDocument& document, const Mesh& mesh);

/// Puts comments into the extras of an asset or image. Each comment replaces the old ones that begin with the same
/// word.
void add_comments(Json& owner, std::span<const std::string> comments);

}
