#include "alcove/bake/detail/surroundings.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/types.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/detail/clip.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/directions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

constexpr double share_of_memory = 0.25; // of the memory limit, for all occluders together

// Fractions of the diagonal of an occluder.
constexpr float smallest_voxel = 1.0f / 512.0f, largest_voxel = 1.0f / 32.0f;

}

Surroundings::Surroundings(const BakeOptions& options, const Mesh& mesh, const Frame& frame, float radius,
                           std::vector<std::string>& warnings)
    : radius_(double(radius) * frame.diagonal) {
    if (options.ground) {
        const Vec3d up = glm::normalize(options.up);
        double lowest = std::numeric_limits<double>::infinity();
        const std::vector<std::uint8_t> used = mesh.used_vertices();
        for (std::size_t v = 0; v < used.size(); ++v)
            if (used[v] && is_finite(mesh.positions[v]))
                lowest = std::min(lowest, glm::dot(up, mesh.positions[v]));
        if (std::isfinite(lowest))
            ground_ = Ground{up, lowest};
    }
    // Probes are at most one radius away from a vertex and read distances of at most one radius.
    const Vec3d margin(2.0 * radius_);
    const Box box = mesh.box();
    for (const Mesh& occluder : options.occluders)
        add(occluder, {box.min - margin, box.max + margin}, warnings);
}

void Surroundings::add(const Mesh& occluder, const Box& near, std::vector<std::string>& warnings) {
    const std::string name = occluder.name.empty() ? "an occluder" : occluder.name;
    if (occluder.face_count() == 0)
        return add(with_surface(occluder), near, warnings);
    Mesh mesh = clip(occluder, triangulate(occluder).triangles, near);
    if (mesh.face_count() == 0) {
        warnings.push_back(name + " is too far away to occlude anything within the radius");
        return;
    }
    const Frame frame = frame_of(mesh.box());
    std::vector<Triangle> triangles = triangulate(mesh).triangles;
    occluders_.push_back({name, std::move(mesh), std::move(triangles), frame});
}

void Surroundings::voxelize(double voxel, std::vector<std::string>& warnings) {
    for (Occluder& occluder : occluders_) {
        const GridStack stack = voxelize(occluder, voxel);
        for (const std::string& warning : stack.warnings)
            warnings.push_back(occluder.name + ": " + warning);
        occluder.bytes = stack.bytes();
        occluder.field = LevelStack(stack);
    }
}

GridStack Surroundings::voxelize(const Occluder& occluder, double voxel) const {
    const double diagonal = occluder.mesh.box().diagonal();
    VoxelizeOptions options;
    options.grid.radius = static_cast<float>(radius_ / diagonal);
    options.grid.memory_limit = memory_each();
    options.grid.cluster = true;
    if (voxel > 0.0)
        options.grid.largest_voxel = std::clamp(static_cast<float>(voxel / diagonal), smallest_voxel, largest_voxel);
    try {
        return alcove::voxelize(occluder.mesh, occluder.triangles, options);
    } catch (const InputError& error) {
        throw InputError(occluder.name + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(occluder.name + ": " + error.what());
    }
}

double Surroundings::memory_each() const {
    return share_of_memory * memory_limit() / static_cast<double>(occluders_.size());
}

bool Surroundings::fit() const {
    return std::all_of(occluders_.begin(), occluders_.end(), [&](const Occluder& occluder) {
        return std::isfinite(finest_voxel(surface_size(occluder.mesh, occluder.triangles), occluder.triangles.size(),
                                          {.cluster = true, .memory_limit = memory_each()}));
    });
}

std::size_t Surroundings::bytes() const {
    std::size_t bytes = 0;
    for (const Occluder& occluder : occluders_)
        bytes += occluder.bytes;
    return bytes;
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

RaySurface Surroundings::rays_around(const Occludee& baked) const {
    std::vector<Vec3> positions;
    std::vector<Triangle> all;
    const auto add = [&](std::span<const Vec3d> scene, std::span<const Triangle> faces) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Vec3d& p : scene)
            positions.push_back(baked.frame.to_unit(p));
        for (const Triangle& t : faces)
            all.push_back({first + t[0], first + t[1], first + t[2]});
    };
    add(baked.positions, baked.triangles);
    for (const Occluder& occluder : occluders_)
        add(occluder.mesh.positions, occluder.triangles);
    if (ground_) {
        constexpr float horizon = 100.0f; // unit space; also the maximum length of rays through an unbounded field
        const Basis basis(Vec3(ground_->up));
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Vec2 corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
            positions.push_back(ground_->height_in(baked.frame) * basis.normal +
                                horizon * (corner.x * basis.tangent + corner.y * basis.bitangent));
        all.push_back({first, first + 1, first + 2});
        all.push_back({first, first + 2, first + 3});
    }
    return RaySurface(positions, all);
}

}
