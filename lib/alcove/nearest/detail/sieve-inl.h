/// Who of eight wants what. Internal to grid/.
///
/// Included once a target of Highway, hence no include guard of the usual kind.

#if defined(ALCOVE_GRID_SIEVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_SIEVE_INL_H
#undef ALCOVE_GRID_SIEVE_INL_H
#else
#define ALCOVE_GRID_SIEVE_INL_H
#endif

#include "alcove/nearest/detail/lanes-inl.h"
#include "alcove/nearest/detail/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

// Kept and shared out without branches that depend on what is wanted: no machine predicts these.

/// What is wanted by some of eight.
class Shares {
  public:
    void clear() { count_ = 0; }
    /// For this many calls of add() at least.
    void make_room(std::size_t more) {
        if (what_.size() < count_ + more + eight) {
            what_.resize(2 * (count_ + more) + eight);
            wanting_.resize(what_.size());
        }
    }
    /// `wanting` says by whom, a bit each.
    HWY_INLINE void add(std::uint32_t what, std::uint32_t wanting) {
        what_[count_] = what;
        wanting_[count_] = wanting;
        count_ += wanting != 0;
    }

    std::size_t count() const { return count_; }
    std::uint32_t what(std::size_t i) const { return what_[i]; }
    std::uint32_t wanting(std::size_t i) const { return wanting_[i]; }

    /// What each of the eight wants, in the order in which it was added; until the next call.
    HWY_INLINE std::array<std::span<const std::uint32_t>, eight> share_out() {
        const std::size_t room = count_ + eight, all = eight * room; // vectors are written in full
        if (parts_.size() < all)
            parts_.resize(2 * all);
        std::fill_n(wanting_.begin() + static_cast<std::ptrdiff_t>(count_), eight, 0u);
        std::array<std::span<const std::uint32_t>, eight> parts;
        for (std::size_t i = 0; i < eight; ++i) {
            std::uint32_t *const part = parts_.data() + i * room, *end = part;
            const auto bit = hn::Set(du, 1u << i);
            for (std::size_t k = 0; k < count_; k += lanes) {
                const auto wants = hn::TestBit(hn::LoadU(du, &wanting_[k]), bit);
                // CompressStore() is many times as slow on some machines.
                hn::StoreU(hn::Compress(hn::LoadU(du, &what_[k]), wants), du, end);
                end += hn::CountTrue(du, wants);
            }
            parts[i] = {part, end};
        }
        return parts;
    }

  private:
    Nodes what_, wanting_; // of one size
    Nodes parts_;
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
    HWY_INLINE void sift(const TriangleTree& tree, std::span<const std::uint32_t> nodes, float largest,
                         const Wanting& wanting) {
        std::size_t opened = 0;
        const auto make_room = [&](std::size_t more) {
            shares_.make_room(more);
            if (children_.size() < opened + more)
                children_.resize(2 * (opened + more));
        };
        const auto ask = [&](std::uint32_t node) HWY_ATTR {
            const std::uint32_t bits = wanting(node);
            const Bounds& bounds = tree.nodes[node];
            const bool picked = node < tree.leaves || bounds.radius <= largest;
            shares_.add(node, picked ? bits : 0);
            children_[opened] = bounds.child;
            opened += !picked && bits != 0;
        };
        shares_.clear();
        make_room(nodes.size());
        for (const std::uint32_t node : nodes)
            ask(node);
        for (std::size_t k = 0; k < opened; ++k) {
            make_room(TriangleTree::children);
            const std::uint32_t first = children_[k];
            for (std::uint32_t node = first; node < first + TriangleTree::children; ++node)
                ask(node);
        }
    }

    Shares& shares() { return shares_; }

  private:
    Nodes children_; // of opened nodes, the first each
    Shares shares_;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
