/// Joint bilateral filtering of ray results, the implementation of Guided.
#pragma once

#include "alcove/occlusion/detail/bilateral_sums.h"
#include "alcove/occlusion/detail/ring_network.h"
#include "alcove/occlusion/methods/guided.h"

#include <array>
#include <span>
#include <vector>

namespace alcove {

/// The results of probes and rays for surfels along the Morton curve; successive surfels for which is_same() holds are
/// merged. Call probe() and shoot() for all surfels, then fit_model() once, then filter(). All of these except
/// fit_model() may run concurrently for different surfels.
class JointBilateral {
  public:
    JointBilateral(const JointBilateral&) = delete;
    JointBilateral& operator=(const JointBilateral&) = delete;
    JointBilateral(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const Guided& guided,
                   bool with_bent);

    std::size_t size() const { return surfels_.size(); }
    /// The index, after merging, of the surfel at `rank` in `order`.
    std::size_t index_of(std::size_t rank) const { return index_[rank]; }

    void probe(const AnyField& field, std::size_t begin, std::size_t end);
    void shoot(const RaySurface& surface, std::size_t begin, std::size_t end);
    void fit_model();

    struct Filtered {
        float ao;
        Vec3 bent; ///< mean of open directions, not normalised; zero if not requested
    };
    Filtered filter(std::size_t i) const;

  private:
    enum Column : std::size_t {
        position,
        normal = 3,
        ao = 6,
        predicted, ///< ao predicted by the model
        residual,  ///< ao − predicted
        bent,      ///< mean of open directions minus ao times that of an unoccluded surfel; unused if not requested
        columns = bent + 3
    };
    /// The probes in Curve, and the hidden layer of Calibrated's network.
    static constexpr std::size_t features = Curve::probes + RingNetwork::hidden;

    Curve curve() const;
    float reach(std::size_t i) const;
    Vec3 filter_bent(std::size_t i, std::size_t first, const float* weights) const;

    const Guided guided_;
    const CosineLattice lattice_;
    const bool with_bent_;
    /// Filter radius, as a multiple of the median spacing along the curve: smaller for more rays. Tuned on scans.
    const float spacings_;
    /// The variance of the mean of one surfel's rays, relative to the variance of a single ray, and the variance of the
    /// mean direction of these rays. Both are powers of the ray count, fitted to measurements with shifted lattices.
    const float noise_, noise_of_bent_;
    std::vector<Surfel> surfels_;
    std::vector<std::uint32_t> index_; ///< index into surfels_ by rank
    std::size_t padded_;               ///< values per column: at least one window
    std::vector<float> values_;        ///< storage of all columns and features
    std::array<float*, columns> columns_{};
    std::array<float*, features> features_{};
    float model_variance_ = 0.0f; ///< variance of ao − predicted, without the noise of the rays
};

}
