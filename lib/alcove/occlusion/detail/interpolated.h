/// Evaluates a method at some of many densely spaced surfels, and interpolates the others.
#pragma once

#include "alcove/occlusion/catalog.h"

#include <functional>
#include <optional>
#include <span>

namespace alcove {

/// Where to evaluate a method, and where to interpolate. The method is evaluated at every `stride`-th surfel along the
/// Morton curve. Where its ao deviates by more than `tolerance` from a local linear fit, it is also evaluated at every
/// (stride / 4)-th surfel, and so on, finally at all of them. The other surfels get the values of the fit (see
/// local_fit()).
struct Interpolation {
    std::size_t stride = 16; ///< a power of 4, > 1
    float tolerance = 0.02f; ///< > 0
    double max_share = 1.0;  ///< largest share of the surfels to evaluate: above it, interpolation does not pay
};

struct InterpolatedValues {
    ChannelValues values;
    double share = 1.0; ///< share of the surfels with a normal for which the method was evaluated
};

/// Completes surfels before they are evaluated, for example with their contacts. `indices` are their indices among all
/// surfels.
using PrepareSurfels = std::function<void(std::span<const std::uint32_t> indices, std::span<Surfel> surfels)>;

/// Evaluates the channels of a run: ao, the bent normal, or both. `order` is the spatial_order() of the surfels.
/// Surfels that are known to be covered are not interpolated. Surfels with the same position and normal get the same
/// values. The values depend neither on the number of threads nor on the order of the surfels. \return std::nullopt if
/// more than `max_share` of the surfels would have to be evaluated. Cost: the method at a share of the surfels, and
/// about 0.1 µs per surfel.
std::optional<InterpolatedValues>
evaluate_interpolated(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const Occluders& occluders,
                      const MethodRun& run, const Interpolation& interpolation, const PrepareSurfels& prepare = {},
                      const Progress& progress = {});

}
