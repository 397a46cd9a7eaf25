#include "alcove/field/level_stack.h"

#include "alcove/field/detail/bricks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove {
namespace {

constexpr std::size_t block = 256;

}

LevelStack::LevelStack(const GridStack& stack)
    : two_sided_(stack.sign == Sign::sheet), knows_inside_(!two_sided_ && stack.knows_inside()) {
    const auto scale = static_cast<float>(stack.value_unit / stack.frame.diagonal);
    auto levels = std::make_shared<std::vector<Bricks>>(), partial = std::make_shared<std::vector<Bricks>>();
    for (const LevelSet& level : stack.levels)
        levels->emplace_back(level, scale);
    for (auto level = stack.partial.rbegin(); level != stack.partial.rend(); ++level)
        partial->emplace_back(*level, scale, Bricks::Extent::partial);
    levels_ = std::move(levels);
    partial_ = std::move(partial);
}

std::size_t LevelStack::bytes() const {
    std::size_t sum = 0;
    for (const auto& set : {levels_, partial_})
        for (const Bricks& level : *set)
            sum += level.bytes();
    return sum;
}

float LevelStack::resolution() const {
    return levels_->front().voxel();
}

float LevelStack::reach() const {
    return levels_->back().usable();
}

float LevelStack::extent() const {
    const Cuboid& bounds = levels_->front().bounds();
    return glm::length(glm::abs(bounds.center) + bounds.half_extent);
}

std::size_t LevelStack::level_for(float reach) const {
    std::size_t level = 0;
    while (level + 1 < levels_->size() && (*levels_)[level].usable() < reach)
        ++level;
    return level;
}

float LevelStack::map(const Vec3& p) const {
    for (auto level = partial_->rbegin(); level != partial_->rend(); ++level)
        if (const float distance = level->map(p); distance < level->usable() && distance > -level->usable_inside())
            return distance;
    float distance = levels_->front().map(p), nearest = levels_->front().usable();
    if (!cut(distance, nearest))
        return distance;
    if (const float outside = levels_->front().bounds().map(p); outside >= reach())
        return outside;
    // A distance beyond the band of a finer level is at least the width of that band, but behind a sheet the coarser
    // level may return less.
    for (std::size_t level = 1; level < levels_->size(); ++level) {
        const float coarser = (*levels_)[level].map(p);
        distance = distance > 0.0f ? std::max(coarser, nearest) : std::min(coarser, -nearest);
        nearest = (*levels_)[level].usable();
        if (!cut(distance, nearest))
            break;
    }
    return distance;
}

void LevelStack::map(const Points& points, float reach, float* distances) const {
    const bool one_level = reach <= this->reach();
    if (one_level)
        sample_bricks((*levels_)[level_for(reach)].view(), points, distances);
    if (one_level && partial_->empty())
        return;
    for (std::size_t begin = 0; begin < points.count; begin += block) {
        const Points some{points.x + begin, points.y + begin, points.z + begin, std::min(block, points.count - begin)};
        if (!one_level)
            escalate(some, distances + begin);
        refine(some, distances + begin);
    }
}

/// Replaces each distance by that of the finest partial level that has a distance at the point.
void LevelStack::refine(const Points& points, float* distances) const {
    std::array<float, block> x, y, z, values;
    std::array<std::uint16_t, block> near;
    for (const Bricks& level : *partial_) {
        // Where the coarser distance is at least `reach`, any wall that the coarser level misses lies beyond this
        // level's band.
        const float reach = level.usable() + levels_->front().voxel();
        std::size_t count = 0;
        for (std::size_t i = 0; i < points.count; ++i)
            if (std::fabs(distances[i]) < reach) {
                x[count] = points.x[i];
                y[count] = points.y[i];
                z[count] = points.z[i];
                near[count++] = static_cast<std::uint16_t>(i);
            }
        if (count == 0)
            return;
        sample_bricks(level.view(), {x.data(), y.data(), z.data(), count}, values.data());
        for (std::size_t k = 0; k < count; ++k)
            if (values[k] < level.usable() && values[k] > -level.usable_inside())
                distances[near[k]] = values[k];
    }
}

void LevelStack::escalate(const Points& points, float* distances) const {
    sample_bricks(levels_->front().view(), points, distances);
    std::array<float, block> x, y, z, values;
    std::array<std::uint16_t, block> far; // indices of points beyond the band of the previous level
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.count; ++i)
        if (cut(distances[i], levels_->front().usable())) {
            const float outside = levels_->front().bounds().map(points[i]);
            if (outside >= reach())
                distances[i] = outside;
            else
                far[count++] = static_cast<std::uint16_t>(i);
        }
    for (std::size_t level = 1; level < levels_->size() && count > 0; ++level) {
        for (std::size_t k = 0; k < count; ++k) {
            x[k] = points.x[far[k]];
            y[k] = points.y[far[k]];
            z[k] = points.z[far[k]];
        }
        const Bricks& bricks = (*levels_)[level];
        const float nearest = (*levels_)[level - 1].usable();
        sample_bricks(bricks.view(), {x.data(), y.data(), z.data(), count}, values.data());
        std::size_t left = 0;
        for (std::size_t k = 0; k < count; ++k) {
            float& distance = distances[far[k]];
            distance = distance > 0.0f ? std::max(values[k], nearest) : std::min(values[k], -nearest);
            if (cut(values[k], bricks.usable()))
                far[left++] = far[k];
        }
        count = left;
    }
}

}
