/// Fits the last layer of a RingNetwork to the reference ao of one mesh.
#pragma once

#include "alcove/occlusion/detail/ring_network.h"

#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

/// Ridge regression of a network's errors on its hidden values (Hoerl and Kennard 1970). The last layer changes only as
/// far as the examples support a change. The network's value on planes stays the same.
class LastLayerFit {
  public:
    explicit LastLayerFit(const RingNetwork::LastLayer& trained);

    /// Adds the first `ao.size()` surfels of a batch as examples. `ao` is the reference, which 1 plus the network's
    /// value should approximate.
    void add(const RingNetwork::Hidden& h, std::span<const float> ao);
    /// The fitted layer, or the trained one if there are no examples.
    RingNetwork::LastLayer layer() const;

  private:
    RingNetwork::LastLayer trained_;
    std::vector<double> products_, errors_; ///< Σ h hᵀ, row by row, and Σ h (ao − clamp(1 + w·h))
};

}
