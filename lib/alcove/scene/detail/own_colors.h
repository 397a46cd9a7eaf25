/// The colours that a mesh brings with it.
#pragma once

#include "alcove/mesh/mesh.h"

#include <string>
#include <vector>

namespace alcove {

/// Colours in linear light, from 0 to 1.
struct OwnColors {
    std::vector<Vec3> of_vertices;     ///< empty, or one per vertex
    std::vector<Vec3> of_faces;        ///< empty, or one per face; never together with of_vertices
    std::vector<std::string> warnings; ///< which colours are not shown

    bool any() const { return !of_vertices.empty() || !of_faces.empty(); }
};

/// The colours of the vertices of a mesh, else of its faces, else of the materials of an OBJ. All are taken as sRGB,
/// including the Kd of materials, as in most viewers. Faces without a material get the default colour of materials.
/// Vertex colours that are the ao of an earlier bake are ignored.
OwnColors own_colors(const Mesh& mesh);

/// Whether the file has colours, or materials that may have colours.
bool may_have_colors(const Mesh& mesh);

/// Linear light of an sRGB value in [0, 1] (srgb1999).
float srgb_decoded(float encoded);

/// Linear light of an sRGB colour, without its alpha.
Vec3 linear_light(const Color& color);

}
