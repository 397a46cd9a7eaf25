/// A few probes along and around the normal, combined by a small network fitted to exact rays.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/methods/calibrated_table.h"
#include "alcove/occlusion/methods/traced.h"

namespace alcove {

/// Every probe at distance h, tilted by θ from the normal, gives an input x = cos θ − d/h; then
///
///     ao = clamp(1 + N(x) − N(0)),   N a network of two hidden layers, 16 and 8 units max(0, w·x + b)
///
/// with coefficients fitted once to the reference AO of many meshes, at radii from 2 to 50 % of D. The meshes, and
/// the error on meshes it was not fitted to, are in docs/calibrated.md. All x are 0 over a plane, where ao is 1 by
/// construction, and independent of scale. The rings of tilted probes are in the surfel's own frame. The network was
/// not fitted to surfels that touch other faces: these get 32 rays, as in Traced. Source: probes
/// along the normal (Evans 2006); fitted by fit/fit_calibrated.cpp. Cost: 10 or 24 map() calls per surfel.
struct Calibrated {
    float radius = 0.1f; ///< > 0
    int samples = 24;    ///< maximum number of probes, >= 10: there are networks for 10 and 24

    static constexpr std::string_view name = "calibrated";
    static constexpr std::string_view summary =
        "probes along and around the normal, combined by a small network fitted to exact rays";
    static constexpr std::string_view formula =
        "clamp(1 + N(x) - N(0)), x = cos t - d(p + h w_t)/h for each probe, N a fitted 16-8-1 network";
    static constexpr std::string_view source = "fitted to exact rays: see docs/calibrated.md";
    static constexpr std::string_view cost = "24 map() calls per point, or 10 if samples is below 24";
    static constexpr std::string_view good = "closest to exact rays for so few probes; no noise; exact on planes";
    static constexpr std::string_view bad =
        "no bound on its error: reliable only on shapes like those it was fitted to; weak in wide cavities";

    static constexpr auto parameters() {
        return std::array{parameter<&Calibrated::samples>("samples", 10, 24, "probes",
                                                          "maximum number of probes; 10 or 24 are used")};
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        if (samples < 24)
            estimate<TenProbes>(field, surfels, calibrated_table::ten_probes, out[Channel::ao]);
        else
            estimate<TwentyFourProbes>(field, surfels, calibrated_table::twenty_four_probes, out[Channel::ao]);
        trace_contacts(field, surfels, out[Channel::ao]);
    }

  private:
    template <Field F>
    void trace_contacts(const F& field, const SurfelBatch& surfels, float* ao) const {
        SurfelBatch touching;
        std::array<std::uint8_t, SurfelBatch::capacity> owner;
        for (std::size_t i = 0; i < surfels.count; ++i)
            if (surfels.touches(i)) {
                owner[touching.count] = static_cast<std::uint8_t>(i);
                touching.push_back({surfels.position(i), surfels.normal(i), surfels.away(i)});
            }
        if (touching.count == 0)
            return;
        SurfelBatch::Values values;
        Outputs out;
        out[Channel::ao] = values.data();
        Traced{.radius = radius, .rays = 32}(field, touching, out);
        for (std::size_t k = 0; k < touching.count; ++k)
            ao[owner[k]] = values[k];
    }

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
