/// Evaluates a method at some of many densely spaced surfels, and interpolates its values at the rest.
#pragma once

#include "alcove/occlusion/catalog.h"

#include <functional>
#include <optional>
#include <span>

namespace alcove {

/// Where to evaluate a method, and where to interpolate. The method is evaluated at one of every `stride` surfels along
/// the Morton curve, chosen at random. Where its ao deviates by more than `tolerance` from a local linear fit, or where
/// too few evaluated surfels are near, the method is also evaluated at one of every stride / 4 surfels, then stride /
/// 16, and finally at all of them. The other surfels get the values of the fit (see local_fit()).
struct Interpolation {
    std::size_t stride = 16; ///< a power of 4, > 1
    float tolerance = 0.02f; ///< > 0
    double max_share = 1.0;  ///< largest share of surfels to evaluate; with more, interpolation saves no time
};

struct InterpolatedValues {
    ChannelValues values;
    double share = 1.0; ///< share of the surfels with a normal for which the method was evaluated
};

/// Adds what surfels need before the method is evaluated at them, for example their contacts. `indices` are the indices
/// of `surfels` among all surfels.
using PrepareSurfels = std::function<void(std::span<const std::uint32_t> indices, std::span<Surfel> surfels)>;

/// Evaluates the channels of a run: ao, or ao and the bent normal. `order` is the spatial_order() of the surfels.
/// Surfels whose `covered` is already set are always evaluated. Surfels with the same position and normal get the same
/// values. The values depend neither on the number of threads nor on the order of the surfels. \return std::nullopt if
/// more than `max_share` of the surfels would have to be evaluated. Cost: the method at the evaluated surfels, and
/// about 0.1 µs per surfel.
std::optional<InterpolatedValues>
evaluate_interpolated(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const Occluders& occluders,
                      const MethodRun& run, const Interpolation& interpolation, const PrepareSurfels& prepare = {},
                      const Progress& progress = {});

}
