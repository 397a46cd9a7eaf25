#include "alcove/field/detail/bricks.h"

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int cells = BrickView::cells, samples = BrickView::samples;
static_assert(Leaf::DIM == cells);
constexpr float unknown = 1e18f; // finite, so that interpolation between two such values is, too

/// Fills the samples of a brick from its leaf and the first layers of seven neighbours.
void fill_brick(const openvdb::FloatGrid::ConstAccessor& grid, const Coord& origin, float value_scale, float* brick) {
    for (int side = 0; side < 8; ++side) {
        const int sx = side >> 2, sy = side >> 1 & 1, sz = side & 1;
        const Coord neighbour = origin.offsetBy(sx * cells, sy * cells, sz * cells);
        const Leaf* leaf = grid.probeConstLeaf(neighbour);
        const float tile = leaf ? 0.0f : grid.getValue(neighbour);
        for (int x = sx ? cells : 0; x < (sx ? samples : cells); ++x)
            for (int y = sy ? cells : 0; y < (sy ? samples : cells); ++y)
                for (int z = sz ? cells : 0; z < (sz ? samples : cells); ++z) {
                    const float value = leaf ? leaf->getValue(Leaf::coordToOffset(Coord(x, y, z))) : tile;
                    brick[(x * samples + y) * samples + z] = value * value_scale;
                }
    }
}

}

Bricks::Bricks(const LevelSet& level, float value_scale, Extent extent)
    : voxel_(static_cast<float>(level.voxel)), usable_((level.outer_band - 1.0f) * voxel_),
      usable_inside_((level.inner_band - 1.0f) * voxel_), origin_(level.origin) {
    const openvdb::FloatGrid& grid = *level.grid->grid;
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    openvdb::CoordBBox box;
    for (const Leaf* leaf : leaves)
        box.expand(leaf->origin());
    if (leaves.empty())
        box = openvdb::CoordBBox(Coord(0), Coord(0));
    // The surface may be up to one voxel outside the outermost leaves.
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min()[axis] - 1.0, high = box.max()[axis] + double(cells);
        bounds_.center[axis] = static_cast<float>(level.origin[axis] + 0.5 * (low + high) * level.voxel);
        bounds_.half_extent[axis] = static_cast<float>(0.5 * (high - low) * level.voxel);
    }

    // A brick samples the leaf at its origin and the next leaves along the axes. A border of one brick surrounds all
    // bricks.
    const Coord low = box.min().offsetBy(-2 * cells);
    std::size_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = (box.max()[axis] - low[axis]) / cells + 2;
        offset_[axis] = static_cast<float>(-(level.origin[axis] / level.voxel) - low[axis]);
        count *= static_cast<std::size_t>(size_[axis]);
        if (count > std::size_t{1} << 28)
            throw LimitError("the grid spans more than 268 million bricks of 8³ voxels: use a coarser --voxel");
    }
    index_.assign(count, 0);
    const auto slot = [&](const Coord& origin) {
        const Coord b = origin - low;
        return (static_cast<std::size_t>(b.x() / cells) * static_cast<std::size_t>(size_[1]) +
                static_cast<std::size_t>(b.y() / cells)) *
                   static_cast<std::size_t>(size_[2]) +
               static_cast<std::size_t>(b.z() / cells);
    };
    const auto beside = [&](const Leaf* leaf, int side, int step) {
        return leaf->origin().offsetBy(step * (side >> 2), step * (side >> 1 & 1), step * (side & 1));
    };
    for (const Leaf* leaf : leaves)
        if (extent == Extent::whole) {
            for (int side = 0; side < 8; ++side)
                index_[slot(beside(leaf, side, -cells))] = 1;
        } else {
            bool complete = true;
            for (int side = 1; side < 8 && complete; ++side)
                complete = grid.tree().probeConstLeaf(beside(leaf, side, cells)) != nullptr;
            index_[slot(leaf->origin())] = complete;
        }

    // Bricks 0 and 1 represent all of the outside and all of the inside.
    std::vector<Coord> origins(2);
    const auto accessor = grid.getConstAccessor();
    std::size_t i = 0;
    for (int x = 0; x < size_[0]; ++x)
        for (int y = 0; y < size_[1]; ++y)
            for (int z = 0; z < size_[2]; ++z, ++i) {
                const Coord origin = low.offsetBy(x * cells, y * cells, z * cells);
                if (index_[i] == 1) {
                    index_[i] = static_cast<std::int32_t>(origins.size()) * BrickView::stride;
                    origins.push_back(origin);
                    if (origins.size() > std::numeric_limits<std::int32_t>::max() / BrickView::stride - 1)
                        throw LimitError("the grid needs more than 2.9 million bricks of 8³ voxels: use a "
                                         "coarser --voxel");
                } else if (extent == Extent::whole) {
                    index_[i] = accessor.getValue(origin) < 0.0f ? BrickView::stride : 0;
                }
            }
    bricks_.resize(origins.size() * BrickView::stride);
    const float outside = extent == Extent::whole ? grid.background() * value_scale : unknown;
    std::fill_n(bricks_.begin(), BrickView::stride, outside);
    std::fill_n(bricks_.begin() + BrickView::stride, BrickView::stride, -outside);
    parallel_for(origins.size() - 2, 64, [&](std::size_t begin, std::size_t end) {
        const auto reader = grid.getConstAccessor();
        for (std::size_t b = begin + 2; b < end + 2; ++b)
            fill_brick(reader, origins[b], value_scale, &bricks_[b * BrickView::stride]);
    });
}

BrickView Bricks::view() const {
    return {index_.data(),
            bricks_.data(),
            {size_[0], size_[1], size_[2]},
            1.0f / voxel_,
            {offset_.x, offset_.y, offset_.z}};
}

float Bricks::map(const Vec3& p) const {
    const Vec3 q = p / voxel_ + offset_;
    std::int32_t cell[3];
    float t[3];
    for (int axis = 0; axis < 3; ++axis) {
        const float last = static_cast<float>(size_[axis] * cells - 1);
        const float clamped = std::clamp(q[axis], 0.0f, last);
        const float whole = std::floor(clamped);
        cell[axis] = static_cast<std::int32_t>(whole);
        t[axis] = clamped - whole;
    }
    const auto slot = (static_cast<std::size_t>(cell[0] / cells) * static_cast<std::size_t>(size_[1]) +
                       static_cast<std::size_t>(cell[1] / cells)) *
                          static_cast<std::size_t>(size_[2]) +
                      static_cast<std::size_t>(cell[2] / cells);
    const std::int32_t first =
        index_[slot] + ((cell[0] % cells) * samples + cell[1] % cells) * samples + cell[2] % cells;
    const float* corner = bricks_.data() + first;
    const auto mix = [](float a, float b, float s) { return a + (b - a) * s; }; // unlike std::lerp(), without branches
    const auto along_z = [&](int at) { return mix(corner[at], corner[at + 1], t[2]); };
    const float near = mix(along_z(0), along_z(samples), t[1]);
    const float far = mix(along_z(samples * samples), along_z(samples * samples + samples), t[1]);
    return mix(near, far, t[0]);
}

}
