/// Which meshes are fitted, and which are only measured.
#pragma once

#include <filesystem>
#include <vector>

namespace alcove::fit {

struct MeshFile {
    std::filesystem::path path;
    bool fitted;
};

/// The mesh files of a folder that can be read and have at least 100 vertices, each shape once or with its
/// variants: of files that differ by their extension the first, none named *-shuffled. Variants share a family,
/// the leading letters of the name, "refined_" and "larger_" dropped, lower case. Families in alphabetical
/// order are fitted and held out in turn.
std::vector<MeshFile> split_meshes(const std::filesystem::path& folder);

}
