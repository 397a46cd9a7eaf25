/// A few exact rays a surfel, shared between neighbours by a local regression on what the field says there.
#pragma once

#include "alcove/field/any_field.h"
#include "alcove/occlusion/exact.h"

namespace alcove {

/// Every surfel shoots `rays` rays at the mesh, as Exact does, and takes part in the answers of its neighbours
/// along a Morton curve. In three steps:
///
///  1. The Morton rank shifts the lattice of directions by an additive recurrence, so that the rays of
///     neighbours together are low-discrepancy too: v_i. M. Roberts, "The Unreasonable Effectiveness of
///     Quasirandom Sequences" (2018).
///  2. Probes along the normal, d(p + h n)/h at h = R·2^(−0.75 k), k = 0..7, tell what surroundings a surfel
///     has: with g their mean, v ≈ a + b (g_i − g) is fitted by least squares, weighted by distance, by
///     normals (nothing beyond a right angle) and by the difference of the probes, so that neither the other
///     side of a sheet nor the other face of a crease has a say. A. Buades et al., "A review of image
///     denoising algorithms" (2005); local regression: W. S. Cleveland (1979).
///  3. ao = a + max(0, 1 − σ²/s²) (v − a), with s² the weighted mean of the squared residuals and σ² what the
///     noise of the rays explains of it: what the fit cannot tell, the surfel's own rays do. W. James, C. Stein
///     (1961). As rays grow, σ goes to 0 and the weights reach less far: it tends to Exact.
///
/// Bent normals likewise, by their deviation from the normal.
///
/// Surfels alike in position and normal have the same values. Cost: 8 map() calls and `rays` rays a surfel,
/// and 0.2 µs to share them.
struct Guided {
    float radius = 0.1f; ///< > 0; probes go to min(radius, 1), rays may be infinite
    int rays = 3;        ///< a surfel, >= 1
    std::uint32_t seed = 0;

    static constexpr std::string_view name = "guided";
    static constexpr std::string_view summary =
        "few rays on the mesh, shared between neighbours by a regression on the field's probes";
    static constexpr std::string_view formula = "a + max(0, 1 - sigma^2/s^2) (1/N sum V(w_i) - a), a fitted";
    static constexpr std::string_view source = "after Buades et al. (2005), Cleveland (1979)";
    static constexpr std::string_view cost = "8, and rays (3) on the mesh";
    static constexpr std::string_view good = "the error of ten times as many rays on dense meshes";
    static constexpr std::string_view bad = "smooths on coarse ones; needs the mesh and a grid";
    static constexpr bool traces_rays = true; ///< the radius may be infinite
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
ChannelValues bake_channels(std::span<const Surfel> surfels, const AnyField& field, const RaySurface& surface,
                            const Guided& guided, ChannelSet wanted, const Progress& progress = {});

}
