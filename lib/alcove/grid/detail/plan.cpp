#include "alcove/grid/detail/plan.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace alcove {
namespace {

constexpr float min_outer_band = 3.0f, min_inner_band = 2.0f; // voxels

// Measured peaks of resident memory. The bytes per voxel of the finest band include the grids and the bricks of their
// fields. Clustering was measured to take 90 bytes per triangle if edges are checked too.
constexpr double bytes_per_band_voxel = 60.0;
constexpr double bytes_per_clustered_triangle = 100.0;
constexpr double bytes_per_voxel_of_length = 100.0; // fragments of long triangles
// Measured: triangles that remain per voxel² of area after clustering. Clustering pays where it halves the count.
constexpr double triangles_after_clustering = 12.0;
constexpr double worth_clustering = 2.0 * triangles_after_clustering;
constexpr double finest_clustered = 1e-5; // a finer voxel has more cells than ClusteredSurface can number
// Size of all levels relative to the finest: 1 + 1/4 + 1/16 + ...
constexpr double levels_over_finest = 4.0 / 3.0;
constexpr double largest_index = 1 << 20;
constexpr double coarsest_voxel = 1.0; // the diagonal

/// Bytes = fixed + by_length / voxel + by_surface / voxel², with different terms if the surface is clustered.
struct Estimate {
    double area, triangles;
    bool may_cluster;
    double minimum, by_surface, by_length;

    Estimate(const SurfaceSize& size, std::size_t count, const GridOptions& options)
        : area(size.area), triangles(static_cast<double>(count)), may_cluster(options.cluster),
          by_length(bytes_per_voxel_of_length * size.length) {
        const double band = 2.0 * std::max(options.outer_band, min_outer_band);
        // The band around a point or a line is still a ball or a tube: at least one block of leaves.
        minimum = levels_over_finest * 4.0 * band * band * band * bytes_per_band_voxel;
        by_surface = levels_over_finest * area * band * bytes_per_band_voxel;
    }
    bool clusters(double voxel) const {
        return may_cluster && voxel > finest_clustered && triangles * voxel * voxel > worth_clustering * area;
    }
    double voxelized(double voxel) const {
        return clusters(voxel) ? triangles_after_clustering * area / (voxel * voxel) : triangles;
    }
    double bytes(double voxel) const {
        return minimum + by_surface / (voxel * voxel) + bytes_per_triangle * voxelized(voxel) +
               (clusters(voxel) ? bytes_per_clustered_triangle * triangles : by_length / voxel);
    }
    double finest(double limit) const {
        if (!(bytes(coarsest_voxel) < limit))
            return std::numeric_limits<double>::infinity();
        const auto solved = [&](double fixed, double by_length_there, double by_area) {
            const double left = limit - fixed, half = 0.5 * by_length_there / left;
            return half + std::sqrt(half * half + by_area / left);
        };
        const double unclustered = minimum + bytes_per_triangle * triangles;
        double voxel = solved(unclustered, by_length, by_surface);
        // Voxels below a certain size are built without clustering. If none of these fits, the finest voxel that fits
        // is built with clustering.
        if (!(unclustered < limit) || clusters(voxel))
            voxel = std::max(std::sqrt(worth_clustering * area / triangles),
                             solved(minimum + bytes_per_clustered_triangle * triangles, 0.0,
                                    by_surface + bytes_per_triangle * triangles_after_clustering * area));
        return std::max(voxel, 1.0 / largest_index);
    }
};

double limit_of(const GridOptions& options) {
    return std::min(options.memory_limit, memory_limit());
}

std::string too_many(std::size_t triangles, double bytes, const GridOptions& options) {
    return fmt::format("a grid of {} triangles needs {} GB or more, over the limit of {} GB: use fewer triangles, "
                       "raise --max-memory, or bake with --method exact, which needs no grid",
                       grouped(triangles), rounded(bytes / 1e9, 2), rounded(limit_of(options) / 1e9, 2));
}

}

SurfaceSize surface_size(const Mesh& mesh, std::span<const Triangle> triangles) {
    return surface_size(mesh, triangles, frame_of(mesh.box()));
}

