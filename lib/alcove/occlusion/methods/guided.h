/// A few exact rays a surfel, shared between neighbours by a local regression on what the field says there.
#pragma once

#include "alcove/field/field.h"
#include "alcove/occlusion/methods/exact.h"

namespace alcove {

/// Every surfel shoots `rays` rays at the mesh, as Exact does, and takes part in the answers of the others. In
/// four steps:
///
///  1. The Morton rank shifts the lattice of directions by an additive recurrence, so that the rays of
///     neighbours together are low-discrepancy too: v_i. M. Roberts, "The Unreasonable Effectiveness of
///     Quasirandom Sequences" (2018).
///  2. The ten probes of Calibrated, what it makes of them, c, their squares and the products of c with the
///     probes predict v by a model m, fitted to the rays of all surfels: A. Hoerl, R. Kennard, "Ridge
///     regression" (1970).
///  3. What the model leaves, r = v − m, is shared between neighbours, weighted by distance, by normals (nothing
///     beyond a right angle) and by the difference of their probes, so that neither the other side of a sheet
///     nor the other face of a crease has a say: A. Buades et al., "A review of image denoising algorithms"
///     (2005). With w the weights, σ² the variance of one surfel's rays and τ² that of the model,
///     r̄ = Σ w r / (Σ w + σ²/τ²): G. Matheron, "Principles of geostatistics" (1963).
///  4. ao = a + max(0, 1 − 2σ²/s²) (v − a), with a = m + r̄ and s² the weighted mean of (r_i − r̄)²: what the
///     neighbours cannot tell, the surfel's own rays do. W. James, C. Stein, "Estimation with quadratic loss"
///     (1961). As rays grow, σ goes to 0 and the weights reach less far: it tends to Exact.
///
/// Bent normals by their deviation from the normal, regressed on m in the neighbourhood: W. S. Cleveland (1979).
///
/// Surfels alike in position and normal have the same values. Cost: 10 map() calls and `rays` rays a surfel,
/// and 0.2 µs to share them.
struct Guided {
    float radius = 0.1f; ///< > 0; probes go to min(radius, 1), rays may be infinite
    int rays = 3;        ///< a surfel, >= 1
    std::uint32_t seed = 0;

    static constexpr std::string_view name = "guided";
    static constexpr std::string_view summary =
        "few rays on the mesh, shared by a regression on the field's probes and between neighbours";
    static constexpr std::string_view formula =
        "a + max(0, 1 - 2 sigma^2/s^2) (v - a), v = 1/N sum V(w_i), a = m + mean of v - m nearby, m fitted";
    static constexpr std::string_view source = "after Hoerl and Kennard (1970), Buades et al. (2005)";
    static constexpr std::string_view cost = "10, and rays (3) on the mesh";
    static constexpr std::string_view good = "the error of ten times as many rays";
    static constexpr std::string_view bad =
        "smooths what neither probes nor neighbours tell; needs the mesh and a grid";
    static constexpr bool unbounded_radius = true; ///< the radius may be infinite
    static constexpr ChannelSet gives = Channel::ao | Channel::bent_normal;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Guided::rays>("rays", 1, 1 << 20, "rays", "in the hemisphere"),
            parameter<&Guided::seed>("seed", 0, 0xffffffffu, "", "of the directions"),
        };
    }
};

/// As the other bakes: every wanted channel that Guided gives, whatever the number of threads and the order of
/// the surfels. `field` and `surface` are of the same mesh.
ChannelValues bake_channels(std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                            const AnyField& field, const RaySurface& surface, const Guided& guided,
                            ChannelSet wanted, const Progress& progress = {});

inline ChannelValues bake_channels(std::span<const Surfel> surfels, const AnyField& field,
                                   const RaySurface& surface, const Guided& guided, ChannelSet wanted,
                                   const Progress& progress = {}) {
    return bake_channels(surfels, spatial_order(surfels), field, surface, guided, wanted, progress);
}

}
