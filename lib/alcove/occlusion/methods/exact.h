/// Rays over the hemisphere against the triangles themselves: the reference every other estimator is held to.
#pragma once

#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/evaluate.h"
#include "alcove/occlusion/occluders.h"

namespace alcove {

/// Visibility along cosine-weighted directions, low-discrepancy, rotated for each surfel by a hash of its
/// position:
///
///     ao = 1/N Σ V(ω_i)        bent normal = normalize(Σ V(ω_i) ω_i)
///
/// V = 0 where the ray from p + 1e-4·n meets a triangle closer than the radius, else 1: it tends to the
/// reference, A(p) = 1/π ∫ V(ω) max(0, n·ω) dω, as rays grow. Source: "04 Ambient Occlusion", lecture notes.
/// No map() calls; `rays` rays a surfel.
struct Exact {
    float radius = 0.1f; ///< > 0; may be infinite
    int rays = 64;       ///< a surfel, >= 1; the error is about 0.016 at 64 and 0.003 at 1,024
    std::uint32_t seed = 0;

    /// Where rays start above the surface, of the diagonal, as the reference is defined.
    static constexpr float offset = 1e-4f;

    static constexpr std::string_view name = "exact";
    static constexpr std::string_view summary = "cosine-weighted rays on the mesh itself: the reference";
    static constexpr std::string_view formula = "1/N sum V(w_i)";
    static constexpr std::string_view source = "04 Ambient Occlusion, lecture notes";
    static constexpr std::string_view cost = "0, and rays (64) on the mesh";

    static constexpr std::string_view good =
        "the reference itself: no grid, no bias, any radius; gives bent normals";
    static constexpr std::string_view bad =
        "noise of 1/rays^0.75; needs the mesh, its rays are dear on dense ones";
    static constexpr bool unbounded_radius = true; ///< the radius may be infinite
    static constexpr ChannelSet gives = Channel::ao | Channel::bent_normal;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Exact::rays>("rays", 1, 1 << 20, "rays", "in the hemisphere"),
            parameter<&Exact::seed>("seed", 0, 0xffffffffu, "", "of the directions"),
        };
    }

    void operator()(const RaySurface& surface, const SurfelBatch& surfels, const Outputs& out) const;
};

}
