/// Detects a few faces that determine most of the bounding box, such as the outliers of a scan.
#pragma once

#include "alcove/mesh/mesh.h"

#include <cstddef>
#include <optional>
#include <string>

namespace alcove {

struct OutlierFaces {
    std::size_t count;
    std::size_t example; ///< the index of one of them
    Box rest;            ///< bounding box of all other faces

    /// A message: "2 of 5,000 faces, such as face 17, make the diagonal of the bounding box 900 instead of 1.7".
    std::string text(const Mesh& mesh) const;
};

/// Finds faces without which the diagonal of the bounding box would be less than a tenth as long: at most one face in a
/// hundred, but up to two in small meshes. std::nullopt if there are none. Cost: 50 ns per face; less in large meshes
/// if their faces are spread out, as is usual.
std::optional<OutlierFaces> find_outlier_faces(const Mesh& mesh);

}
