#include "alcove/vdb/detail/outliers.h"

#include "alcove/base/parallel.h"
#include "alcove/grid/detail/vdb_grid.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alcove {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int edge = 8;
static_assert(Leaf::DIM == edge);
constexpr std::array<int, 3> strides{edge * edge, edge, 1}; // between neighbours along x, y and z

/// Whether no neighbours in the leaf differ by more than `step`, where values below `deepest` count as `deepest`. Most
/// leaves of most grids pass this fast test.
bool is_smooth(const float* values, float step, float deepest) {
    int steps = 0;
    const auto count = [&](int v, int stride) {
        steps += int(std::fabs(std::max(values[v], deepest) - std::max(values[v + stride], deepest)) > step);
    };
    for (int v = 0; v < int(Leaf::SIZE) - strides[0]; ++v)
        count(v, strides[0]);
    for (int x = 0; x < edge; ++x)
        for (int v = x * strides[0]; v < (x + 1) * strides[0] - strides[1]; ++v)
            count(v, strides[1]);
    for (int row = 0; row < edge * edge; ++row)
        for (int v = row * edge; v < row * edge + edge - 1; ++v)
            count(v, strides[2]);
    return steps == 0;
}

/// The most negative value of an active voxel. Inactive voxels inside may have a lower value, minus the background,
/// because the inner band is not always as wide as the outer one.
float deepest_of(const std::vector<const Leaf*>& leaves) {
    std::vector<float> depths(leaves.size());
    parallel_for(leaves.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t l = begin; l < end; ++l)
            for (auto value = leaves[l]->cbeginValueOn(); value; ++value)
                depths[l] = std::min(depths[l], *value);
    });
    return depths.empty() ? 0.0f : *std::min_element(depths.begin(), depths.end());
}

class OutlierFinder {
  public:
    OutlierFinder(const FloatGrid& grid, float deepest, double voxel)
        : reader_(grid.getConstAccessor()), small_step_(static_cast<float>(1.15 * voxel)),
          large_step_(static_cast<float>(1.5 * voxel)), near_(static_cast<float>(2.0 * voxel)), deepest_(deepest) {
        openvdb::CoordBBox leaves;
        grid.tree().evalLeafBoundingBox(leaves);
        widest_ = static_cast<float>(voxel * leaves.extents().asVec3d().length());
    }

    Outliers outliers_in(const Leaf& leaf) {
        Outliers outliers;
        if (is_smooth_within_others(leaf))
            return outliers;
        for (auto value = leaf.cbeginValueOn(); value; ++value)
            if (is_outlier(leaf, *value, value.getCoord())) {
                ++outliers.count;
                outliers.far += std::fabs(*value) > widest_;
            }
        return outliers;
    }

  private:
    /// Whether no neighbours in and around the leaf, active or not, differ by more than small_step_.
    bool is_smooth_within_others(const Leaf& leaf) {
        if (!is_smooth(leaf.buffer().data(), small_step_, deepest_))
            return false;
        int steps = 0;
        for (const int side : {-1, 1})
            steps += steps_across<0>(leaf, side) + steps_across<1>(leaf, side) + steps_across<2>(leaf, side);
        return steps == 0;
    }
    template <int axis>
    int steps_across(const Leaf& leaf, int side) {
        Coord beyond = leaf.origin();
        beyond[axis] += side * edge;
        const Leaf* const other = reader_.probeConstLeaf(beyond);
        const float tile = other ? 0.0f : reader_.getValue(beyond);
        constexpr int last = (edge - 1) * strides[axis];
        const float* const own = leaf.buffer().data() + (side > 0 ? last : 0);
        const float* const others = other ? other->buffer().data() + (side > 0 ? 0 : last) : nullptr;
        constexpr int row = strides[axis == 2 ? 1 : 2], column = strides[axis == 0 ? 1 : 0];
        int steps = 0;
        for (int a = 0; a < edge; ++a)
            for (int b = 0; b < edge; ++b) {
                const int v = a * column + b * row;
                steps += is_step(own[v], others ? others[v] : tile);
            }
        return steps;
    }
    int is_step(float a, float b) const {
        return int(std::fabs(std::max(a, deepest_) - std::max(b, deepest_)) > small_step_);
    }
    bool is_outlier(const Leaf& leaf, float value, const Coord& at) {
        const bool near = std::fabs(value) < near_;
        int steps = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1}) {
                Coord beside = at;
                beside[axis] += side;
                float other = 0.0f;
                const bool within = at[axis] >> Leaf::LOG2DIM == beside[axis] >> Leaf::LOG2DIM;
                const bool active = within ? leaf.probeValue(beside, other) : reader_.probeValue(beside, other);
                const bool is_other_side = !active && (value < 0.0f) != (other < 0.0f);
                const float step =
                    is_other_side ? std::fabs(value) : std::fabs(std::max(value, deepest_) - std::max(other, deepest_));
                steps += int(step > small_step_) + int(near && step > large_step_);
            }
        return steps >= (near ? 2 : 3);
    }

    FloatGrid::ConstAccessor reader_;
    float small_step_, large_step_, near_, deepest_, widest_;
};

