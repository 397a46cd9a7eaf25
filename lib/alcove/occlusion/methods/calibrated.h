/// A few probes along and around the normal, combined by a small network fitted to exact rays.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/methods/calibrated_table.h"

namespace alcove {

/// Every probe at distance h, tilted by θ from the normal, tells x = cos θ − d/h; then
///
///     ao = clamp(1 + N(x) − N(0)),   N a network of two hidden layers, 16 and 8 units max(0, w·x + b)
///
/// with coefficients fitted once to the reference AO of many meshes, at radii from 2 to 50 % of D; what they
/// were and how far it is from rays on meshes it never saw stands in docs/calibrated.md. All x are 0 over a
/// plane, where ao is 1 by construction, and free of scale. The rings of tilted probes stand in the surfel's
/// own frame. Source: fit/fit_calibrated.cpp; A. Evans, "Fast approximations for global illumination on dynamic
/// scenes" (2006) for the probes. Cost: 10 or 24 map() calls a surfel.
struct Calibrated {
    float radius = 0.1f; ///< > 0
    int samples = 24;    ///< probes at most, >= 10: there is a network for 10 and one for 24

    static constexpr std::string_view name = "calibrated";
    static constexpr std::string_view summary =
        "probes along and around the normal, combined by coefficients fitted to exact rays";
    static constexpr std::string_view formula =
        "clamp(1 + N(x) - N(0)), x = cos t - d(p + h w_t)/h for each probe, N a fitted 16-8-1 network";
    static constexpr std::string_view source = "fitted to exact rays: see docs/calibrated.md";
    static constexpr std::string_view cost = "24, or 10 for samples below 24";
    static constexpr std::string_view good =
        "the nearest to exact rays for so few probes; no noise; 1 on planes";
    static constexpr std::string_view bad =
        "no bound on its error: it knows shapes like those it was fitted to; weak in wide cavities";

    static constexpr auto parameters() {
        return std::array{
            parameter<&Calibrated::samples>("samples", 10, 24, "probes", "at most: 10, or all 24")};
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        if (samples < 24)
            estimate<TenProbes>(field, surfels, calibrated_table::ten_probes, out[Channel::ao]);
        else
            estimate<TwentyFourProbes>(field, surfels, calibrated_table::twenty_four_probes,
                                       out[Channel::ao]);
    }

  private:
    template <class Probes, Field F, class N>
    void estimate(const F& field, const SurfelBatch& surfels, const N& network, float* ao) const {
        CalibratedInputs<Probes> inputs{};
        calibrated_inputs<Probes>(field, surfels, radius, inputs);
        const SurfelBatch::Values value = network(inputs);
        for (std::size_t k = 0; k < surfels.count; ++k)
            ao[k] = std::clamp(value[k], 0.0f, 1.0f);
    }
};

}
