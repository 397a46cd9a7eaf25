/// Rays over the hemisphere, sphere-traced through the field: what tends to the reference as rays and voxels
/// do.
#pragma once

#include "alcove/field/trace.h"
#include "alcove/occlusion/directions.h"
#include "alcove/occlusion/estimator.h"

namespace alcove {

/// The heights along the normals from which rays may start: where the field itself answers at least
/// `clearance`, at most `highest`. A surfel lies on the true surface, so beside the interpolated one of a
/// grid, and the normal of a sharp edge leaves its faces slowly; a fixed height safe for all of them (a
/// voxel) is the largest error of tracing through a grid, these are a tenth of it. Cost: 6 map() calls a
/// surfel.
template <Field F>
void clear_of_surface(const F& field, const SurfelBatch& surfels, float clearance, float highest,
                      float* heights) {
    SurfelBatch::Values x, y, z, distances;
    std::fill_n(heights, surfels.count, clearance);
    for (int step = 0; step < 6; ++step) {
        for (std::size_t i = 0; i < surfels.count; ++i) {
            x[i] = surfels.x[i] + heights[i] * surfels.nx[i];
            y[i] = surfels.y[i] + heights[i] * surfels.ny[i];
            z[i] = surfels.z[i] + heights[i] * surfels.nz[i];
        }
        map_batch(field, Points{x.data(), y.data(), z.data(), surfels.count}, any_reach, distances.data());
        for (std::size_t i = 0; i < surfels.count; ++i)
            if (distances[i] < clearance)
                heights[i] *= distances[i] > 0.25f * clearance ? clearance / distances[i] : 2.0f;
        for (std::size_t i = 0; i < surfels.count; ++i)
            heights[i] = std::min(heights[i], highest);
    }
}

/// Visibility along `rays` directions, low-discrepancy, rotated for each surfel by a hash of its position:
///
///     cosine-weighted: ao = 1/N Σ V(ω_i)        uniform: ao = 2/N Σ V(ω_i) cos θ_i
///
/// V = 0 where the ray meets the surface within the radius. Source: "04 Ambient Occlusion", lecture notes.
/// Rays start where the field answers a tenth of a voxel, or 1e-4 for exact fields. Cost: 6 + rays ×
/// 5–20 map() calls a surfel.
struct Traced {
    float radius = 0.1f; ///< > 0; may be infinite, at a cost of up to 1,024 map() calls for an open ray
    int rays = 64;       ///< a surfel, >= 1
    bool cosine_weighted = true;
    std::uint32_t seed = 0;

    static constexpr std::string_view name = "traced";
    static constexpr std::string_view summary = "sphere-traced rays over the hemisphere, cosine-weighted";
    static constexpr std::string_view formula = "1/N sum V(w_i)";
    static constexpr std::string_view source = "04 Ambient Occlusion, lecture notes";
    static constexpr std::string_view cost = "6 + rays (64) x 5-20";

    static Traced from(const EstimatorOptions& options) {
        // In unit space nothing is further than the diagonal, and a miss beyond it costs steps for nothing.
        Traced traced{.radius = std::min(options.radius, 1.0f), .seed = options.seed};
        if (options.rays > 0)
            traced.rays = options.rays;
        return traced;
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, float* ao) const {
        // In voxels for grids; for exact fields the contract of the reference, 1e-4 of the diagonal.
        const float voxel = resolution(field);
        const float clearance = std::max(0.1f * voxel, 1e-4f);
        TraceOptions options;
        options.far = radius;
        options.hit_distance = 0.05f * clearance;
        options.shortest_step = 2.5f * clearance;
        options.two_sided = two_sided(field);
        SurfelBatch::Values heights;
        clear_of_surface(field, surfels, clearance, 2.0f * std::max(voxel, clearance), heights.data());

        std::array<float, SurfelBatch::capacity> open{};
        RayBatch batch;
        std::array<std::uint8_t, RayBatch::capacity> owner;
        std::array<float, RayBatch::capacity> weight;
        const auto flush = [&] {
            trace(field, batch, options);
            for (std::size_t r = 0; r < batch.count; ++r)
                if (!batch.hit[r])
                    open[owner[r]] += weight[r];
            batch.count = 0;
        };
        for (std::size_t i = 0; i < surfels.count; ++i) {
            const Basis basis(surfels.normal(i));
            const Vec3 origin = surfels.position(i) + heights[i] * basis.normal;
            const std::uint32_t h = hash(surfels.position(i), seed);
            const float shift_u = unit_interval(h), shift_v = unit_interval(hash(h));
            for (int r = 0; r < rays; ++r) {
                const Vec2 uv = fibonacci_point(r, rays, shift_u, shift_v);
                const Vec3 local =
                    cosine_weighted ? cosine_hemisphere(uv.x, uv.y) : uniform_hemisphere(uv.x, uv.y);
                owner[batch.count] = static_cast<std::uint8_t>(i);
                weight[batch.count] = cosine_weighted ? 1.0f : 2.0f * local.z;
                batch.push_back({origin, basis.to_world(local)}, 0.0f);
                if (batch.count == RayBatch::capacity)
                    flush();
            }
        }
        flush();
        for (std::size_t i = 0; i < surfels.count; ++i)
            ao[i] = std::min(open[i] / static_cast<float>(rays), 1.0f);
    }
};

}