using Tree = openvdb::FloatTree;
using Reader = FloatGrid::ConstAccessor;

/// The edge of the tile or voxel at a position, in voxels.
int edge_at(const Reader& reader, const Coord& at) {
    constexpr std::array<int, 4> edges{4096, 128, 8, 1};
    return edges[static_cast<std::size_t>(std::max(reader.getValueDepth(at), 0))];
}

/// Whether any value in a square of size × size voxels, one voxel thick along `axis`, has the sign that `inside`
/// excludes. The coordinates of `low` along the square are multiples of `size`.
bool changes_sign(const Reader& reader, const Coord& low, int axis, int size, bool inside) {
    const int part = edge_at(reader, low);
    if (part >= size)
        return (reader.getValue(low) < 0.0f) != inside;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3, next = size > 128 ? 128 : size > edge ? edge : 1;
    Coord at = low;
    for (at[a] = low[a]; at[a] < low[a] + size; at[a] += next)
        for (at[b] = low[b]; at[b] < low[b] + size; at[b] += next)
            if (changes_sign(reader, at, axis, next, inside))
                return true;
    return false;
}

bool is_at_surface(const Reader& reader, const openvdb::CoordBBox& tile, float value) {
    for (int axis = 0; axis < 3; ++axis)
        for (const bool above : {false, true}) {
            Coord low = tile.min();
            low[axis] = above ? tile.max()[axis] + 1 : low[axis] - 1;
            if (changes_sign(reader, low, axis, tile.dim()[axis], value < 0.0f))
                return true;
        }
    return false;
}

}

Tiles simplify_tiles(const VdbGrid& level) {
    FloatGrid& grid = *level.grid;
    const float background = grid.background();
    const Reader reader(grid.constTree());
    Tiles tiles;
    openvdb::CoordBBox box;
    auto active = grid.tree().cbeginValueOn();
    for (active.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1); active; ++active) {
        active.getBoundingBox(box);
        tiles.at_surface += is_at_surface(reader, box, *active);
        tiles.voxels_within += std::fabs(*active) < background ? box.volume() : 0;
    }
    auto tile = grid.tree().beginValueAll();
    for (tile.setMaxDepth(Tree::ValueAllIter::LEAF_DEPTH - 1); tile; ++tile)
        if (tile.isValueOn()) {
            tile.setValue(std::copysign(background, *tile));
            tile.setActiveState(false);
        }
    grid.tree().root().eraseBackgroundTiles();
    return tiles;
}

double slope_of(const VdbGrid& level, double voxel) {
    const FloatGrid& grid = *level.grid;
    constexpr std::size_t enough = 4096;
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    const std::size_t stride = leaves.size() / enough + 1;
    const auto reader = grid.getConstAccessor();
    std::vector<double> slopes;
    for (std::size_t l = 0; l < leaves.size(); l += stride)
        for (auto value = leaves[l]->cbeginValueOn(); value; ++value) {
            const Coord at = value.getCoord();
            if ((*value < 0.0f) == (reader.getValue(at.offsetBy(1, 0, 0)) < 0.0f) &&
                (*value < 0.0f) == (reader.getValue(at.offsetBy(0, 1, 0)) < 0.0f) &&
                (*value < 0.0f) == (reader.getValue(at.offsetBy(0, 0, 1)) < 0.0f))
                continue;
            Vec3d gradient;
            for (int axis = 0; axis < 3; ++axis) {
                Coord step;
                step[axis] = 1;
                gradient[axis] = double(reader.getValue(at + step)) - double(reader.getValue(at - step));
            }
            slopes.push_back(0.5 * glm::length(gradient) / voxel);
            break;
        }
    if (slopes.empty())
        return 1.0;
    const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
    std::nth_element(slopes.begin(), middle, slopes.end());
    return *middle;
}

Outliers outliers_of(const VdbGrid& level, double voxel) {
    const FloatGrid& grid = *level.grid;
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    std::atomic<std::size_t> count{0}, far{0};
    const OutlierFinder finder(grid, deepest_of(leaves), voxel);
    parallel_for(leaves.size(), 256, [&](std::size_t begin, std::size_t end) {
        OutlierFinder own = finder;
        for (std::size_t l = begin; l < end; ++l) {
            const Outliers of_leaf = own.outliers_in(*leaves[l]);
            count += of_leaf.count;
            far += of_leaf.far;
        }
    });
    return {count, far};
}

}
