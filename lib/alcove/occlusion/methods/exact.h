/// Traces rays over the hemisphere against the triangles: the reference for every other estimator.
#pragma once

#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/occluders.h"

namespace alcove {

/// Visibility along cosine-weighted, low-discrepancy directions, rotated for each surfel by a hash of its position:
///
///     ao = 1/N Σ V(ω_i)        bent normal = normalize(Σ V(ω_i) ω_i)
///
/// V = 0 if the ray hits a triangle closer than the radius, else 1. Rays start at a height of ray_offset() above p, and
/// clear of any other faces that p touches. As the number of rays grows, ao converges to the reference, A(p) = 1/π ∫
/// V(ω) max(0, n·ω) dω. Source: lecture notes (aolecture). Cost: `rays` rays per surfel, no map() calls.
struct Exact {
    float radius = 0.1f; ///< > 0; may be infinite
    int rays = 64;       ///< per surfel, >= 1; the error is about 0.016 at 64 and 0.0025 at 1,024
    std::uint32_t seed = 0;

    static constexpr std::string_view name = "exact";
    static constexpr std::string_view summary = "cosine-weighted rays against the mesh itself: the reference";
    static constexpr std::string_view formula = "1/N sum V(w_i)";
    static constexpr std::string_view source = "04 Ambient Occlusion, lecture notes";
    static constexpr std::string_view cost = "0 map() calls per point, and 64 rays on the mesh";
    static constexpr std::string_view good = "the reference itself: no grid, no bias, any radius; gives bent normals";
    static constexpr std::string_view bad =
        "noise proportional to about 1/rays^0.7; needs the mesh; slow on dense meshes";
    static constexpr bool unbounded_radius = true; ///< the radius may be infinite
    static constexpr ChannelSet gives = Channel::ao | Channel::bent_normal;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Exact::rays>("rays", 1, 1 << 20, "rays", "number of rays in the hemisphere"),
            parameter<&Exact::seed>("seed", 0, 0xffffffffu, "", "random seed of the directions"),
        };
    }

    void operator()(const RaySurface& surface, const SurfelBatch& surfels, const Outputs& out) const;
};

}
