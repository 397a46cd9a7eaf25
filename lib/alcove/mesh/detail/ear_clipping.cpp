#include "alcove/mesh/detail/ear_clipping.h"

#include <algorithm>
#include <utility>

namespace alcove {
namespace {

using Vec2d = glm::dvec2;

/// If there is no ear, this many corners are compared, and the one with the largest left turn is clipped.
constexpr std::size_t most_compared = 2048;

bool is_inside(const Vec2d& p, const std::array<Vec2d, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    return turns_left(a, b, p) && turns_left(b, c, p) && turns_left(c, a, p);
}

/// Whether a path from `p`, which is in the triangle or on its sides, to `q` begins inside the triangle.
bool enters(const Vec2d& p, const Vec2d& q, const std::array<Vec2d, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const auto leads_inwards = [&](const Vec2d& from, const Vec2d& to) {
        return turns_left(from, to, p) || turns_left(from, to, q);
    };
    return leads_inwards(a, b) && leads_inwards(b, c) && leads_inwards(c, a);
}

}

std::span<const std::array<std::uint32_t, 3>> EarClipper::clip(std::span<const Vec2d> outline) {
    outline_ = outline;
    link();
    triangles_.clear();
    may_touch_ = false;
    ears_.reset(outline.size());
    find_ears(0);
    std::size_t at = 0, searchable = 32 * outline.size(); // bounds the cost of outlines that cross themselves
    for (std::size_t left = outline.size(); left > 3; --left) {
        for (; ears_.empty() && searchable >= left; searchable -= left) {
            find_ears(at);
            if (ears_.empty() && std::exchange(may_touch_, true))
                break;
        }
        const std::size_t tip = ears_.empty() ? sharpest_from(at) : ears_.next_or_first(at);
        // Skip the next corner, so that the cuts do not all meet at one vertex.
        at = next_[next_[tip]];
        clip_ear(tip);
    }
    triangles_.push_back({previous_[at], static_cast<std::uint32_t>(at), next_[at]});
    return triangles_;
}

double EarClipper::turn_at(std::size_t i) const {
    return turn(outline_[previous_[i]], outline_[i], outline_[next_[i]]);
}

bool EarClipper::is_convex(std::size_t i) const {
    return turns_left(outline_[previous_[i]], outline_[i], outline_[next_[i]]);
}

bool EarClipper::is_ear(std::size_t i) const {
    if (!is_convex(i))
        return false;
    const std::array<Vec2d, 3> ear{outline_[previous_[i]], outline_[i], outline_[next_[i]]};
    return !reflex_.any_in(ear, [&](std::size_t r) {
        if (r == previous_[i] || r == i || r == next_[i])
            return false;
        const Vec2d& p = outline_[r];
        if (may_touch_)
            return is_inside(p, ear) || enters(p, outline_[previous_[r]], ear) || enters(p, outline_[next_[r]], ear);
        return p != ear[0] && p != ear[1] && p != ear[2];
    });
}

void EarClipper::link() {
    const auto count = static_cast<std::uint32_t>(outline_.size());
    previous_.resize(count);
    next_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        previous_[i] = (i == 0 ? count : i) - 1;
        next_[i] = i + 1 == count ? 0 : i + 1;
    }
    is_reflex_.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        is_reflex_[i] = !is_convex(i);
    reflex_.build(outline_, is_reflex_);
}

void EarClipper::clip_ear(std::size_t i) {
    const std::uint32_t before = previous_[i], after = next_[i];
    triangles_.push_back({before, static_cast<std::uint32_t>(i), after});
    next_[before] = after;
    previous_[after] = before;
    ears_.remove(i);
    if (reflex_.has(i))
        reflex_.remove(i);
    // Clipping an ear only makes the corners beside it sharper. It does not affect the other ears of a simple polygon,
    // unless a corner touches the side of an ear.
    for (const std::uint32_t neighbour : {before, after})
        if (reflex_.has(neighbour) && is_convex(neighbour))
            reflex_.remove(neighbour);
    update_ear(before);
    update_ear(after);
}

void EarClipper::update_ear(std::size_t i) {
    if (is_ear(i))
        ears_.insert(i);
    else
        ears_.remove(i);
}

void EarClipper::find_ears(std::size_t start) {
    std::size_t i = start;
    do {
        update_ear(i);
        i = next_[i];
    } while (i != start);
}

std::size_t EarClipper::sharpest_from(std::size_t start) const {
    std::size_t best = start, i = start;
    for (std::size_t compared = 0; compared < most_compared; ++compared) {
        i = next_[i];
        if (i == start)
            break;
        if (turn_at(i) > turn_at(best))
            best = i;
    }
    return best;
}

}
