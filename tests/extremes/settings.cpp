/// Extreme radii, voxels and numbers of rays.
#include "extreme.h"
#include "shapes.h"

#include "alcove/base/types.h"

#include <fmt/format.h>

#include <cmath>

namespace alcove::extremes {
namespace {

Mesh two_boxes() {
    Mesh mesh = test::box_mesh({0.5, 0.5, 0.1}, 1);
    test::add_part(mesh, test::box_mesh({0.4, 0.4, 0.1}, 1), 1.0, {0.0, 0.0, 0.25});
    return mesh;
}

}

std::vector<Extreme> settings() {
    std::vector<Extreme> rows;
    const auto add = [&](std::string name, std::string must, std::function<Result()> run) {
        rows.push_back({"setting", std::move(name), std::move(must), std::move(run)});
    };
    for (const float radius : {1e-6f, 1e-4f})
        add(fmt::format("radius {:g} of D", radius), "1, within 0.02: nothing occludes a convex surface", [=] {
            return against_value(Baked(test::sphere_mesh(5), {.radius = radius}), 1.0f, {"traced", "guided", "exact"},
                                 0.02);
        });
    for (const float radius : {1e-2f, 0.5f, 1.0f, 100.0f, std::numeric_limits<float>::infinity()})
        add(fmt::format("radius {:g} of D", radius), "RMSE at most 0.03 against exact rays", [=] {
            return against_exact(Baked(bumpy(), {.radius = radius}), {"traced", "guided", "exact"}, 0.03);
        });
    for (const float voxel : {2.0f, 0.5f, 0.1f})
        add(fmt::format("voxel {:g} of D", voxel), "in [0, 1], and a warning with a voxel that resolves occlusion",
            [=] {
                Result result =
                    against_value(Baked(bumpy(), {.voxel = voxel}), 0.5f, {"traced", "calibrated", "classic"}, 0.5);
                const bool warned = result.note.find("too coarse to resolve occlusion") != std::string::npos;
                result.figures.push_back({"warnings missing", warned ? 0.0 : 1.0, 0.0});
                return result;
            });
    for (const float voxel : {1.0f / 64, 1.0f / 512, 1.0f / 1024})
        add(fmt::format("voxel 1/{:g} of D", 1.0f / voxel), "RMSE at most 0.03 against exact rays", [=] {
            return against_exact(Baked(bumpy(), {.voxel = voxel}), {"traced", "guided"}, 0.03);
        });
    for (const float voxel : {1e-5f, 1e-7f, 1e-20f})
        add(fmt::format("voxel {:g} of D", voxel), "an error that names the finest voxel that fits",
            [=] { return refused<LimitError>([=] { const Baked baked(bumpy(), {.voxel = voxel}); }); });
    for (const int rays : {1, 2, 7, 1000, 1'000'000})
        add(fmt::format("{} rays", rays), "RMSE at most the larger of 0.6 / √rays and 0.012", [=] {
            // With so many rays, a few vertices suffice.
            const Mesh mesh = rays > 100'000 ? two_boxes() : bumpy();
            return against_exact(Baked(mesh, {.rays = rays}), {"traced", "exact"},
                                 std::max(0.6 / std::sqrt(rays), 0.012));
        });
    return rows;
}

}
