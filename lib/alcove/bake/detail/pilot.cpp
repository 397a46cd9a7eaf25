#include "alcove/bake/detail/pilot.h"

#include "alcove/bake/error_figures.h"
#include "alcove/occlusion/detail/subset.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr std::uint32_t first_seed = 0x9d1f, second_seed = 0x51ab;
constexpr int most_rays = 1 << 20;
/// Of the error of shifted lattices, in their rays.
constexpr double exponent = 0.72;
constexpr std::size_t neighbours = 1024; // along the curve

/// Of that many rays, as far as surfels enough are left.
PilotOptions pilot_of(double rays) {
    constexpr int most_shares = 4;
    constexpr PilotOptions most_surfels{};
    int share = 1;
    while (share < most_shares && share * most_surfels.rays < rays)
        share *= 2;
    return {most_surfels.surfels / static_cast<std::size_t>(share), share * most_surfels.rays};
}

double without(double square, double noise2) {
    return std::sqrt(std::max(square - noise2, 0.0));
}

}

PilotOptions pilot_for(double error) {
    constexpr double rays_at_one = 5.0; // their noise is a quarter of the error or less
    return pilot_of(rays_at_one / error);
}

PilotOptions pilot_beside(int rays) {
    return pilot_of(0.5 * rays); // as noisy as that: the difference of both is still told
}

Pilot::Pilot(std::span<const Surfel> surfels, const RaySurface& surface, float radius,
             const PilotOptions& options)
    : surface_(surface), radius_(radius), indices_(evenly(spatial_order(surfels), options.surfels)),
      surfels_(pick(surfels, indices_)) {
    Exact half{.radius = radius, .rays = options.rays / 2, .seed = first_seed};
    reference_ = bake(surfels_, surface_, half);
    half.seed = second_seed;
    const std::vector<float> other = bake(surfels_, surface_, half);
    const ErrorFigures difference = compare(reference_, other);
    noise2_ = difference.rmse * difference.rmse / 4.0;
    for (std::size_t i = 0; i < reference_.size(); ++i)
        reference_[i] = 0.5f * (reference_[i] + other[i]);
    // Surfels were taken along the curve.
    const std::size_t apart = std::max<std::size_t>(reference_.size() / neighbours, 1);
    double steps2 = 0.0;
    for (std::size_t i = apart; i < reference_.size(); ++i)
        steps2 += 0.5 * std::pow(double{reference_[i]} - double{reference_[i - apart]}, 2);
    const auto steps = static_cast<double>(std::max<std::size_t>(reference_.size(), apart + 1) - apart);
    const double of_few_rays = std::sqrt(2.0 * noise2_) * std::pow(half.rays / 16.0, exponent);
    difficulty_ = std::sqrt(of_few_rays * without(steps2 / steps, noise2_));
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

double Pilot::rmse_of_exact(int rays, std::uint32_t seed) const {
    return rmse_of_own(bake(surfels_, surface_, Exact{.radius = radius_, .rays = rays, .seed = seed}));
}

int Pilot::rays_for(double error, std::uint32_t seed) const {
    // The error falls with rays, but not at each of them: what is returned was tried.
    constexpr int most_attempts = 16;
    int rays = 16, enough = most_rays;
    for (int attempt = 0; attempt < most_attempts && rays < enough; ++attempt) {
        const double rmse = rmse_of_exact(rays, seed);
        if (rmse <= error)
            enough = rays;
        if (rmse <= error && rmse > 0.85 * error)
            break;
        const double factor = std::pow(std::max(rmse, 0.1 * error) / (0.96 * error), 1.0 / exponent);
        rays = static_cast<int>(std::clamp(std::ceil(rays * factor), 1.0, double(most_rays)));
    }
    return enough < most_rays ? enough : rays;
}

}
