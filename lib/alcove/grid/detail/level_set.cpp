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

/// Where the leaves of a level are and how their values are stored.
struct Storage {
    int stride;
    double value_scale;
    Index3 first{0};                 ///< index of the band's origin, in voxels of stride 1
    const LevelSet* finer = nullptr; ///< whose distances are reused
    bool keeps_empty = false;        ///< also keep bricks without a voxel in the band
};

LevelSet store(const Band& band, std::span<const BandBlock> blocks, const Storage& to,
               std::vector<NearestOfBrick>* nearest) {
    const auto scaled = [&](float voxels) { return static_cast<float>(voxels * to.value_scale); };
    const float outside = scaled(band.width().outer);
    std::vector<std::unique_ptr<Leaf>> leaves(blocks.size());
    std::vector<std::size_t> counts(blocks.size());
    if (nearest)
        nearest->resize(blocks.size());
    parallel_for(blocks.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const Index3 low = blocks[b].low + to.first / to.stride;
            const BandBrick brick = band.brick(blocks[b], to.stride, known_distances(to.finer, low, to.value_scale));
            counts[b] = brick.count;
            if (nearest)
                (*nearest)[b] = {low, brick.triangle, std::to_array(brick.values)};
            if (brick.count == 0 && !to.keeps_empty)
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
    if (band.sign() == Sign::solid && !to.keeps_empty)
        openvdb::tools::signedFloodFillWithValues(*tree, outside, scaled(-band.width().inner), true, 1, 1);
    auto grid = openvdb::FloatGrid::create(tree);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    LevelSet set;
    set.active_voxels = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    set.bytes = grid->memUsage();
    set.grid = std::make_shared<VdbGrid>(VdbGrid{grid});
    return set;
}

}

LevelSet level_set(const Band& band, int stride, double value_scale, const Index3& first, const LevelSet* finer,
                   std::vector<NearestOfBrick>* nearest) {
    return store(band, band.blocks(stride), {stride, value_scale, first, finer}, nearest);
}

LevelSet partial_level_set(const Band& band, std::span<const BandBlock> bricks, int stride, double value_scale) {
    return store(band, bricks, {.stride = stride, .value_scale = value_scale, .keeps_empty = true}, nullptr);
}

}
