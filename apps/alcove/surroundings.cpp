#include "surroundings.h"

#include "vector.h"

#include "alcove/base/errors.h"
#include "alcove/field/combine.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/mesh/detail/clip.h"
#include "alcove/mesh/read.h"
#include "alcove/occlusion/detail/directions.h"

#include <CLI/CLI.hpp>
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

/// The grids of an occluder, their voxels those of the mesh as far as its own size allows.
GridStack voxelize_occluder(const Mesh& mesh, std::span<const Triangle> triangles, const std::string& file,
                            double memory, const VoxelizedMesh& input) {
    const double scale = input.frame.diagonal / mesh.box().diagonal();
    VoxelizeOptions options;
    options.grid.radius = static_cast<float>(input.radius * scale);
    options.grid.memory_limit = memory;
    options.grid.cluster = true;
    const float voxel =
        input.stack.levels.empty() ? input.options.grid.voxel : input.stack.levels.front().voxel;
    if (voxel > 0.0f)
        options.grid.largest_voxel =
            std::clamp(static_cast<float>(voxel * scale), smallest_voxel, largest_voxel);
    try {
        return voxelize(mesh, triangles, options);
    } catch (const InputError& error) {
        throw InputError(file + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(file + ": " + error.what());
    }
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
        add_occluder(file, input);
}

void Surroundings::add_occluder(const std::string& file, VoxelizedMesh& input) {
    const auto warn = [&](const std::string& warning) { input.warnings.push_back(file + ": " + warning); };
    const Mesh whole = read_mesh(file);
    for (const std::string& warning : whole.warnings)
        warn(warning);
    Mesh mesh = nearby(whole, input);
    if (mesh.face_count() == 0) {
        warn("is too far away to occlude anything within the radius");
        return;
    }
    const Frame frame = frame_of(mesh.box());
    std::vector<Triangle> triangles = triangulate(mesh).triangles;
    occluders_.push_back({file, std::move(mesh), std::move(triangles), frame});
}

void Surroundings::voxelize(VoxelizedMesh& input) {
    for (Occluder& occluder : occluders_) {
        const GridStack stack =
            voxelize_occluder(occluder.mesh, occluder.triangles, occluder.file, memory_each(), input);
        for (const std::string& warning : stack.warnings)
            input.warnings.push_back(occluder.file + ": " + warning);
        occluder.bytes = stack.bytes();
        occluder.field = LevelStack(stack);
    }
}

double Surroundings::memory_each() const {
    return memory_limit / static_cast<double>(occluders_.size());
}

bool Surroundings::fit() const {
    return std::all_of(occluders_.begin(), occluders_.end(), [&](const Occluder& occluder) {
        return std::isfinite(finest_voxel(surface_size(occluder.mesh, occluder.triangles),
                                          occluder.triangles.size(),
                                          {.cluster = true, .memory_limit = memory_each()}));
    });
}

std::size_t Surroundings::bytes() const {
    std::size_t bytes = 0;
    for (const Occluder& occluder : occluders_)
        bytes += occluder.bytes;
    return bytes;
}

Occluders Surroundings::around(const Mesh& mesh, std::span<const Triangle> triangles, const GridStack& stack,
                               const Frame& frame, Needs needs) const {
    if (!needs.rays)
        return field_around(stack, frame);
    if (!needs.field)
        return rays_around(mesh, triangles, frame);
    return {field_around(stack, frame), rays_around(mesh, triangles, frame)};
}

AnyField Surroundings::field_around(const GridStack& stack, const Frame& frame) const {
    AnyField field = LevelStack(stack);
    if (occluders_.empty() && !ground_)
        return field;
    std::vector<AnyField> all{std::move(field)};
    for (const Occluder& occluder : occluders_)
        all.emplace_back(placed(*occluder.field, occluder.frame, frame));
    if (ground_)
        all.emplace_back(Plane{Vec3(ground_->up), ground_->height_in(frame)});
    return UnionOf<AnyField>(std::move(all));
}

RaySurface Surroundings::rays_around(const Mesh& mesh, std::span<const Triangle> triangles,
                                     const Frame& frame) const {
    std::vector<Vec3> positions;
    std::vector<Triangle> all;
    const auto add = [&](const std::vector<Vec3d>& scene, std::span<const Triangle> faces) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Vec3d& p : scene)
            positions.push_back(frame.to_unit(p));
        for (const Triangle& t : faces)
            all.push_back({first + t[0], first + t[1], first + t[2]});
    };
    add(mesh.positions, triangles);
    for (const Occluder& occluder : occluders_)
        add(occluder.mesh.positions, occluder.triangles);
    if (ground_) {
        // As far as a field without an end is traced.
        constexpr float horizon = 100.0f;
        const Basis basis(Vec3(ground_->up));
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Vec2 corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
            positions.push_back(ground_->height_in(frame) * basis.normal +
                                horizon * (corner.x * basis.tangent + corner.y * basis.bitangent));
        all.push_back({first, first + 1, first + 2});
        all.push_back({first, first + 2, first + 3});
    }
    return RaySurface(positions, all);
}

}
