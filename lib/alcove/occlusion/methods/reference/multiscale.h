/// Probes along the normal at doubling heights, with separate values for short and long range.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"

namespace alcove {

///     short = Π_{j ≤ 3} clamp(d(p + h_j n)/h_j),   long = short · Π_{j ≥ 4} clamp(d(p + h_j n)/h_j)
///     ao = max(floor, long^power),   h_j = radius · 2^(j − 6), j = 0..6,   floor = 0.035, power = 0.3
///
/// Gives short and long as separate channels. The reference radius is 6.4. Exact (1) on planes and convex shapes.
/// Source: sdfao2026. Cost: 7 map() calls per surfel.
struct Multiscale {
    float radius = 0.1f;  ///< maximum probe distance, > 0
    float power = 0.3f;   ///< >= 0; below 1 brightens
    float floor = 0.035f; ///< lowest ao, in [0, 1]

    static constexpr std::string_view name = "multiscale";
    static constexpr std::string_view summary =
        "probes along the normal at doubling heights; short and long range as separate channels";
    static constexpr std::string_view formula =
        "max(0.035, (prod clamp(d(p + h_j n)/h_j))^0.3), h_j = 0.1 2^j, j = 0..6; short: j <= 3";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026)";
    static constexpr std::string_view cost = "7 map() calls per point";
    static constexpr std::string_view good =
        "fine detail and large shapes in one pass; exact on planes and convex shapes";
    static constexpr std::string_view bad = "stylised rather than accurate: darkens early, and its radius means little";
    static constexpr ChannelSet gives = Channel::ao | Channel::ao_short | Channel::ao_long;
    static constexpr float reference_radius = 6.4f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Multiscale::power>("power", 0, 10, "", "exponent of the product: below 1 brightens"),
            parameter<&Multiscale::floor>("floor", 0, 1, "", "lowest ao"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        constexpr int shorts = 4, heights = 7;
        SurfelBatch::Values product, distances;
        product.fill(1.0f);
        for (int j = 0; j < heights; ++j) {
            const float height = std::ldexp(radius, j - (heights - 1));
            probe_along_normal(field, surfels, height, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                product[k] *= std::clamp(distances[k] / height, 0.0f, 1.0f);
            if (j == shorts - 1 && out[Channel::ao_short])
                std::copy_n(product.begin(), surfels.count, out[Channel::ao_short]);
        }
        if (out[Channel::ao_long])
            std::copy_n(product.begin(), surfels.count, out[Channel::ao_long]);
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::max(floor, std::pow(product[k], power));
    }
};

}
