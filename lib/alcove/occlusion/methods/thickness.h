/// The thickness of a solid or sheet below a surfel.
#pragma once

#include "alcove/occlusion/methods/traced.h"

namespace alcove {

/// The field with inside and outside swapped; unchanged for sheets, both sides of which count as outside.
template <Field F>
struct Inverted {
    const F& field;

    float map(const Vec3& p) const { return two_sided() ? field.map(p) : -field.map(p); }
    void map(const Points& points, float reach, float* distances) const {
        map_batch(field, points, reach, distances);
        if (!two_sided())
            for (std::size_t i = 0; i < points.count; ++i)
                distances[i] = -distances[i];
    }
    float resolution() const { return alcove::resolution(field); }
    bool two_sided() const { return alcove::two_sided(field); }
};

/// thickness = min(radius, distance from p along −n to the next surface), sphere-traced with one ray (Hart 1996). In a
/// solid the search starts at most half a voxel deep, so the error is at most half a voxel for walls that are thinner
/// than that. Behind a sheet the ray starts 1.9 voxels deep and misses anything nearer. Cost: 4–20 map() calls per
/// surfel.
struct Thickness {
    float radius = 0.1f; ///< largest thickness, > 0; may be infinite

    static constexpr std::string_view name = "thickness";
    static constexpr std::string_view summary = "one ray along the reversed normal to the far side";
    static constexpr std::string_view formula = "min(radius, distance from p along -n to the next surface)";
    static constexpr std::string_view source = "sphere tracing: J. C. Hart (1996)";
    static constexpr std::string_view cost = "4-20 map() calls per point";
    static constexpr std::string_view good = "accurate to a voxel on plates and solids";
    static constexpr std::string_view bad = "on open surfaces it measures the distance to whatever is behind";
    static constexpr bool unbounded_radius = true; ///< the radius may be infinite
    static constexpr ChannelSet gives = Channel::thickness;

    static constexpr std::array<Parameter<Thickness>, 0> parameters() { return {}; }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        const Inverted<F> inside{field};
        SurfelBatch turned;
        for (std::size_t i = 0; i < surfels.count; ++i)
            turned.push_back({surfels.position(i), -surfels.normal(i)});
        const float voxel = resolution(field), clearance = start_height(field, radius);
        SurfelBatch::Values depths;
        TraceOptions options;
        options.far = longest_ray(field, radius);
        if (inside.two_sided()) {
            std::fill_n(depths.begin(), surfels.count, behind_sheet * voxel);
        } else {
            clear_of_surface(inside, turned, clearance, std::max(0.5f * voxel, clearance), depths.data());
            leave_surface(inside, turned, clearance, options.far, depths.data());
        }
        options.hit_distance = 0.05f * clearance;
        options.shortest_step = clearance;
        options.two_sided = inside.two_sided();
        RayBatch rays;
        std::array<std::uint8_t, SurfelBatch::capacity> owner;
        for (std::size_t i = 0; i < surfels.count; ++i) {
            out[Channel::thickness][i] = options.far;
            owner[rays.count] = static_cast<std::uint8_t>(i);
            if (depths[i] < options.far)
                rays.push_back({turned.position(i), turned.normal(i)}, depths[i]);
        }
        trace(inside, rays, options);
        if (inside.two_sided())
            pass_negative_layer(field, rays, voxel);
        for (std::size_t r = 0; r < rays.count; ++r)
            out[Channel::thickness][owner[r]] = std::min(rays.travelled[r], options.far);
    }

  private:
    /// Increases each depth along the ray for as long as the empty balls around a series of probes overlap. Each probe
    /// is four times as deep as the one before. A ray along the normal moves straight away from the surface, so these
    /// probes advance much farther than sphere tracing from ball to ball (Keinert et al. 2014).
    template <Field F>
    static void leave_surface(const F& inside, const SurfelBatch& turned, float clearance, float far, float* depths) {
        // The ball around a probe a little beyond the middle of the ray can reach the end of the ray.
        const float deepest = 0.55f * far;
        float depth = deepest;
        while (depth > 16.0f * clearance)
            depth *= 0.25f;
        ProbeBatch probes;
        SurfelBatch::Values distances;
        std::array<std::uint8_t, SurfelBatch::capacity> leaving;
        std::size_t count = turned.count;
        std::iota(leaving.begin(), leaving.begin() + count, std::uint8_t{0});
        for (; depth <= deepest && count > 0; depth *= 4.0f) {
            for (std::size_t k = 0; k < count; ++k)
                probes.set(k, turned.position(leaving[k]) + depth * turned.normal(leaving[k]));
            map_probes(inside, probes, count, depth, distances.data());
            std::size_t left = 0;
            for (std::size_t k = 0; k < count; ++k)
                if (float& free = depths[leaving[k]]; depth - distances[k] <= free) {
                    free = std::max(free, depth + distances[k]);
                    leaving[left++] = leaving[k];
                }
            count = left;
        }
    }

    /// Grid samples up to 1.5 voxels behind a sheet are negative. Interpolation with the next samples behind them
    /// produces a false surface, at most 1.5 + 1.5/(1.5 + 2.5) voxels behind the sheet.
    static constexpr float behind_sheet = 1.9f;

    /// Moves hits on the false surface of a far sheet forward to the sheet itself. One voxel before such a hit, the
    /// field still gives the true distance to the sheet.
    template <Field F>
    static void pass_negative_layer(const F& field, RayBatch& rays, float voxel) {
        ProbeBatch probes;
        SurfelBatch::Values distances;
        for (std::size_t i = 0; i < rays.count; ++i)
            probes.set(i, Vec3(rays.x[i], rays.y[i], rays.z[i]) +
                              (rays.travelled[i] - voxel) * Vec3(rays.dx[i], rays.dy[i], rays.dz[i]));
        map_probes(field, probes, rays.count, any_reach, distances.data());
        for (std::size_t i = 0; i < rays.count; ++i)
            if (rays.hit[i])
                rays.travelled[i] += std::clamp(distances[i] - voxel, 0.0f, behind_sheet * voxel);
    }
};

}
