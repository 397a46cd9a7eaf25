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

#include "alcove/enum_set.h"
#include "alcove/errors.h"
#include "alcove/length.h"
#include "alcove/parallel.h"
#include "alcove/types.h"

#include "alcove/mesh/clip.h"
#include "alcove/mesh/colors.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/parts.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/source.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/mesh/write.h"

#include "alcove/grid/grid_io.h"
#include "alcove/grid/grid_stack.h"
#include "alcove/grid/mesh_grid.h"
#include "alcove/grid/plan.h"
#include "alcove/grid/voxelize.h"

#include "alcove/field/any_field.h"
#include "alcove/field/blend.h"
#include "alcove/field/bricks.h"
#include "alcove/field/combine.h"
#include "alcove/field/field.h"
#include "alcove/field/level_stack.h"
#include "alcove/field/primitives.h"
#include "alcove/field/trace.h"

#include "alcove/occlusion/bake.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/channels.h"
#include "alcove/occlusion/directions.h"
#include "alcove/occlusion/document_hash.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/exact.h"
#include "alcove/occlusion/guided.h"
#include "alcove/occlusion/hemisphere_frame.h"
#include "alcove/occlusion/method_info.h"
#include "alcove/occlusion/network.h"
#include "alcove/occlusion/occluders.h"
#include "alcove/occlusion/parameter.h"
#include "alcove/occlusion/subset.h"
#include "alcove/occlusion/thin_walls.h"

#include "alcove/occlusion/methods/calibrated.h"
#include "alcove/occlusion/methods/calibrated_inputs.h"
#include "alcove/occlusion/methods/calibrated_table.h"
#include "alcove/occlusion/methods/classic.h"
#include "alcove/occlusion/methods/decay.h"
#include "alcove/occlusion/methods/exponential.h"
#include "alcove/occlusion/methods/fibonacci.h"
#include "alcove/occlusion/methods/hemisphere.h"
#include "alcove/occlusion/methods/hemisphere_random.h"
#include "alcove/occlusion/methods/jittered.h"
#include "alcove/occlusion/methods/multiplicative.h"
#include "alcove/occlusion/methods/multiscale.h"
#include "alcove/occlusion/methods/ring_bent_normal.h"
#include "alcove/occlusion/methods/thickness.h"
#include "alcove/occlusion/methods/traced.h"

#include "alcove/render/camera.h"
#include "alcove/render/depth_buffer.h"
#include "alcove/render/image.h"
#include "alcove/render/image_method.h"
#include "alcove/render/march_steps.h"
#include "alcove/render/painted.h"
#include "alcove/render/passes.h"
#include "alcove/render/renderer.h"
#include "alcove/render/screen_space.h"
#include "alcove/render/shading.h"
#include "alcove/render/soft_shadow.h"
#include "alcove/render/subject.h"
#include "alcove/render/subject_mesh.h"
#include "alcove/render/turntable.h"

#include "alcove/scene/scene.h"
#include "alcove/scene/scene_file.h"
#include "alcove/scene/staging.h"

#include "alcove/accuracy/error_figures.h"
#include "alcove/accuracy/heat_map.h"
#include "alcove/accuracy/measure.h"
#include "alcove/accuracy/method_choice.h"
#include "alcove/accuracy/pareto.h"
#include "alcove/accuracy/pilot.h"
#include "alcove/accuracy/plan_table.h"
#include "alcove/accuracy/planned_bake.h"
#include "alcove/accuracy/planner.h"
#include "alcove/accuracy/report.h"
