/// Sphere-traces rays over the hemisphere through the field. Converges to the reference with more rays and finer
/// voxels.
#pragma once

#include "alcove/field/detail/trace.h"
#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"

#include <numeric>

namespace alcove {

/// Finds the heights at which rays start (see Surfel::origin()): where the field is at least `clearance`. No height
/// exceeds `highest`. A constant height does not suffice: a surfel is on the true surface, not on the interpolated
/// surface of the grid, and at a sharp edge, moving along the normal gains little distance from the faces. A constant
/// height that is safe for all surfels (a voxel) would be the largest source of error when tracing through a grid;
/// these heights cause a tenth of that error. Cost: 1 to 6 map() calls per surfel.
template <Field F>
void clear_of_surface(const F& field, const SurfelBatch& surfels, float clearance, float highest, float* heights) {
    ProbeBatch probes;
    SurfelBatch::Values distances;
    std::array<std::uint8_t, SurfelBatch::capacity> low; // surfels whose height is still too small
    std::size_t count = surfels.count;
    std::iota(low.begin(), low.begin() + count, std::uint8_t{0});
    std::fill_n(heights, count, clearance);
    for (int step = 0; step < 6 && count > 0; ++step) {
        for (std::size_t k = 0; k < count; ++k)
            probes.set(k, surfels.origin(low[k], heights[low[k]]));
        map_probes(field, probes, count, highest, distances.data());
        std::size_t left = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const float d = distances[k];
            if (d >= clearance)
                continue;
            float& height = heights[low[k]];
            height = std::min(height * (d > 0.25f * clearance ? clearance / d : 2.0f), highest);
            low[left] = low[k];
            left += height < highest;
        }
        count = left;
    }
}

/// Turns misses into hits where a ray descends to the surface: where its end is closer to the surface than
/// `low[owner]`, and its middle is closer than 1.5 times that. In a crease, the rays of a lifted surfel pass over walls
/// that they would hit without the lift. Cost: two map() calls per miss with low[owner] > 0.
template <Field F>
void hit_walls_passed(const F& field, RayBatch& rays, float far, const std::uint8_t* owner, const float* low) {
    RayBatch::Values x, y, z, middle, end;
    std::array<std::uint16_t, RayBatch::capacity> missed;
    std::size_t count = 0;
    for (std::size_t r = 0; r < rays.count; ++r)
        if (!rays.hit[r] && low[owner[r]] > 0.0f)
            missed[count++] = static_cast<std::uint16_t>(r);
    const auto map_at = [&](float travelled, RayBatch::Values& distances) {
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t r = missed[k];
            x[k] = rays.x[r] + travelled * rays.dx[r];
            y[k] = rays.y[r] + travelled * rays.dy[r];
            z[k] = rays.z[r] + travelled * rays.dz[r];
        }
        map_batch(field, Points{x.data(), y.data(), z.data(), count}, any_reach, distances.data());
    };
    map_at(0.5f * far, middle);
    map_at(far, end);
    for (std::size_t k = 0; k < count; ++k) {
        const float limit = low[owner[missed[k]]];
        rays.hit[missed[k]] = std::fabs(end[k]) < limit && std::fabs(middle[k]) < 1.5f * limit;
    }
}

/// The length at which rays end: beyond it, a hit is impossible or negligible, and more steps would be wasted. Surfaces
/// of an unbounded field beyond the horizon are seen edge-on and cover less than 1/horizon of the hemisphere.
template <Field F>
float longest_ray(const F& field, float radius) {
    constexpr float horizon = 100.0f;
    return std::min({radius, 2.0f * extent(field), horizon});
}

/// Visibility along `rays` low-discrepancy directions, rotated for each surfel by a hash of its position:
///
///     cosine-weighted: ao = 1/N Σ V(ω_i)        uniform: ao = 2/N Σ V(ω_i) cos θ_i
///
/// V = 0 if the ray hits the surface within the radius, else 1. The bent normal is the normalised mean of the open
/// directions, weighted by cos θ in both forms. Rays start where the distance to the surface is start_height(): a tenth
/// of a voxel, or ray_offset() in analytic fields. See also hit_walls_passed(). Source: lecture notes (aolecture).
/// Cost: 1 to 6 map() calls per surfel, plus 5–20 per ray.
struct Traced {
    float radius = 0.1f; ///< > 0; may be infinite
    int rays = 64;       ///< per surfel, >= 1
    bool cosine_weighted = true;
    std::uint32_t seed = 0;

