#include "alcove/grid/voxelize.h"

#include "alcove/errors.h"
#include "alcove/grid/band.h"
#include "alcove/mesh/diagnose.h"

#include <openvdb/tools/MeshToVolume.h>

#include <fmt/format.h>

#include <cmath>

namespace alcove {
namespace {

// Above this share of sign changes away from the surface, a solid is none. Sound scans and parts have none at
// all, closed meshes that overlap themselves somewhere 0.02 to 0.2 %, those made of overlapping parts 0.5 %
// and more.
constexpr double tolerated_contradictions = 2.5e-3;

struct TrianglesForOpenVdb {
    const Surface& surface;

    std::size_t polygonCount() const { return surface.size(); }
    std::size_t pointCount() const { return 3 * surface.size(); }
    std::size_t vertexCount(std::size_t) const { return 3; }
    void getIndexSpacePoint(std::size_t triangle, std::size_t corner, openvdb::Vec3d& p) const {
        const Vec3d& v = surface.vertex(triangle, static_cast<int>(corner));
        p = {v.x, v.y, v.z};
    }
};

/// The voxels next to the surface, each with a triangle near it.
openvdb::Int32Tree::Ptr rasterize(const Surface& surface) {
    using namespace openvdb::tools;
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    openvdb::Int32Grid nearest;
    meshToVolume<openvdb::FloatGrid>(
        TrianglesForOpenVdb{surface}, *transform, 1.0f, 1.0f,
        UNSIGNED_DISTANCE_FIELD | DISABLE_INTERSECTING_VOXEL_REMOVAL | DISABLE_RENORMALIZATION, &nearest);
    return nearest.treePtr();
}

void warn_of_orientation(const Closedness& surface, std::vector<std::string>& warnings) {
    if (surface.flipped_edges > 0)
        warnings.push_back(
            fmt::format("at {} edges the neighbouring faces turn opposite ways: vertices there are lit from "
                        "whichever side their normals take, make the faces agree first",
                        surface.flipped_edges));
    if (surface.inverted_components > 0)
        warnings.push_back(
            fmt::format("{} of {} parts face inward and get the occlusion of their inside: right for the "
                        "wall of a cavity, else turn their faces over first",
                        surface.inverted_components, surface.components));
}

Sign choose_sign(SignChoice choice, const Closedness& surface, const Band& finest, const BandWidth& width,
                 std::vector<std::string>& warnings) {
    if (choice == SignChoice::sheet)
        return Sign::sheet;
    if (choice == SignChoice::automatic) {
        // The wall of a cavity counts as inverted too: as a sheet it is as right.
        if (!surface.closed() || surface.inverted_components > 0)
            return Sign::sheet;
    }
    const double wrong = contradictions(*finest.level_set(Sign::solid, width, 1.0));
    if (wrong <= tolerated_contradictions)
        return Sign::solid;
    if (choice == SignChoice::automatic)
        return Sign::sheet;
    warnings.push_back(
        fmt::format("the mesh is taken for a solid as asked, but {:.1f} % of the sign changes are not "
                    "at its surface: use --sign auto",
                    100.0 * wrong));
    return Sign::solid;
}

/// Index (0, 0, 0) of all levels: below and left of every band, so that a tree has one root node and not
/// eight, each of a quarter of a megabyte.
Vec3 origin_of(const Box& box, const Frame& frame, const LevelPlan& plan) {
    const float margin = std::ldexp(plan.voxel, plan.levels - 1) * (std::ceil(plan.outer_band) + 2.0f);
    return frame.to_unit(box.min) - margin;
}

LevelSet finish(const Band& band, const LevelPlan& plan, const GridStack& stack, const Vec3& origin,
                int level) {
    LevelSet set;
    set.origin = origin;
    set.voxel = std::ldexp(plan.voxel, level);
    set.outer_band = plan.outer_band;
    const float inner = stack.sign == Sign::solid ? plan.inner_band : sheet_thickness;
    const double value_scale = double(set.voxel) * stack.frame.diagonal / stack.value_unit;
    const auto grid = band.level_set(stack.sign, {plan.outer_band, inner}, value_scale);
    set.active_voxels = grid->activeVoxelCount();
    set.bytes = grid->memUsage();
    set.grid = std::make_shared<VdbGrid>(VdbGrid{grid});
    return set;
}

}

GridStack voxelize(const Mesh& mesh, std::span<const Triangle> triangles, const VoxelizeOptions& options) {
    const LevelPlan plan = plan_levels(mesh, triangles, options.grid);
    GridStack stack;
    stack.frame = frame_of(mesh.box());
    stack.value_unit = value_unit_of(stack.frame);
    const Vec3 origin = origin_of(mesh.box(), stack.frame, plan);
    const Surface surface(mesh, triangles, stack.frame, Vec3d(origin), plan.voxel);
    if (surface.size() == 0)
        throw InputError("the mesh has no face with an area: there is no surface to occlude anything");

    if (plan.voxel > 0.25f * options.grid.radius)
        stack.warnings.push_back(fmt::format(
            "the voxel is {:.2g} of the radius, too coarse to tell occlusion: use a voxel of {:.2g} % of "
            "the diagonal or less",
            plan.voxel / options.grid.radius, 12.5 * options.grid.radius));
    // Rough shares of the time.
    const auto done = [&](double share) {
        if (options.progress)
            options.progress(share);
    };
    const Closedness shape = closedness(mesh);
    warn_of_orientation(shape, stack.warnings);
    done(0.1);
    openvdb::initialize();
    const bool sheet = options.sign == SignChoice::sheet;
    const BandWidth both{plan.outer_band, plan.outer_band};
    const BandWidth solid{plan.outer_band, plan.inner_band};
    const auto seeds = rasterize(surface);
    done(0.3);
    Band band(surface, 1, seeds, sheet ? both : solid);
    stack.sign = choose_sign(options.sign, shape, band, solid, stack.warnings);
    if (stack.sign == Sign::sheet && !sheet)
        band.widen(both);
    for (int level = 0; level < plan.levels; ++level) {
        if (level > 0)
            band = band.coarser(stack.sign == Sign::sheet ? both : solid);
        stack.levels.push_back(finish(band, plan, stack, origin, level));
        done(1.0 - 0.2 * std::ldexp(1.0, -2 * level));
    }
    done(1.0);
    return stack;
}

}
