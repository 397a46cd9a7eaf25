/// The command line of `alcove bake`.
#pragma once

#include "map_output.h"
#include "options.h"

#include "alcove/bake/bake.h"

namespace alcove::cli {

struct BakeVerb {
    CommonOptions common;
    BakeOptions bake;
    AddOptions add;
    MapRequest map;
    MethodRequest method;
    std::vector<std::string> inputs, occluders, grid_names;
    std::string output, grid, write_grid, tessellate;
    std::optional<Vec3d> up;
    std::optional<Quality> quality;
    float adaptivity = 0.0f;
    bool strict = false;
};

/// Whether the name of an output ends in .glb or .gltf.
bool is_gltf(const std::string& output);

/// Checks the options before any file is read. \throw UsageError.
void check_options(const BakeVerb& verb);

/// Checks that the options fit the output. \throw UsageError; IoError if the output cannot be written.
void check_output(const BakeVerb& verb, const std::string& output);

}
