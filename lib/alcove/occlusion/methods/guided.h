/// A few exact rays per surfel, denoised by regression on probes of the field and joint bilateral filtering.
#pragma once

#include "alcove/field/field.h"
#include "alcove/occlusion/methods/exact.h"

namespace alcove {

/// `rays` rays per surfel are traced against the mesh, as in Exact. The noisy results v are then filtered:
///
///  1. Trace. An additive recurrence, indexed by the Morton rank, shifts the lattice of directions of each surfel, so
///     that the combined rays of neighbouring surfels are low-discrepancy too (Roberts 2018).
///  2. Predict. A ridge regression m predicts v from the probes of Calibrated along the normal, the mean of each of its
///     rings, and the hidden layer of its network (38 probes). It is fitted to the rays of up to 16,384 surfels (Hoerl
///     and Kennard 1970).
///  3. Filter. The residuals r = v − m are averaged over neighbours, weighted by distance, by the angle between normals
///     (0 beyond a right angle) and by the difference between their probes. These weights exclude the other side of a
///     sheet and the other face of a crease (Buades et al. 2005). With weights w, variance σ² of the mean of one
///     surfel's rays and variance τ² of the model, r̄ = Σ w r / (Σ w + σ²/τ²) (Matheron 1963).
///  4. Correct. ao = a + max(0, 1 − 2σ²/s²) (v − a), with a = m + r̄ and s² the weighted mean of (r_i − r̄)²: the
///     surfel's own rays take over where its neighbours disagree (James and Stein 1961).
///
/// With more rays, σ goes to 0 and the filter radius shrinks, so the result converges to Exact. Bent normals are
/// filtered by their deviation from the normal, with a local regression on m (Cleveland 1979).
///
/// Surfels with the same position, normal and contacts get the same values. Cost: 38 map() calls and `rays` rays per
/// surfel, and 0.5 µs for the network and the filter.
struct Guided {
    float radius = 0.1f; ///< > 0, may be infinite; probes reach at most min(radius, 1)
    int rays = 3;        ///< per surfel, >= 1
    std::uint32_t seed = 0;

    static constexpr std::string_view name = "guided";
    static constexpr std::string_view summary =
        "a few rays on the mesh, denoised by regression on the field's probes and joint bilateral filtering";
    static constexpr std::string_view formula = "a + max(0, 1 - 2 sigma^2/s^2) (v - a), v = 1/N sum V(w_i), "
                                                "a = m + mean of neighbouring v - m, m fitted";
    static constexpr std::string_view source = "after Hoerl and Kennard (1970), Buades et al. (2005)";
    static constexpr std::string_view cost = "38 map() calls and 3 rays on the mesh per point";
    static constexpr std::string_view good = "as accurate as exact, with a tenth of the rays";
    static constexpr std::string_view bad =
        "smooths detail that neither probes nor neighbours show; needs both the mesh and a grid";
    static constexpr bool unbounded_radius = true; ///< the radius may be infinite
    static constexpr ChannelSet gives = Channel::ao | Channel::bent_normal;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Guided::rays>("rays", 1, 1 << 20, "rays", "number of rays in the hemisphere"),
            parameter<&Guided::seed>("seed", 0, 0xffffffffu, "", "random seed of the directions"),
        };
    }
};

/// Like the general evaluate(), computes every wanted channel that Guided gives. The values depend neither on the
/// number of threads nor on the order of the surfels. `field` and `surface` must describe the same mesh.
ChannelValues evaluate(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const AnyField& field,
                       const RaySurface& surface, const Guided& guided, ChannelSet wanted,
                       const Progress& progress = {});

inline ChannelValues evaluate(std::span<const Surfel> surfels, const AnyField& field, const RaySurface& surface,
                              const Guided& guided, ChannelSet wanted, const Progress& progress = {}) {
    return evaluate(surfels, spatial_order(surfels), field, surface, guided, wanted, progress);
}

}
