/// Radii, voxels and numbers of rays from one end to the other.
#include "extreme.h"
#include "shapes.h"

#include "alcove/errors.h"

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
        add(fmt::format("radius {:g} of D", radius), "1, within 0.02: nothing is that near on a smooth body",
            [=] {
                return against_value(bumpy(), 1.0f, {"traced", "guided", "exact"}, 0.02, {.radius = radius});
            });
    for (const float radius : {1e-2f, 0.5f, 1.0f, 100.0f, std::numeric_limits<float>::infinity()})
        add(fmt::format("radius {:g} of D", radius), "RMSE of 0.03 against exact rays", [=] {
            return against_exact(bumpy(), {"traced", "guided", "exact"}, 0.03, {.radius = radius});
        });
    for (const float voxel : {2.0f, 0.5f, 0.1f})
        add(fmt::format("voxel {:g} of D", voxel),
            "in [0, 1], and a warning with a voxel that tells occlusion", [=] {
                Result result =
                    against_value(bumpy(), 0.5f, {"traced", "calibrated", "classic"}, 0.5, {.voxel = voxel});
                const std::vector<std::string> warnings = Baked(bumpy(), {.voxel = voxel}).warnings();
                result.figures.push_back({"warnings missing", warnings.empty() ? 1.0 : 0.0, 0.0});
                result.note = warnings.empty() ? "" : warnings.front();
                return result;
            });
    for (const float voxel : {1.0f / 64, 1.0f / 512, 1.0f / 1024})
        add(fmt::format("voxel 1/{:g} of D", 1.0f / voxel), "RMSE of 0.03 against exact rays", [=] {
            return against_exact(bumpy(), {"traced", "guided"}, 0.03, {.voxel = voxel});
        });
    for (const float voxel : {1e-5f, 1e-7f, 1e-20f})
        add(fmt::format("voxel {:g} of D", voxel), "a refusal that names the finest voxel that fits",
            [=] { return refused<LimitError>([=] { const Baked baked(bumpy(), {.voxel = voxel}); }); });
    for (const int rays : {1, 2, 7, 1000, 1'000'000})
        add(fmt::format("{} rays", rays),
            "RMSE of 0.6 over the root of the rays, but of 0.012 at most beyond, against exact rays", [=] {
                // Few vertices suffice for many rays.
                return against_exact(rays > 100'000 ? two_boxes() : bumpy(), {"traced", "exact"},
                                     std::max(0.6 / std::sqrt(rays), 0.012), {.rays = rays});
            });
    return rows;
}

}
