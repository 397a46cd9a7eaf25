/// Who of eight wants what. Internal to grid/.
#pragma once

#include "alcove/grid/triangle_tree.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// Nodes of a TriangleTree.
using Nodes = std::vector<std::uint32_t>;

/// What is wanted by some of eight, kept without branches that depend on it: no machine predicts these.
class Shares {
  public:
    struct Share {
        std::uint32_t what, wanting; ///< by whom, a bit each
    };

    void clear() { count_ = 0; }
    /// For this many calls of add() at least.
    void make_room(std::size_t more) {
        if (shares_.size() < count_ + more)
            shares_.resize(2 * (count_ + more));
    }
    void add(std::uint32_t what, std::uint32_t wanting) {
        shares_[count_] = {what, wanting};
        count_ += wanting != 0;
    }

    std::span<const Share> all() const { return {shares_.data(), count_}; }

    void share_out(std::array<Nodes, 8>& parts) const {
        for (std::uint32_t i = 0; i < 8; ++i) {
            Nodes& part = parts[i];
            part.resize(count_ + 1);
            std::size_t count = 0;
            for (const Share& share : all()) {
                part[count] = share.what;
                count += share.wanting >> i & 1;
            }
            part.resize(count);
        }
    }

  private:
    std::vector<Share> shares_;
    std::size_t count_ = 0;
};

/// A radius that every node is over, so that none but leaves are picked.
inline constexpr float down_to_leaves = -1.0f;

/// Picks the wanted ones out of nodes.
class Sieve {
  public:
    /// `wanting` gives the bits of those that want a node; nodes of a radius over `largest` are asked for by their
    /// children.
    template <class Wanting>
    std::span<const Shares::Share> sift(const TriangleTree& tree, std::span<const std::uint32_t> nodes,
                                        float largest, const Wanting& wanting) {
        queue_.assign(nodes.begin(), nodes.end());
        shares_.clear();
        shares_.make_room(queue_.size());
        for (std::size_t k = 0; k < queue_.size(); ++k) {
            const std::uint32_t node = queue_[k], bits = wanting(node);
            const Bounds& bounds = tree.nodes[node];
            if (node < tree.leaves || bounds.radius <= largest) {
                shares_.add(node, bits);
            } else if (bits != 0) {
                for (std::uint32_t c = 0; c < TriangleTree::children; ++c)
                    queue_.push_back(bounds.child + c);
                shares_.make_room(queue_.size() - k);
            }
        }
        return shares_.all();
    }

    const Shares& shares() const { return shares_; }

  private:
    Nodes queue_;
    Shares shares_;
};

}
