/// Reads the output of `alcove bake` and creates meshes to bake.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>

namespace alcove::test {

/// A mesh written by bake, and its `ao`.
struct Baked {
    Mesh mesh;
    std::vector<float> ao;
};
Baked read_baked(const std::filesystem::path& file);

/// A square of n × n quads around the origin in the plane y = 0, facing up.
Mesh floor_mesh(double half, std::uint32_t n);

}
