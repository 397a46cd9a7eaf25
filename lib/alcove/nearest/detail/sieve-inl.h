/// Selects tree nodes for each of eight octants or voxels.
///
/// Included once per Highway target, hence the unusual include guard.

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

// Selection and distribution avoid branches on the data, which would be mispredicted.

/// Nodes, each with a mask of the octants (or voxels) that need it.
class MaskedNodes {
  public:
    void clear() { count_ = 0; }
    /// Makes room for `more` calls of add().
    void make_room(std::size_t more) {
        if (nodes_.size() < count_ + more + eight) {
            nodes_.resize(2 * (count_ + more) + eight);
            masks_.resize(nodes_.size());
        }
    }
    /// Adds a node unless its mask is 0.
    HWY_INLINE void add(std::uint32_t node, std::uint32_t mask) {
        nodes_[count_] = node;
        masks_[count_] = mask;
        count_ += mask != 0;
    }

    std::size_t count() const { return count_; }
    std::uint32_t node(std::size_t i) const { return nodes_[i]; }
    std::uint32_t mask(std::size_t i) const { return masks_[i]; }

    /// The nodes of each octant, in the order in which they were added; valid until the next call.
    HWY_INLINE std::array<std::span<const std::uint32_t>, eight> per_octant() {
        const std::size_t room = count_ + eight, all = eight * room; // vectors are written in full
        if (parts_.size() < all)
            parts_.resize(2 * all);
        std::fill_n(masks_.begin() + static_cast<std::ptrdiff_t>(count_), eight, 0u);
        std::array<std::span<const std::uint32_t>, eight> parts;
        for (std::size_t i = 0; i < eight; ++i) {
            std::uint32_t *const part = parts_.data() + i * room, *end = part;
            const auto bit = hn::Set(du, 1u << i);
            for (std::size_t k = 0; k < count_; k += lanes) {
                const auto needed = hn::TestBit(hn::LoadU(du, &masks_[k]), bit);
                // CompressStore() is many times slower on some machines.
                hn::StoreU(hn::Compress(hn::LoadU(du, &nodes_[k]), needed), du, end);
                end += hn::CountTrue(du, needed);
            }
            parts[i] = {part, end};
        }
        return parts;
    }

  private:
    Nodes nodes_, masks_; // of equal size
    Nodes parts_;
    std::size_t count_ = 0;
};

/// A limit that every radius exceeds, so that only leaves are selected.
inline constexpr float down_to_leaves = -1.0f;

/// Selects the nodes that some octant or voxel needs.
class Sieve {
  public:
    /// `mask_of(node)` returns a mask with one bit set for each octant or voxel that needs the node. Inner nodes whose
    /// radius exceeds `largest` are replaced by their children.
    template <class MaskOf>
    HWY_INLINE void sift(const TriangleTree& tree, std::span<const std::uint32_t> nodes, float largest,
                         const MaskOf& mask_of) {
        std::size_t opened = 0;
        const auto make_room = [&](std::size_t more) {
            selected_.make_room(more);
            if (children_.size() < opened + more)
                children_.resize(2 * (opened + more));
        };
        const auto test = [&](std::uint32_t node) HWY_ATTR {
            const std::uint32_t bits = mask_of(node);
            const Bounds& bounds = tree.nodes[node];
            const bool is_small = node < tree.leaves || bounds.radius <= largest;
            selected_.add(node, is_small ? bits : 0);
            children_[opened] = bounds.child;
            opened += !is_small && bits != 0;
        };
        selected_.clear();
        make_room(nodes.size());
        for (const std::uint32_t node : nodes)
            test(node);
        for (std::size_t k = 0; k < opened; ++k) {
            make_room(TriangleTree::children);
            const std::uint32_t first = children_[k];
            for (std::uint32_t node = first; node < first + TriangleTree::children; ++node)
                test(node);
        }
    }

    MaskedNodes& selected() { return selected_; }

  private:
    Nodes children_; // first child of each opened node
    MaskedNodes selected_;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
