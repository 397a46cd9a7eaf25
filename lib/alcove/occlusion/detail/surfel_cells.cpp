#include "alcove/occlusion/detail/surfel_cells.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/occlusion/detail/surfel_cells.cpp"
#include <hwy/foreach_target.h> // compiles this file once per target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Writes those points of the ranges that are within the bounds to `found`, which has room for all points of the ranges
/// and one SIMD vector more. \return their number
std::size_t find_within(const SurfelCells::Points& points, std::span<const SurfelCells::Range> ranges,
                        const Bounds& bounds, std::uint32_t* found) {
    const hn::CappedTag<float, 16> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const auto least_x = hn::Set(d, bounds.low.x), least_y = hn::Set(d, bounds.low.y),
               least_z = hn::Set(d, bounds.low.z), most_x = hn::Set(d, bounds.high.x),
               most_y = hn::Set(d, bounds.high.y), most_z = hn::Set(d, bounds.high.z);
    std::size_t count = 0;
    for (const SurfelCells::Range& range : ranges)
        for (std::uint32_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
            const auto x = hn::LoadU(d, &points.x[i]), y = hn::LoadU(d, &points.y[i]), z = hn::LoadU(d, &points.z[i]);
            const auto above = hn::And(hn::And(hn::Ge(x, least_x), hn::Ge(y, least_y)), hn::Ge(z, least_z));
            const auto below = hn::And(hn::And(hn::Le(x, most_x), hn::Le(y, most_y)), hn::Le(z, most_z));
            const auto within = hn::And(hn::And(above, below), hn::FirstN(d, range.end - i));
            count += hn::CompressStore(hn::Iota(du, i), hn::RebindMask(du, within), du, found + count);
        }
    return count;
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {
namespace {

constexpr std::uint32_t edge_bits = 2, last_in_block = (1 << edge_bits) - 1;
constexpr std::size_t cells_per_block = 1 << (3 * edge_bits), lanes = 16;

using Cell = SurfelCells::Cell;

std::uint64_t block_key(const Cell& cell) {
    constexpr std::uint32_t axis_bits = 21;
    return std::uint64_t(cell[0] >> edge_bits) << (2 * axis_bits) | std::uint64_t(cell[1] >> edge_bits) << axis_bits |
           cell[2] >> edge_bits;
}

/// z is last, so that the cells of a block with equal x and y follow each other.
std::uint32_t within_block(const Cell& cell) {
    return (cell[0] & last_in_block) << (2 * edge_bits) | (cell[1] & last_in_block) << edge_bits |
           (cell[2] & last_in_block);
}

}

HWY_EXPORT(find_within);

SurfelCells::SurfelCells(std::span<const Surfel> surfels, float cell) : blocks_(1 << 10) {
    constexpr float most_cells = 1 << 20; // along each axis
    Bounds bounds{Vec3(std::numeric_limits<float>::max()), Vec3(std::numeric_limits<float>::lowest())};
    for (const Surfel& s : surfels)
        if (s.has_normal())
            bounds.add(s.position);
    low_ = bounds.low;
    const Vec3 size = bounds.high - bounds.low;
    scale_ = 1.0f / std::max(cell, std::max({size.x, size.y, size.z}) / most_cells);
    last_ = scale_ * size;
    constexpr std::size_t fewest_blocks = 1000, least_per_block = 8; // dense surfels have a hundred per block
    HugeVector<std::uint32_t> cell_of(surfels.size());
    for (std::size_t i = 0; i < surfels.size(); ++i)
        if (surfels[i].has_normal()) {
            is_sparse_ = block_count_ > fewest_blocks && least_per_block * block_count_ > surfels.size();
            if (is_sparse_)
                return;
            const Cell at = cell_at(surfels[i].position);
            cell_of[i] = static_cast<std::uint32_t>(cells_per_block * find_or_add(at) + within_block(at));
            ++begins_[cell_of[i] + 1];
        }
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    for (HugeVector<float>* const values : {&points_.x, &points_.y, &points_.z})
        values->resize(begins_.back() + lanes);
    points_.surfel.resize(begins_.back());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end());
    for (std::size_t i = 0; i < surfels.size(); ++i)
        if (surfels[i].has_normal()) {
            const std::uint32_t at = next[cell_of[i]]++;
            points_.x[at] = surfels[i].position.x;
            points_.y[at] = surfels[i].position.y;
            points_.z[at] = surfels[i].position.z;
            points_.surfel[at] = static_cast<std::uint32_t>(i);
        }
}

/// The cell of a point, or the closest cell if the point is outside.
SurfelCells::Cell SurfelCells::cell_at(const Vec3& p) const {
    const auto along = [&](int axis) {
        const float at = scale_ * (p[axis] - low_[axis]);
        return static_cast<std::uint32_t>(std::clamp(at, 0.0f, last_[axis]));
    };
    return {along(0), along(1), along(2)};
}

/// The slot of a block, or the free slot where it belongs.
std::size_t SurfelCells::slot_of(std::uint64_t key) const {
    const std::uint64_t mixed = key * 0x9e3779b97f4a7c15; // Fibonacci hashing (Knuth 1998)
    std::size_t slot = mixed >> 32 & (blocks_.size() - 1);
    while (blocks_[slot].key != key && blocks_[slot].key != no_key)
        slot = (slot + 1) & (blocks_.size() - 1);
    return slot;
}

std::uint32_t SurfelCells::find_or_add(const Cell& cell) {
    const std::uint64_t key = block_key(cell);
    std::size_t slot = slot_of(key);
    if (blocks_[slot].key == no_key) {
        if (2 * ++block_count_ > blocks_.size()) {
            const std::vector<Block> old = std::exchange(blocks_, std::vector<Block>(2 * blocks_.size()));
            for (const Block& block : old)
                if (block.key != no_key)
                    blocks_[slot_of(block.key)] = block;
            slot = slot_of(key);
        }
        blocks_[slot] = {key, static_cast<std::uint32_t>(block_count_ - 1)};
        begins_.resize(cells_per_block * block_count_ + 1);
    }
    return blocks_[slot].index;
}

double SurfelCells::Cells::count() const {
    double count = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        count *= last[axis] - first[axis] + 1.0;
    return count;
}

void SurfelCells::find(const Cells& cells, const Bounds& bounds, Found& found) const {
    const auto& [first, last] = cells;
    found.ranges_.clear();
    found.count_ = 0;
    std::size_t most = 0;
    for (std::uint32_t x = first[0]; x <= last[0]; ++x)
        for (std::uint32_t y = first[1]; y <= last[1]; ++y)
            for (std::uint32_t z = first[2]; z <= last[2]; z = (z | last_in_block) + 1) {
                const Block& block = blocks_[slot_of(block_key({x, y, z}))];
                if (block.key == no_key)
                    continue;
                const std::uint32_t* const begins = &begins_[cells_per_block * block.index];
                const Range range{begins[within_block({x, y, z})],
                                  begins[within_block({x, y, std::min(last[2], z | last_in_block)}) + 1]};
                if (range.begin == range.end)
                    continue;
                found.ranges_.push_back(range);
                most += range.end - range.begin;
            }
    if (most == 0)
        return;
    found.points_.resize(std::max(found.points_.size(), most + lanes));
    found.count_ = HWY_DYNAMIC_DISPATCH(find_within)(points_, found.ranges_, bounds, found.points_.data());
}

}
#endif
