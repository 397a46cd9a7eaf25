/// Random scenes on which the networks of `calibrated` are trained.
#pragma once

#include "alcove/grid/voxelize.h"
#include "alcove/mesh/mesh.h"

#include <cstdint>
#include <random>
#include <span>
#include <string_view>

namespace alcove::fit {

struct TrainingScene {
    std::string_view kind;
    Mesh mesh;
    SignChoice sign = SignChoice::automatic;
};

/// A random scene made of `meshes`, which have their centres at the origin and a diagonal of 1, or of generated shapes:
/// a stretched mesh, a displaced mesh, several meshes together, several primitives together, a corner of a room, or a
/// machine part built from blocks, with pockets, ribs and walls.
TrainingScene random_scene(std::span<const Mesh> meshes, std::mt19937& random);

/// The mesh in a random orientation.
Mesh turned(const Mesh& mesh, std::mt19937& random);

}
