#include "alcove/grid/plan.h"

#include "alcove/errors.h"
#include "alcove/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace alcove {
namespace {

// Measured peak of resident memory while voxelizing, over the voxels of the finest band.
constexpr double bytes_per_band_voxel = 60.0;
constexpr double bytes_per_triangle = 400.0;
// All levels together against the finest: 1 + 1/4 + 1/16 + ...
constexpr double levels_over_finest = 4.0 / 3.0;
constexpr double largest_index = 1 << 20;

struct Estimate {
    double surface;
    double band; // voxels, both sides
    double triangles;

    double bytes(double voxel) const {
        // A band around a point or a line still fills a ball or a tube: one block of leaves at least.
        const double voxels = surface / (voxel * voxel) * band + 4.0 * band * band * band;
        return levels_over_finest * voxels * bytes_per_band_voxel + triangles * bytes_per_triangle;
    }
    bool fits(double voxel, double limit) const {
        return bytes(voxel) <= limit && 1.0 / voxel <= largest_index;
    }
    double finest_that_fits(double voxel, double limit) const {
        while (!fits(voxel, limit) && voxel < 4.0)
            voxel *= 1.1;
        return voxel;
    }
};

}

double surface_area(const Mesh& mesh, std::span<const Triangle> triangles) {
    const Frame frame = frame_of(mesh.box());
    const double scale = 1.0 / frame.diagonal;
    constexpr std::size_t grain = 16384;
    std::vector<double> sums((triangles.size() + grain - 1) / grain);
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (const Triangle& t : triangles.subspan(begin, end - begin)) {
            const Vec3d& a = mesh.positions[t[0]];
            sum += glm::length(
                glm::cross(scale * (mesh.positions[t[1]] - a), scale * (mesh.positions[t[2]] - a)));
        }
        sums[begin / grain] = 0.5 * sum;
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

float chosen_voxel(float radius, float largest_voxel) {
    return std::min(std::max(std::min(radius, 1.0f) / 8.0f, 1.0f / 1024.0f), largest_voxel);
}

LevelPlan plan_levels(const Mesh& mesh, std::span<const Triangle> triangles, const GridOptions& options) {
    LevelPlan plan;
    plan.outer_band = std::max(options.outer_band, 3.0f);
    plan.inner_band = std::max(options.inner_band, 2.0f);
    const float reach = std::min(options.radius, 1.0f);
    const Estimate estimate{surface_area(mesh, triangles), 2.0 * plan.outer_band,
                            static_cast<double>(triangles.size())};

    if (options.voxel > 0.0f) {
        plan.voxel = options.voxel;
        if (!estimate.fits(plan.voxel, options.memory_limit)) {
            const double fitting = estimate.finest_that_fits(plan.voxel, options.memory_limit);
            throw LimitError(
                fmt::format("a voxel of {:.3g} % of the diagonal needs about {:.1f} GB, over the limit "
                            "of {:.1f} GB: use --voxel {:.2g}% or more, or --voxel auto",
                            100.0 * plan.voxel, estimate.bytes(plan.voxel) / 1e9, options.memory_limit / 1e9,
                            std::ceil(1e4 * fitting) / 100.0));
        }
    } else {
        const float wanted = chosen_voxel(options.radius, options.largest_voxel);
        plan.voxel = static_cast<float>(estimate.finest_that_fits(wanted, options.memory_limit));
    }
    plan.bytes = estimate.bytes(plan.voxel);

    float usable = (plan.outer_band - 1.0f) * plan.voxel;
    while (usable < reach) {
        usable *= 2.0f;
        ++plan.levels;
    }
    return plan;
}

}
