/// Sphere tracing: marches rays through a field in steps as long as the distances that it returns (Hart 1996).
#pragma once

#include "alcove/field/field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace alcove {

struct TraceOptions {
    float far = 1.0f;           ///< distance along the ray beyond which the ray is a miss; may be infinite
    float hit_distance = 1e-4f; ///< a ray hits the surface where map() is less than this
    float shortest_step = 1e-4f;
    int max_steps = 1024; ///< a ray without a hit after this many steps is a miss
    /// Over-relaxation (Keinert et al. 2014): steps are this factor times the distance, in [1, 2). A step
    /// longer than the sum of the distances at its ends is undone, and the ray continues with a factor of 1.
    float relaxation = 1.0f;
    /// Whether the field is two_sided(): the negative side counts as outside too, and the sign may jump where there is
    /// no surface. A ray then hits where the absolute distance is below `hit_distance`, or where the sign changes after
    /// a step that was long enough to cross the surface.
    bool two_sided = false;
};

/// Rays in arrays, which are marched together: each step is one batched map() call.
struct RayBatch {
    static constexpr std::size_t capacity = 256;
    using Values = std::array<float, capacity>;

    Values x, y, z;    ///< origins
    Values dx, dy, dz; ///< unit directions
    Values travelled;  ///< in: where the ray starts; out: where it hits, or at least `far`
    std::array<bool, capacity> hit;
    std::array<std::uint16_t, capacity> steps; ///< map() calls spent on each ray
    std::size_t count = 0;

    void push_back(const Ray& ray, float start) {
        x[count] = ray.origin.x, y[count] = ray.origin.y, z[count] = ray.origin.z;
        dx[count] = ray.direction.x, dy[count] = ray.direction.y, dz[count] = ray.direction.z;
        travelled[count++] = start;
    }
};

/// Marches all rays of the batch. Cost: `steps` map() calls per ray.
template <Field F>
void trace(const F& field, RayBatch& rays, const TraceOptions& options) {
    RayBatch::Values x, y, z, distance, previous, stepped, relaxation;
    std::array<std::uint16_t, RayBatch::capacity> active;
    std::size_t count = rays.count;
    for (std::size_t i = 0; i < count; ++i) {
        active[i] = static_cast<std::uint16_t>(i);
        rays.hit[i] = false;
        rays.steps[i] = 0;
        previous[i] = stepped[i] = 0.0f;
        relaxation[i] = options.relaxation;
    }
    const bool relaxes = options.relaxation > 1.0f && !options.two_sided;
    const auto meets = [&](std::size_t i, float d) {
        if (!options.two_sided)
            return d < options.hit_distance;
        // If the step crossed a surface, the distances at its ends add up to at most its length, apart from
        // interpolation errors.
        constexpr float tolerance = 1.2f;
        return std::fabs(d) < options.hit_distance ||
               (d * previous[i] < 0.0f && std::fabs(d) + std::fabs(previous[i]) < tolerance * stepped[i]);
    };
    for (int step = 0; step < options.max_steps && count > 0; ++step) {
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = active[k];
            x[k] = rays.x[i] + rays.travelled[i] * rays.dx[i];
            y[k] = rays.y[i] + rays.travelled[i] * rays.dy[i];
            z[k] = rays.z[i] + rays.travelled[i] * rays.dz[i];
        }
        map_batch(field, Points{x.data(), y.data(), z.data(), count}, any_reach, distance.data());
        std::size_t left = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint16_t i = active[k];
            const float d = distance[k];
            ++rays.steps[i];
            if (relaxes && relaxation[i] > 1.0f && stepped[i] > options.shortest_step && previous[i] + d < stepped[i]) {
                const float safe = std::max(previous[i], options.shortest_step);
                rays.travelled[i] -= stepped[i] - safe;
                stepped[i] = safe;
                relaxation[i] = 1.0f;
                active[left++] = i;
                continue;
            }
            if (meets(i, d)) {
                rays.hit[i] = true;
                // Interpolate linearly between the points in front of and behind the surface.
                if (!options.two_sided && d < 0.0f && previous[i] > 0.0f)
                    rays.travelled[i] += stepped[i] * d / (previous[i] - d);
                continue;
            }
            previous[i] = d;
            // Behind a sheet, interpolated distances are slightly too long, and a step through the sheet would not be
            // detected.
            constexpr float caution = 0.85f;
            stepped[i] = std::max(options.two_sided ? caution * std::fabs(d) : d, options.shortest_step);
            // Do not relax a step beyond `far`: it could not be undone.
            if (relaxes && rays.travelled[i] + relaxation[i] * d < options.far)
                stepped[i] = std::max(relaxation[i] * d, options.shortest_step);
            rays.travelled[i] += stepped[i];
            active[left] = i;
            left += rays.travelled[i] < options.far;
        }
        count = left;
    }
    // A ray that ran out of steps is a miss.
    for (std::size_t k = 0; k < count; ++k)
        rays.travelled[active[k]] = std::max(rays.travelled[active[k]], options.far);
}

}
