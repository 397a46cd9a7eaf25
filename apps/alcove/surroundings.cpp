#include "surroundings.h"

#include "vector.h"

#include "alcove/errors.h"
#include "alcove/field/combine.h"
#include "alcove/field/primitives.h"
#include "alcove/mesh/clip.h"
#include "alcove/mesh/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove::cli {
namespace {

constexpr double memory_limit = 1e9; // of all occluders together

// Of an occluder's own diagonal.
constexpr float smallest_voxel = 1.0f / 512.0f, largest_voxel = 1.0f / 32.0f;

/// What of the file's surface a bake of `input` can see. The distance of a probe counts up to its height, which
/// is at most the radius: twice the radius away at most.
Mesh nearby(const Mesh& mesh, const VoxelizedMesh& input) {
    const Vec3d margin(2.0 * double(input.radius) * input.frame.diagonal);
    const Box box = input.mesh.box();
    return clip(mesh, triangulate(mesh).triangles, {box.min - margin, box.max + margin});
}

}

void add_surroundings_options(CLI::App& verb, SurroundingsRequest& request) {
    verb.add_option("--occluder", request.occluders,
                    "Mesh that occludes too, in its place in the scene; give it again for more")
        ->option_text("MESH");
    verb.add_flag("--ground", request.ground, "The plane below the lowest vertex occludes too");
    verb.add_option_function<std::string>(
            "--up", [&request](const std::string& text) { request.up = parse_direction(text, "--up"); },
            "Which way is up, for --ground")
        ->type_name("X,Y,Z")
        ->default_str("0,1,0");
}

Surroundings::Surroundings(const SurroundingsRequest& request, VoxelizedMesh& input) {
    if (request.ground) {
        const Vec3d up = glm::normalize(request.up);
        double lowest = std::numeric_limits<double>::infinity();
        for (const Vec3d& p : input.mesh.positions)
            if (is_finite(p))
                lowest = std::min(lowest, glm::dot(up, p));
        if (std::isfinite(lowest))
            ground_ = Ground{up, lowest};
    }
    for (const std::string& file : request.occluders)
        add_occluder(file, input, memory_limit / static_cast<double>(request.occluders.size()));
}

void Surroundings::add_occluder(const std::string& file, VoxelizedMesh& input, double memory_limit) {
    const auto warn = [&](const std::string& warning) { input.warnings.push_back(file + ": " + warning); };
    const Mesh whole = read_mesh(file);
    for (const std::string& warning : whole.warnings)
        warn(warning);
    const Mesh mesh = nearby(whole, input);
    if (mesh.face_count() == 0) {
        warn("is too far away to occlude anything within the radius");
        return;
    }
    const Frame frame = frame_of(mesh.box());
    const double scale = input.frame.diagonal / frame.diagonal;
    VoxelizeOptions options;
    options.grid.radius = static_cast<float>(input.radius * scale);
    options.grid.memory_limit = memory_limit;
    const float voxel =
        input.stack.levels.empty() ? input.options.grid.voxel : input.stack.levels.front().voxel;
    if (voxel > 0.0f)
        options.grid.largest_voxel =
            std::clamp(static_cast<float>(voxel * scale), smallest_voxel, largest_voxel);
    try {
        const GridStack stack = voxelize(mesh, triangulate(mesh).triangles, options);
        for (const std::string& warning : stack.warnings)
            warn(warning);
        bytes_ += stack.bytes();
        occluders_.push_back({LevelStack(stack), frame});
    } catch (const InputError& error) {
        throw InputError(file + ": " + error.what());
    }
}

AnyField Surroundings::around(AnyField field, const Frame& frame) const {
    if (occluders_.empty() && !ground_)
        return field;
    std::vector<AnyField> all{std::move(field)};
    for (const Occluder& occluder : occluders_)
        all.emplace_back(placed(occluder.field, occluder.frame, frame));
    if (ground_)
        all.emplace_back(Plane{
            Vec3(ground_->up),
            static_cast<float>((ground_->height - glm::dot(ground_->up, frame.center)) / frame.diagonal)});
    return UnionOf<AnyField>(std::move(all));
}

}
