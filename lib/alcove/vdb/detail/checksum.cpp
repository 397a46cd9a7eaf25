#include "alcove/vdb/detail/checksum.h"

#include "alcove/base/parallel.h"
#include "alcove/grid/detail/vdb_grid.h"

#include <zlib.h>

#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace alcove {
namespace {

using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;
using Sums = std::vector<std::uint32_t>;

/// The CRC-32 of a sequence of bytes.
class Checksum {
  public:
    template <class T>
    Checksum& add(const T* values, std::size_t count) {
        sum_ = crc32_z(sum_, reinterpret_cast<const Bytef*>(values), count * sizeof(T));
        return *this;
    }
    Checksum& add(const std::string& text) { return add(text.c_str(), text.size() + 1); }
    Checksum& add(const Sums& sums) { return add(sums.data(), sums.size()); }
    template <class Mask>
    Checksum& add_mask(const Mask& mask) {
        std::array<openvdb::Index64, Mask::WORD_COUNT> words;
        for (openvdb::Index w = 0; w < Mask::WORD_COUNT; ++w)
            words[w] = mask.template getWord<openvdb::Index64>(w);
        return add(words.data(), words.size());
    }
    std::uint32_t sum() const { return static_cast<std::uint32_t>(sum_); }

  private:
    uLong sum_ = 0;
};

std::uint32_t sum_of(const Leaf& leaf) {
    return Checksum()
        .add(leaf.origin().data(), 3)
        .add_mask(leaf.getValueMask())
        .add(leaf.buffer().data(), Leaf::SIZE)
        .sum();
}

/// The checksum of an internal node, including the values of its tiles.
template <class Node>
std::uint32_t sum_of(const Node& node) {
    std::vector<float> values;
    values.reserve(Node::NUM_VALUES);
    for (auto value = node.cbeginValueAll(); value; ++value)
        values.push_back(*value);
    return Checksum()
        .add(node.origin().data(), 3)
        .add_mask(node.getChildMask())
        .add_mask(node.getValueMask())
        .add(values.data(), values.size())
        .sum();
}

template <class Node>
Sums sums_of(const FloatTree& tree) {
    std::vector<const Node*> nodes;
    tree.getNodes(nodes);
    Sums sums(nodes.size());
    parallel_for(nodes.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            sums[n] = sum_of(*nodes[n]);
    });
    return sums;
}

}

std::uint32_t checksum_of(const VdbGrid& level) {
    const openvdb::FloatGrid& grid = *level.grid;
    Checksum sum;
    for (auto meta = grid.beginMeta(); meta != grid.endMeta(); ++meta) {
        const std::string& name = meta->first;
        if (name != openvdb::GridBase::META_GRID_CLASS && (!name.starts_with("alcove:") || name == "alcove:checksum"))
            continue;
        std::ostringstream value;
        meta->second->write(value);
        sum.add(name).add(meta->second->typeName()).add(value.str());
    }
    const auto map = grid.transform().baseMap()->getAffineMap()->getMat4();
    sum.add(map.asPointer(), 16);
    const FloatTree& tree = grid.constTree();
    const float background = grid.background();
    sum.add(&background, 1);
    for (auto tile = tree.root().cbeginValueAll(); tile; ++tile) {
        const float value = *tile;
        const char active = tile.isValueOn() ? 1 : 0;
        sum.add(tile.getCoord().data(), 3).add(&value, 1).add(&active, 1);
    }
    using Upper = FloatTree::RootNodeType::ChildNodeType;
    return sum.add(sums_of<Upper>(tree)).add(sums_of<Upper::ChildNodeType>(tree)).add(sums_of<Leaf>(tree)).sum();
}

}