SurfaceSize surface_size(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame) {
    const double scale = 1.0 / frame.diagonal;
    constexpr std::size_t grain = 16384;
    std::vector<SurfaceSize> sums((triangles.size() + grain - 1) / grain);
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        SurfaceSize sum;
        for (std::size_t i = begin; i < end; ++i) {
            prefetch_corners(triangles, i, mesh.positions.data());
            const Triangle& t = triangles[i];
            const Vec3d& a = mesh.positions[t[0]];
            const Vec3d ab = scale * (mesh.positions[t[1]] - a), ac = scale * (mesh.positions[t[2]] - a);
            const double ab2 = glm::dot(ab, ab), ac2 = glm::dot(ac, ac), cosine = glm::dot(ab, ac);
            sum.area += 0.5 * std::sqrt(std::max(ab2 * ac2 - cosine * cosine, 0.0)); // Lagrange's identity
            sum.length += std::sqrt(std::max({ab2, ac2, ab2 + ac2 - 2.0 * cosine}));
        }
        sums[begin / grain] = sum;
    });
    return std::accumulate(sums.begin(), sums.end(), SurfaceSize{}, [](const SurfaceSize& a, const SurfaceSize& b) {
        return SurfaceSize{a.area + b.area, a.length + b.length};
    });
}

float chosen_voxel(float radius, float largest_voxel) {
    return std::min(std::max(std::min(radius, 1.0f) / 8.0f, 1.0f / 1024.0f), largest_voxel);
}

double triangles_voxelized(double area, std::size_t triangles, double voxel, const GridOptions& options) {
    return Estimate({.area = area}, triangles, options).voxelized(voxel);
}

double finest_voxel(const SurfaceSize& size, std::size_t triangles, const GridOptions& options) {
    return Estimate(size, triangles, options).finest(limit_of(options));
}

LevelPlan plan_levels(const Mesh& mesh, std::span<const Triangle> triangles, const GridOptions& options) {
    return plan_levels(surface_size(mesh, triangles), triangles.size(), options);
}

LevelPlan plan_levels(const SurfaceSize& size, std::size_t triangles, const GridOptions& options) {
    const Estimate estimate(size, triangles, options);
    const double finest = estimate.finest(limit_of(options));
    if (!std::isfinite(finest))
        throw LimitError(too_many(triangles, estimate.bytes(coarsest_voxel), options));
    if (options.voxel > 0.0f && options.voxel < finest)
        throw LimitError(fmt::format("a voxel of {} % of the diagonal needs about {} GB, over the limit of {} GB: use "
                                     "--voxel {}% or more, use --voxel auto, or raise --max-memory",
                                     rounded(100.0 * options.voxel, 3), rounded(estimate.bytes(options.voxel) / 1e9, 2),
                                     rounded(limit_of(options) / 1e9, 2), std::ceil(1e4 * finest) / 100.0));
    LevelPlan plan;
    plan.outer_band = std::max(options.outer_band, min_outer_band);
    plan.inner_band = std::max(options.inner_band, min_inner_band);
    plan.voxel = options.voxel > 0.0f ? options.voxel
                                      : std::max(chosen_voxel(options.radius, options.largest_voxel),
                                                 std::nextafter(static_cast<float>(finest), 1.0f));
    plan.cluster = estimate.clusters(plan.voxel);
    plan.triangles = estimate.voxelized(plan.voxel);
    plan.bytes = estimate.bytes(plan.voxel);
    plan.spare_bytes = std::max(limit_of(options) - plan.bytes, 0.0);

    const float reach = std::min(options.radius, 1.0f);
    float usable = (plan.outer_band - 1.0f) * plan.voxel;
    while (usable < reach) {
        usable *= 2.0f;
        ++plan.levels;
    }
    return plan;
}

void check_clustered(const LevelPlan& plan, std::size_t triangles, const GridOptions& options) {
    const double bytes =
        plan.bytes + bytes_per_triangle * std::max(static_cast<double>(triangles) - plan.triangles, 0.0);
    if (bytes > limit_of(options))
        throw LimitError(too_many(triangles, bytes, options));
}

}
