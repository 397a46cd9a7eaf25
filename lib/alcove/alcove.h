/// Everything at once. How the stages follow each other:
///
///     mesh ──► grid ──► field ──► occlusion ──► mesh attributes | image
///            (OpenVDB)  (map)
///
///     Mesh mesh = read_mesh("dragon.ply");
///     const auto [triangles, left_out] = triangulate(mesh);
///     const Frame frame = frame_of(mesh.box());
///     const LevelStack field(voxelize(mesh, triangles, {.grid = {.radius = 0.1f}}));
///     const std::vector<Surfel> surfels = make_surfels(mesh, triangles, frame);
///     mesh.set_attribute({"ao", 1, bake(surfels, field, Classic{.radius = 0.1f})});
///     write_mesh(mesh, "dragon_ao.ply");
#pragma once

#include "alcove/base/errors.h"
#include "alcove/base/length.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"

#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/mesh/write.h"

#include "alcove/grid/grid_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/grid/zero_surface.h"

#include "alcove/vdb/vdb_file.h"

#include "alcove/field/combine.h"
#include "alcove/field/field.h"
#include "alcove/field/level_stack.h"
#include "alcove/field/primitives.h"

#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/channels.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/evaluate.h"
#include "alcove/occlusion/occluders.h"

#include "alcove/bake/error_figures.h"
