/// Bakes every connected part of a mesh as if it were alone.
#pragma once

#include "surroundings.h"

#include "alcove/mesh/normals.h"
#include "alcove/occlusion/catalog.h"

namespace alcove::cli {

struct PartsBake {
    ChannelValues values; ///< of the vertices of the mesh, lengths in its unit space
    GridFacts grid;       ///< the coarsest voxel, the most levels and bytes of a part
    double grid_seconds = 0.0;
};

/// Part after part, each in its own unit space with the voxel a bake of it alone would choose, or the one that
/// was asked for, but at most 1/32 of the part. What voxelizing has to say goes to the warnings of `input`.
PartsBake bake_parts(VoxelizedMesh& input, const Surroundings& surroundings, const Method& method,
                     const Settings& settings, ChannelSet wanted, NormalSource normals,
                     const Progress& progress);

}
