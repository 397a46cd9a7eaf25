/// Estimates the error of a bake from a sample of its surfels.
#pragma once

#include "alcove/occlusion/catalog.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alcove {

struct PilotOptions {
    std::size_t surfels = 4096; ///< maximum number, ≥ 1; they are spaced evenly along the Morton curve
    int rays = 128;             ///< per surfel, an even number ≥ 2
};

/// Choose the size of a pilot. Large errors vary most between surfels, so measuring them takes many surfels. Small
/// errors are below the noise of few rays, so measuring them takes many rays per surfel.
PilotOptions pilot_for(double error); ///< to measure errors of about `error`, > 0
PilotOptions pilot_beside(int rays);  ///< to measure a bake with `rays` rays per surfel; 0 if it traces none

/// A sample of surfels with their reference ao, from exact rays whose seeds differ from those of a bake. The difference
/// between two halves of the rays gives the noise of the reference, which is subtracted from all errors. An RMSE at
/// 4,096 surfels is accurate to about 3 % if the error is the same everywhere, and to 10 % if the whole error is at one
/// surfel in a hundred. Const members are thread-safe.
class Pilot {
  public:
    static constexpr int most_rays = 1 << 20;
    static constexpr std::size_t fewest_to_fit = 200; ///< sampled surfels needed for labels()
    /// The error of exact is proportional to rays^-ray_exponent.
    static constexpr double ray_exponent = 0.72;

    /// `surface` has the occluders of the surfels. The radius, in the unit of the surfels, may be infinite. Cost:
    /// `rays` rays per sampled surfel, about 50 ms.
    Pilot(std::span<const Surfel> surfels, const RaySurface& surface, float radius, const PilotOptions& options = {});
    /// The same for callers that already have the spatial_order() of the surfels, as `order`.
    Pilot(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const RaySurface& surface,
          float radius, const PilotOptions& options);

    bool empty() const { return indices_.empty(); } ///< true if no surfel has a normal
    /// A number to which the errors of guided and calibrated are roughly proportional: the geometric mean of the error
    /// of 16 exact rays, and of the RMS difference of ao between neighbours divided by √2. Neighbours are consecutive
    /// surfels among about a thousand on the Morton curve.
    double difficulty() const { return difficulty_; }
    /// The RMSE of a bake of all surfels that were passed to the constructor. `ao` has one value per surfel, in their
    /// order.
    double rmse(std::span<const float> ao) const;
    /// The RMSE of a bake of some of these surfels. `of` has the index of the surfel of each value. std::nullopt if the
    /// pilot sampled none of these surfels.
    std::optional<double> rmse(std::span<const float> ao, std::span<const std::uint32_t> of) const;
    /// The RMSE of a method that evaluates each surfel independently; `settings` include the radius. Cost: the method
    /// at the sampled surfels.
    double rmse_of(const Method& method, const Occluders& occluders, const Settings& settings) const;
    /// The RMSE of exact rays at the radius of the pilot. Cost: `rays` rays per sampled surfel.
    double rmse_of_exact(int rays, std::uint32_t seed) const;
    /// A quarter of the sampled surfels with their reference, for methods that are fitted to the mesh. Errors are
    /// measured at the other three quarters. Null if there are too few surfels.
    const std::shared_ptr<const Labels>& labels() const { return labels_; }
    /// The number of exact rays per surfel that is needed to meet `error` (> 0) at the sampled surfels; at most
    /// `most_rays`. Cost: up to 16 calls of rmse_of_exact().
    int rays_for(double error, std::uint32_t seed) const;

  private:
    void take_labels();
    double rmse_of_own(std::span<const float> ao) const;

    RaySurface surface_;
    float radius_;
    std::vector<std::uint32_t> indices_;
    std::vector<Surfel> surfels_;
    std::vector<float> reference_;
    std::shared_ptr<const Labels> labels_;
    double noise2_ = 0.0; ///< variance of the noise of the reference
    double difficulty_ = 0.0;
};

}
