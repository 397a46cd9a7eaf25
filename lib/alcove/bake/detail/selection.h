/// Chooses faces by the names of their groups.
#pragma once

#include "alcove/bake/bake.h"

#include <cstdint>
#include <vector>

namespace alcove {

/// Flags that select faces. Each member has one entry per face.
struct SelectedFaces {
    std::vector<std::uint8_t> baked, occluding;
};

/// \throw InputError if a name matches no group, or if no face is left to bake.
SelectedFaces select_faces(const Mesh& mesh, const FaceSelection& selection);

/// The mesh without the faces that are neither baked nor occluding. Keeps all vertices, the normals and the source;
/// drops UVs and colours.
Mesh remaining(const Mesh& mesh, const SelectedFaces& selected);

/// Whether a name matches a pattern, in which * stands for any text and ? for any one character. Case-sensitive.
bool matches(std::string_view name, std::string_view pattern);

}
