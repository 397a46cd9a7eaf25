#include "alcove/bake/detail/pilot.h"

#include "alcove/bake/detail/error_figures.h"
#include "alcove/occlusion/detail/subset.h"
#include "alcove/occlusion/methods/exact.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace alcove {
namespace {

constexpr std::uint32_t first_seed = 0x9d1f, second_seed = 0x51ab;
constexpr std::size_t neighbours = 1024; // difficulty() compares neighbours among this many surfels on the Morton curve

/// Options with about `rays` rays per surfel. Takes up to four times the default number of rays per surfel, at fewer
/// surfels, so that the total number of rays stays constant. If `rays` is larger than that, doubles the rays per surfel
/// until they reach half of `rays`, because noise would hide the error; the total then grows.
PilotOptions pilot_of(double rays) {
    constexpr int max_share = 4, max_rays = 4096;
    constexpr PilotOptions standard{};
    int share = 1;
    while (share < max_share && share * standard.rays < rays)
        share *= 2;
    PilotOptions options{standard.surfels / static_cast<std::size_t>(share), share * standard.rays};
    while (options.rays < max_rays && 2 * options.rays < rays)
        options.rays *= 2;
    return options;
}

/// The RMSE without the noise of the reference: `square` is the mean squared error, `noise2` the variance of the noise.
double without(double square, double noise2) {
    return std::sqrt(std::max(square - noise2, 0.0));
}

}

PilotOptions pilot_for(double error) {
    constexpr double rays_at_one = 5.0; // so that the noise is at most a quarter of the error
    constexpr double loose = 0.04;      // from this error on, noise of a third of it is enough: little is subtracted
    constexpr PilotOptions standard{};
    return error >= loose ? PilotOptions{standard.surfels, standard.rays / 2} : pilot_of(rays_at_one / error);
}

PilotOptions pilot_beside(int rays) {
    return pilot_of(0.5 * rays); // as noisy as the bake, but still accurate enough to measure how far the two differ
}

Pilot::Pilot(std::span<const Surfel> surfels, const RaySurface& surface, float radius, const PilotOptions& options)
    : Pilot(surfels, spatial_order(surfels), surface, radius, options) {}

Pilot::Pilot(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const RaySurface& surface,
             float radius, const PilotOptions& options)
    : surface_(surface), radius_(radius), indices_(evenly(order, options.surfels)), surfels_(pick(surfels, indices_)) {
    Exact half{.radius = radius, .rays = options.rays / 2, .seed = first_seed};
    reference_ = evaluate_ao(surfels_, surface_, half);
    half.seed = second_seed;
    const std::vector<float> other = evaluate_ao(surfels_, surface_, half);
    const ErrorFigures difference = compare(reference_, other);
    noise2_ = difference.rmse * difference.rmse / 4.0;
    for (std::size_t i = 0; i < reference_.size(); ++i)
        reference_[i] = 0.5f * (reference_[i] + other[i]);
    take_labels();
    // The surfels are in Morton order.
    const std::size_t apart = std::max<std::size_t>(reference_.size() / neighbours, 1);
    double steps2 = 0.0;
    for (std::size_t i = apart; i < reference_.size(); ++i)
        steps2 += 0.5 * std::pow(double{reference_[i]} - double{reference_[i - apart]}, 2);
    const auto steps = static_cast<double>(std::max<std::size_t>(reference_.size(), apart + 1) - apart);
    const double of_few_rays = std::sqrt(2.0 * noise2_) * std::pow(half.rays / 16.0, ray_exponent);
    difficulty_ = std::sqrt(of_few_rays * without(steps2 / steps, noise2_));
}

void Pilot::take_labels() {
    constexpr std::size_t share = 4;
    if (surfels_.size() < fewest_to_fit)
        return;
    auto labels = std::make_shared<Labels>();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < surfels_.size(); ++i)
        if (i % share == 1) {
            labels->surfels.push_back(surfels_[i]);
            labels->ao.push_back(reference_[i]);
        } else {
            indices_[kept] = indices_[i];
            surfels_[kept] = surfels_[i];
            reference_[kept++] = reference_[i];
        }
    indices_.resize(kept);
    surfels_.resize(kept);
    reference_.resize(kept);
    labels_ = std::move(labels);
}

double Pilot::rmse_of_own(std::span<const float> ao) const {
    const double rmse = compare(ao, reference_).rmse;
    return without(rmse * rmse, noise2_);
}

double Pilot::rmse(std::span<const float> ao) const {
    std::vector<float> own;
    own.reserve(indices_.size());
    for (const std::uint32_t i : indices_)
        own.push_back(ao[i]);
    return rmse_of_own(own);
}

std::optional<double> Pilot::rmse(std::span<const float> ao, std::span<const std::uint32_t> of) const {
    std::unordered_map<std::uint32_t, std::size_t> place;
    for (std::size_t i = 0; i < of.size(); ++i)
        place.emplace(of[i], i);
    std::vector<float> own, reference;
    for (std::size_t i = 0; i < indices_.size(); ++i)
        if (const auto found = place.find(indices_[i]); found != place.end()) {
            own.push_back(ao[found->second]);
            reference.push_back(reference_[i]);
        }
    if (own.empty())
        return {};
    const double rmse = compare(own, reference).rmse;
    return without(rmse * rmse, noise2_);
}

double Pilot::rmse_of(const Method& method, const Occluders& occluders, const Settings& settings) const {
    return rmse_of_own(evaluate(surfels_, occluders, method, settings, Channel::ao)[Channel::ao]);
}

double Pilot::rmse_of_exact(int rays, std::uint32_t seed) const {
    return rmse_of_own(evaluate_ao(surfels_, surface_, Exact{.radius = radius_, .rays = rays, .seed = seed}));
}

int Pilot::rays_for(double error, std::uint32_t seed) const {
    // The error does not fall monotonically with the number of rays, so the result is the smallest number that was
    // tried and met the error, if there is one.
    constexpr int max_attempts = 16;
    // Rare rays that differ between runs leave an error that remains however many rays there are.
    constexpr double clearly_more = 1.5, hardly_less = 0.93;
    constexpr int many_rays = 2048; // from this number on, small steps would hide such an error
    int rays = 16, enough = most_rays, last_rays = most_rays;
    double last_rmse = 0.0;
    for (int attempt = 0; attempt < max_attempts && rays < enough; ++attempt) {
        const double rmse = rmse_of_exact(rays, seed);
        if (rmse <= error)
            enough = rays;
        const bool is_close = rmse <= error && rmse > 0.85 * error;
        const bool is_futile = rmse > error && rays >= clearly_more * last_rays && rmse > hardly_less * last_rmse;
        if (is_close || is_futile)
            break;
        last_rays = rays;
        last_rmse = rmse;
        double factor = std::pow(std::max(rmse, 0.1 * error) / (0.96 * error), 1.0 / ray_exponent);
        if (rmse > error && rays >= many_rays)
            factor = std::max(factor, clearly_more);
        rays = static_cast<int>(std::clamp(std::ceil(rays * factor), 1.0, double(most_rays)));
    }
    return enough < most_rays ? enough : rays;
}

}
