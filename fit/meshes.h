/// Splits the meshes into those used for fitting and those held out.
#pragma once

#include <filesystem>
#include <vector>

namespace alcove::fit {

struct MeshFile {
    std::filesystem::path path;
    bool fitted;
};

/// The mesh files of a folder that can be read and have at least 100 vertices. Of files that differ only in their
/// extension, only the first is included; files named *-shuffled are left out. Variants of a shape form a family: files
/// whose names begin with the same letters, ignoring case and the prefixes "refined_" and "larger_". Every other
/// family, in alphabetical order, is held out, so that no held-out mesh is a variant of a fitted one.
std::vector<MeshFile> split_meshes(const std::filesystem::path& folder);

}
