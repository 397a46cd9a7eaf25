/// Walls and gaps about as thin as a voxel, which is D/256 by default.
#include "extreme.h"
#include "shapes.h"

#include "alcove/bake/bake.h"
#include "alcove/bake/detail/pilot.h"
#include "alcove/base/types.h"

#include <fmt/format.h>

namespace alcove::extremes {
namespace {

constexpr double voxel = 1.0 / 256.0;
constexpr double bound = 0.035;
const Methods rays = {"traced", "guided", "exact"};

/// Two boxes one above the other.
Mesh boxes_apart(double gap) {
    const Mesh box = test::box_mesh({0.4, 0.3, 0.07}, 24);
    Mesh both;
    test::add_part(both, box, 1.0, {0.0, 0.0, -0.07});
    test::add_part(both, box, 1.0, {0.0, 0.0, 0.07 + gap});
    return both;
}

/// A wall on a block, with vertices on all sides.
Mesh wall_on_block(double thickness) {
    Mesh both = test::box_mesh({0.4, 0.3, 0.1}, 24);
    test::add_part(both, test::box_mesh({0.5 * thickness, 0.25, 0.1}, 24), 1.0, {0.0, 0.0, 0.21});
    return both;
}

/// If traced exceeds the bound, a warning must name a voxel that resolves the walls, and the error at that voxel must
/// be within the bound. Exception: if that voxel does not fit into memory, the warning names only guided.
Result resolved_or_warned(const Mesh& mesh, const Baking& baking = {}) {
    const Baked baked(mesh, baking);
    Result result = against_exact(baked, rays, bound);
    Figure& traced = result.figures.front();
    const float resolving = baked.resolving_voxel();
    if (traced.holds() || resolving == 0.0f)
        return result;
    result.note += fmt::format(" (traced at the default voxel: {:.2g})", traced.value);
    Baking finer = baking;
    finer.voxel = resolving;
    try {
        traced = against_exact(Baked(mesh, finer), {"traced"}, bound).figures.front();
        traced.of = "traced at that voxel";
    } catch (const LimitError& refusal) {
        result.figures.erase(result.figures.begin());
        result.note += std::string("; ") + refusal.what();
    }
    return result;
}

/// The true RMSE of a planned bake. The bound is the requested error plus 15 %.
Result planned(const Mesh& mesh, double error) {
    constexpr float radius = 0.1f;
    const alcove::Baked baked = bake(mesh, {.via = Via::automatic, .error = error});
    const MeasuredMesh measured("mesh", mesh);
    const std::vector<float> truth =
        evaluate_ao(measured.surfels, measured.rays, Exact{.radius = radius, .rays = 1024, .seed = 0x2c41});
    return {{{baked.method, compare(baked.ao(), truth).rmse, 1.15 * error}},
            baked.grid_summary.levels > 0 ? fmt::format("voxel {:.2g}", baked.grid_summary.voxel) : "no grid"};
}

}

std::vector<Extreme> thin_features() {
    std::vector<Extreme> rows;
    const auto add = [&](std::string name, std::function<Result()> run) {
        rows.push_back(
            {"thin", std::move(name),
             fmt::format("RMSE at most {} against exact rays, or a warning with a voxel that achieves it", bound),
             std::move(run)});
    };
    for (const double gap : {0.1, 0.25, 0.5, 1.0, 2.0, 4.0})
        add(fmt::format("gap of {} voxels between boxes", gap),
            [=] { return resolved_or_warned(boxes_apart(gap * voxel)); });
    for (const double gap : {0.1, 0.5, 1.0, 2.0, 4.0})
        add(fmt::format("slot of {} voxels", gap),
            [=] { return resolved_or_warned(comb(2, 0.35, gap * voxel, true)); });
    for (const double wall : {0.01, 0.1, 0.5, 1.0, 2.0})
        add(fmt::format("wall of {} voxels on a block", wall),
            [=] { return resolved_or_warned(wall_on_block(wall * voxel)); });
    for (const double gap : {0.5, 2.0, 4.0})
        for (const double wall : {0.25, 0.5, 1.0, 1.5, 2.0})
            add(fmt::format("8 fins of {} voxels, {} apart", wall, gap),
                [=] { return resolved_or_warned(comb(8, wall * voxel, gap * voxel, true)); });
    for (const double gap : {1.0, 4.0})
        for (const double wall : {0.5, 1.0, 2.0})
            add(fmt::format("8 fins of {} voxels, {} apart, as a sheet", wall, gap), [=] {
                return resolved_or_warned(comb(8, wall * voxel, gap * voxel, true), {.sign = SignChoice::sheet});
            });
    for (const double error : {0.05, 0.02})
        for (const double wall : {0.25, 1.0})
            rows.push_back({"thin", fmt::format("8 fins of {} voxels, --error {}", wall, error),
                            "the requested RMSE, within 15 %",
                            [=] { return planned(comb(8, wall * voxel, 2.0 * voxel, true), error); }});
    return rows;
}

}
