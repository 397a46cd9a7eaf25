/// The error of a bake, as a few of its own surfels tell it.
#pragma once

#include "alcove/occlusion/methods/exact.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

struct PilotOptions {
    std::size_t surfels = 4096; ///< at most, >= 1, evenly along the Morton curve
    int rays = 128;             ///< a surfel, even, >= 2
};

/// As many rays altogether, of more surfels or fewer: large errors differ most from surfel to surfel, small ones drown in the
/// noise of few rays.
PilotOptions pilot_for(double error); ///< for errors of that size, > 0
PilotOptions pilot_beside(int rays);  ///< for what is baked by so many rays a surfel, 0 where by none

/// Some surfels with their reference ao, by exact rays of other seeds than a bake's. Half of the rays beside the other half
/// tell the noise of the reference, which is taken off all errors. An RMSE of 4,096 surfels is right to about 3 % where errors
/// are alike everywhere, to 10 % where one surfel in a hundred has them all. `const` use is safe from any number of threads.
class Pilot {
  public:
    /// `surface` is what occludes the surfels; the radius may be infinite. Cost: `rays` rays for each of its
    /// surfels, 50 ms.
    Pilot(std::span<const Surfel> surfels, const RaySurface& surface, float radius,
          const PilotOptions& options = {});

    bool empty() const { return indices_.empty(); } ///< no surfel has a normal
    /// What errors of methods that share or predict go with: the geometric mean of the error of 16 exact rays and of the
    /// RMS difference between neighbours, among a thousand of the pilot's surfels, over √2.
    double difficulty() const { return difficulty_; }
    /// Of the ao of all surfels that the pilot was made of, in their order.
    double rmse(std::span<const float> ao) const;
    /// Of exact rays at the pilot's radius. Cost: as many rays for each of its surfels.
    double rmse_of_exact(int rays, std::uint32_t seed) const;
    /// How many exact rays a surfel hold that error at the pilot's surfels, > 0; 2^20 at most.
    int rays_for(double error, std::uint32_t seed) const;

  private:
    double rmse_of_own(std::span<const float> ao) const;

    RaySurface surface_;
    float radius_;
    std::vector<std::uint32_t> indices_;
    std::vector<Surfel> surfels_;
    std::vector<float> reference_;
    double noise2_ = 0.0; ///< of the reference
    double difficulty_ = 0.0;
};

}
