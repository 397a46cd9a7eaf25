/// The work behind Guided: rays of many surfels, and what each of them makes of its neighbours'.
#pragma once

#include "alcove/occlusion/detail/bilateral_sums.h"
#include "alcove/occlusion/methods/guided.h"

#include <array>
#include <span>
#include <vector>

namespace alcove {

/// The surfels along the Morton curve with what probes and rays say of them; those alike stand there once. Used
/// in this order: probe() and shoot() for all, fit_model() once, share(). Each but fit_model() may run for
/// different surfels at a time.
class JointBilateral {
  public:
    JointBilateral(const JointBilateral&) = delete;
    JointBilateral& operator=(const JointBilateral&) = delete;
    JointBilateral(std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                   const Guided& guided, bool with_bent);

    std::size_t size() const { return surfels_.size(); }
    /// Where the surfel of a rank in the order stands.
    std::size_t place(std::size_t rank) const { return place_[rank]; }

    void probe(const AnyField& field, std::size_t begin, std::size_t end);
    void shoot(const RaySurface& surface, std::size_t begin, std::size_t end);
    void fit_model();

    struct Answer {
        float ao;
        Vec3 bent; ///< sum of open directions; zero without
    };
    Answer share(std::size_t i) const;

  private:
    enum Column : std::size_t {
        position,
        normal = 3,
        ao = 6,
        predicted, ///< ao, by the model
        residual,  ///< ao − predicted
        bent,      ///< by how much it deviates from that of open surroundings; empty without
        columns = bent + 3
    };
    /// The probes, and what Calibrated makes of them.
    static constexpr std::size_t features = Curve::probes + 1;

    Curve curve() const;
    float reach(std::size_t i) const;
    Vec3 share_bent(std::size_t i, std::size_t first, const float* weights) const;

    const Guided guided_;
    const CosineLattice lattice_;
    const bool with_bent_;
    /// How far neighbours have a say, in median distances on the curve: the more rays, the nearer are enough. Measured
    /// on scans.
    const float spacings_;
    /// Of the mean of one surfel's rays, of the variance of one; of their direction, the variance. By their number
    /// as measured for shifted lattices.
    const float noise_, noise_of_bent_;
    std::vector<Surfel> surfels_;
    std::vector<std::uint32_t> place_; ///< of each rank, in surfels_
    std::size_t padded_;               ///< values of a column: at least a window
    std::vector<float> values_;        ///< all columns and features, in one piece
    std::array<float*, columns> columns_{};
    std::array<float*, features> features_{};
    float model_variance_ = 0.0f; ///< of ao − predicted, less the noise of the rays
};

}