    static constexpr std::string_view name = "traced";
    static constexpr std::string_view summary = "sphere-traced rays over the hemisphere, cosine-weighted";
    static constexpr std::string_view formula = "1/N sum V(w_i)";
    static constexpr std::string_view source = "04 Ambient Occlusion, lecture notes";
    static constexpr std::string_view cost = "1-6 map() calls per point, and 5-20 for each of 64 rays";
    static constexpr std::string_view good =
        "converges to exact rays with more rays and finer voxels; needs no mesh; gives bent normals";
    static constexpr std::string_view bad =
        "the slowest method on grids; noise proportional to about 1/rays^0.7; blurs detail below a voxel";
    static constexpr bool unbounded_radius = true; ///< the radius may be infinite
    static constexpr ChannelSet gives = Channel::ao | Channel::bent_normal;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Traced::rays>("rays", 1, 1 << 20, "rays", "number of rays in the hemisphere"),
            parameter<&Traced::cosine_weighted>("cosine_weighted", 0, 1, "",
                                                "more rays near the normal instead of uniform directions"),
            parameter<&Traced::seed>("seed", 0, 0xffffffffu, "", "random seed of the directions"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        const float voxel = resolution(field), clearance = start_height(field, radius);
        TraceOptions options;
        options.far = longest_ray(field, radius);
        options.hit_distance = 0.05f * clearance;
        options.shortest_step = 2.5f * clearance;
        options.two_sided = two_sided(field);
        SurfelBatch::Values heights;
        clear_of_surface(field, surfels, clearance, 2.0f * std::max(voxel, clearance), heights.data());
        // If a surfel was lifted, the walls of its crease are between half its height and its whole height away.
        SurfelBatch::Values low;
        for (std::size_t i = 0; i < surfels.count; ++i)
            low[i] = heights[i] > clearance && std::isfinite(radius) ? 0.5f * heights[i] : 0.0f;

        SurfelBatch::Values open{};
        std::array<Vec3, SurfelBatch::capacity> mean{};
        RayBatch batch;
        std::array<std::uint8_t, RayBatch::capacity> owner;
        std::array<float, RayBatch::capacity> weight;
        const auto flush = [&] {
            trace(field, batch, options);
            hit_walls_passed(field, batch, options.far, owner.data(), low.data());
            for (std::size_t r = 0; r < batch.count; ++r)
                if (!batch.hit[r]) {
                    open[owner[r]] += weight[r];
                    mean[owner[r]] += weight[r] * Vec3(batch.dx[r], batch.dy[r], batch.dz[r]);
                }
            batch.count = 0;
        };
        for (std::size_t i = 0; i < surfels.count; ++i) {
            const Basis basis(surfels.normal(i));
            const Vec3 origin = surfels.origin(i, heights[i]);
            const std::uint32_t h = hash(surfels.position(i), seed);
            const float shift_u = unit_interval(h), shift_v = unit_interval(hash(h));
            for (int r = 0; r < rays; ++r) {
                const Vec2 uv = fibonacci_point(r, rays, shift_u, shift_v);
                const Vec3 local = cosine_weighted ? cosine_hemisphere(uv.x, uv.y) : uniform_hemisphere(uv.x, uv.y);
                owner[batch.count] = static_cast<std::uint8_t>(i);
                weight[batch.count] = cosine_weighted ? 1.0f : 2.0f * local.z;
                batch.push_back({origin, basis.to_world(local)}, 0.0f);
                if (batch.count == RayBatch::capacity)
                    flush();
            }
        }
        flush();
        for (std::size_t i = 0; i < surfels.count; ++i)
            out[Channel::ao][i] = std::min(open[i] / static_cast<float>(rays), 1.0f);
        if (float* bent = out[Channel::bent_normal])
            for (std::size_t i = 0; i < surfels.count; ++i) {
                const float length = glm::length(mean[i]);
                const Vec3 direction = length > 1e-6f ? mean[i] / length : Vec3(0.0f);
                bent[3 * i] = direction.x, bent[3 * i + 1] = direction.y, bent[3 * i + 2] = direction.z;
            }
    }
};

}
