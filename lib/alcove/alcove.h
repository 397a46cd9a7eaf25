/// The public headers of the library alcove::alcove. How the stages follow each other:
///
///     mesh ──► grid ──► field ──► occlusion ──► bake ──► vertices of the mesh
///            (OpenVDB)  (map)
///
///     auto mesh = alcove::read_mesh("dragon.ply");
///     const auto baked = alcove::bake(mesh, {.radius = "10%", .quality = alcove::Quality::good});
///     alcove::add(mesh, baked);
///     alcove::write_mesh(mesh, "dragon_ao.ply");
///
/// Rendering is in the library alcove::alcove_render: alcove/scene/scene.h and alcove/render/. The adapter for OpenMesh
/// is alcove/bake/openmesh.h.
#pragma once

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"

#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/files.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"

#include "alcove/grid/grid_stack.h"
#include "alcove/grid/voxelize.h"

#include "alcove/vdb/vdb_file.h"

#include "alcove/field/field.h"
#include "alcove/field/level_stack.h"
#include "alcove/field/primitives.h"

#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/channels.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/occluders.h"

#include "alcove/bake/bake.h"
