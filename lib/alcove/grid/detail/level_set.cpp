#include "alcove/grid/detail/level_set.h"

#include "alcove/base/parallel.h"
#include "alcove/grid/detail/vdb_grid.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace alcove {
namespace {

using openvdb::Coord;
using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;
static_assert(Leaf::DIM == brick_size && Leaf::NodeMaskType::WORD_COUNT == brick_size);

Coord coord(const Index3& index) {
    return {index.x, index.y, index.z};
}

/// Distances (in voxels) in the brick at `low` that can be copied from every second voxel of the finer level; infinite
/// elsewhere.
std::array<float, brick_volume> known_distances(const LevelSet* finer, const Index3& low, double value_scale) {
    std::array<float, brick_volume> known;
    known.fill(std::numeric_limits<float>::infinity());
    if (!finer)
        return known;
    const FloatTree& tree = finer->grid->grid->constTree();
    constexpr int half = brick_size / 2;
    const double per_value = 1.0 / value_scale;
    for (int octant = 0; octant < 8; ++octant) {
        const Index3 part = half * Index3(octant >> 2, octant >> 1 & 1, octant & 1), at = 2 * (low + part);
        const Leaf* leaf = tree.probeConstLeaf(coord(at));
        if (!leaf)
            continue;
        const float* const values = leaf->buffer().data();
        for (int x = 0; x < half; ++x) {
            const auto slice = leaf->getValueMask().getWord<openvdb::Index64>(static_cast<openvdb::Index>(2 * x));
            for (int y = 0; y < half; ++y)
                for (int z = 0; z < half; ++z)
                    if (const int row = 2 * y * brick_size; slice >> (row + 2 * z) & 1) {
                        const int voxel = ((part.x + x) * brick_size + part.y + y) * brick_size + part.z + z;
                        known[static_cast<std::size_t>(voxel)] = static_cast<float>(
                            std::fabs(values[2 * x * brick_size * brick_size + row + 2 * z]) * per_value);
                    }
        }
    }
    return known;
}

}

LevelSet level_set(const Band& band, int stride, double value_scale, const Index3& first, const LevelSet* finer) {
    const auto scaled = [&](float voxels) { return static_cast<float>(voxels * value_scale); };
    const float outside = scaled(band.width().outer), inside = scaled(-band.width().inner);
    const std::vector<BandBlock> blocks = band.blocks(stride);
    std::vector<std::unique_ptr<Leaf>> leaves(blocks.size());
    std::vector<std::size_t> counts(blocks.size());
    parallel_for(blocks.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const Index3 low = blocks[b].low + first / stride;
            const BandBrick brick = band.brick(blocks[b], stride, known_distances(finer, low, value_scale));
            counts[b] = brick.count;
            if (brick.count == 0)
                continue;
            auto leaf = std::make_unique<Leaf>(coord(low), outside);
            std::transform(brick.values, brick.values + brick_volume, leaf->buffer().data(), scaled);
            auto mask = leaf->getValueMask();
            for (openvdb::Index x = 0; x < brick_size; ++x)
                mask.getWord<openvdb::Index64>(x) = brick.active[x];
            leaf->setValueMask(mask);
            leaves[b] = std::move(leaf);
        }
    });

    auto tree = std::make_shared<FloatTree>(outside);
    for (auto& leaf : leaves)
        if (leaf)
            tree->addLeaf(leaf.release());
    if (band.sign() == Sign::solid)
        openvdb::tools::signedFloodFillWithValues(*tree, outside, inside, true, 1, 1);
    auto grid = openvdb::FloatGrid::create(tree);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    LevelSet set;
    set.active_voxels = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    set.bytes = grid->memUsage();
    set.grid = std::make_shared<VdbGrid>(VdbGrid{grid});
    return set;
}

}
