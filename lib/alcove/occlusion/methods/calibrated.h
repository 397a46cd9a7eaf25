/// Probes along and around the normal, combined by a small network trained on exact rays.
#pragma once

#include "alcove/occlusion/detail/last_layer_fit.h"
#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/methods/calibrated_networks.h"
#include "alcove/occlusion/methods/exact.h"
#include "alcove/occlusion/methods/traced.h"

namespace alcove {

/// Every probe at distance h from the surfel, tilted by θ from the normal, gives an input x = cos θ − d/h; then
///
///     ao = clamp(1 + N(x, c) − N(0, c)),   N a RingNetwork, c the radius in voxels and whether the field is two-sided
///
/// with coefficients trained on the reference AO of many meshes and scenes, at radii from 1 % of D to infinity. See
/// docs/calibrated.md for these meshes, and for the error on meshes outside the training set. All x are independent of
/// scale. Over a plane, as far as the bands of the field reach, all x are 0, so ao is 1. Probes do not resolve
/// contacts, so surfels that touch other faces trace rays instead: against the mesh, as in Exact, if there is one,
/// otherwise through the field, as in Traced. Source: probes along the normal (Evans 2006); trained by
/// fit/train_networks.py. Cost: 13, 38 or 63 map() calls per surfel, and 0.05, 0.1 or 0.2 µs.
struct Calibrated {
    float radius = 0.1f; ///< > 0
    int samples = 38;    ///< maximum number of probes, >= 13: there are networks for 13, 38 and 63
    std::optional<RingNetwork::LastLayer> last{}; ///< last layer of the network, see fit(); if empty, as trained
    std::optional<RaySurface> mesh{};             ///< target of the rays of surfels in contact; if empty, the field

    static constexpr int rays_at_contacts = 64;
    static constexpr std::string_view name = "calibrated";
    static constexpr std::string_view summary =
        "probes along and around the normal, combined by a small network trained on exact rays";
    static constexpr std::string_view formula =
        "clamp(1 + N(x, c) - N(0, c)), x = cos t - d(p + h w_t)/h for each probe, N a trained network";
    static constexpr std::string_view source = "trained on exact rays: see docs/calibrated.md";
    static constexpr std::string_view cost = "38 map() calls per point; 13 if samples is below 38, 63 if it is 63";
    static constexpr std::string_view good =
        "closest to exact rays for so few probes; no noise except at contacts; almost exact on planes";
    static constexpr std::string_view bad =
        "no bound on its error: reliable only on shapes like those it was trained on; weak in wide cavities";

    static constexpr auto parameters() {
        return std::array{parameter<&Calibrated::samples>("samples", 13, 63, "probes",
                                                          "maximum number of probes; 13, 38 or 63 are used")};
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        with_probes([&]<class Probes>(Probes) { estimate<Probes>(field, surfels, out[Channel::ao]); });
        trace_contacts(field, surfels, out[Channel::ao]);
    }

    /// Fits the last layer of the network to `labels`, reference ao at surfels of the mesh that `field` describes.
    /// Cost: that of evaluating the estimator at these surfels.
    template <Field F>
    void fit(const F& field, const Labels& labels) {
        with_probes([&]<class Probes>(Probes) { last = fitted_layer<Probes>(field, labels); });
    }

  private:
    template <Field F>
    void trace_contacts(const F& field, const SurfelBatch& surfels, float* ao) const {
        const float lift = mesh ? start_height(field, radius) : 0.0f; // of the batch; removed for rays on the mesh
        SurfelBatch touching;
        std::array<std::uint8_t, SurfelBatch::capacity> owner;
        for (std::size_t i = 0; i < surfels.count; ++i)
            if (surfels.touches(i)) {
                owner[touching.count] = static_cast<std::uint8_t>(i);
                touching.push_back({surfels.position(i), surfels.normal(i), surfels.away(i)}, -lift);
            }
        if (touching.count == 0)
            return;
        SurfelBatch::Values values;
        Outputs out;
        out[Channel::ao] = values.data();
        if (mesh)
            Exact{.radius = radius, .rays = rays_at_contacts}(*mesh, touching, out);
        else
            Traced{.radius = radius, .rays = rays_at_contacts}(field, touching, out);
        for (std::size_t k = 0; k < touching.count; ++k)
            ao[owner[k]] = values[k];
    }

    template <class Use>
    void with_probes(Use use) const {
        if (samples < 38)
            use(ThirteenProbes());
        else if (samples < 63)
            use(ThirtyEightProbes());
        else
            use(SixtyThreeProbes());
    }

    template <class Probes, Field F>
    void hidden_layer(const F& field, const SurfelBatch& surfels, RingNetwork::Hidden& h) const {
        CalibratedInputs<Probes> inputs{};
        calibrated_inputs<Probes>(field, surfels, radius, inputs);
        calibrated_network<Probes>().hidden_layer(inputs, calibrated_condition(field, radius), h);
    }

    template <class Probes, Field F>
    void estimate(const F& field, const SurfelBatch& surfels, float* ao) const {
        RingNetwork::Hidden h;
        hidden_layer<Probes>(field, surfels, h);
        SurfelBatch::Values value;
        RingNetwork::value(h, last ? *last : calibrated_network<Probes>().last_layer(), value);
        for (std::size_t k = 0; k < surfels.count; ++k)
            ao[k] = std::clamp(1.0f + value[k], 0.0f, 1.0f);
    }

    template <class Probes, Field F>
    RingNetwork::LastLayer fitted_layer(const F& field, const Labels& labels) const {
        LastLayerFit fit(calibrated_network<Probes>().last_layer());
        for (std::size_t at = 0; at < labels.surfels.size();) {
            SurfelBatch batch;
            std::vector<float> ao;
            for (; at < labels.surfels.size() && batch.count < SurfelBatch::capacity; ++at)
                if (const Surfel& surfel = labels.surfels[at]; surfel.away == Vec3(0.0f) && !surfel.covered) {
                    batch.push_back(surfel);
                    ao.push_back(labels.ao[at]);
                }
            RingNetwork::Hidden h;
            hidden_layer<Probes>(field, batch, h);
            fit.add(h, ao);
        }
        return fit.layer();
    }
};

}
