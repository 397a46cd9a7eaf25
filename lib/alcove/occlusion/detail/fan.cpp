#include "alcove/occlusion/detail/fan.h"

#include "alcove/occlusion/detail/triangle_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace alcove {
namespace {

constexpr std::uint32_t largest_leaf = 4;

/// A half-space, dot(normal, x) >= 0; meets() tells whether any point of a box lies in it.
struct HalfSpace {
    Vec3d normal, size;

    explicit HalfSpace(const Vec3d& n) : normal(n), size(glm::abs(n)) {}
    bool meets(const Vec3d& center, const Vec3d& half) const {
        return glm::dot(normal, center) + glm::dot(size, half) >= 0.0;
    }
};

bool has_area(std::span<const Vec3> positions, const Triangle& t) {
    const Vec3d origin(positions[t[0]]), a = Vec3d(positions[t[1]]) - origin, b = Vec3d(positions[t[2]]) - origin;
    return glm::cross(a, b) != Vec3d(0.0);
}

}

/// The directions from the hub to the points of a ray. They lie in one plane, between the directions to the two ends.
struct Fan::Search {
    HalfSpace above, below, after_begin, before_end;

    static Search of(const RaySegment& ray) {
        const Vec3d begin = ray.origin + ray.near * ray.direction;
        const Vec3d end = std::isfinite(ray.far) ? ray.origin + ray.far * ray.direction : ray.direction;
        constexpr double smallest_sine = 1e-7; // below this, rounding errors dominate, so no direction is ruled out
        Vec3d across = glm::cross(begin, end);
        if (glm::length(across) <= smallest_sine * glm::length(begin) * glm::length(end))
            across = Vec3d(0.0);
        return {HalfSpace(across), HalfSpace(-across), HalfSpace(glm::cross(across, begin)),
                HalfSpace(glm::cross(end, across))};
    }
    bool meets(const Node& node) const {
        return above.meets(node.center, node.half) && below.meets(node.center, node.half) &&
               after_begin.meets(node.center, node.half) && before_end.meets(node.center, node.half);
    }
};

Fan::Fan(std::span<const Vec3> positions, std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
    hub_ = Vec3d(positions[triangles_.front()[0]]);
    std::vector<Arc> directions;
    directions.reserve(triangles_.size());
    for (const Triangle& t : triangles_) {
        arcs_.push_back({Vec3d(positions[t[1]]) - hub_, Vec3d(positions[t[2]]) - hub_});
        const auto& [a, b] = arcs_.back();
        reach2_ = std::max({reach2_, glm::dot(a, a), glm::dot(b, b)});
        directions.push_back({a / glm::length(a), b / glm::length(b)});
    }
    std::vector<std::uint32_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0u);
    add_node(0, static_cast<std::uint32_t>(order.size()), order, directions);
    const auto sorted = [&](const auto& items) {
        auto result = items;
        std::transform(order.begin(), order.end(), result.begin(), [&](std::uint32_t i) { return items[i]; });
        return result;
    };
    triangles_ = sorted(triangles_);
    arcs_ = sorted(arcs_);
}

void Fan::add_node(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order,
                   std::span<const Arc> directions) {
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) {
        box.add(directions[order[i]].a);
        box.add(directions[order[i]].b);
    }
    constexpr double rounding = 1e-8;
    const std::size_t node = nodes_.size();
    const Vec3d size = box.max - box.min;
    nodes_.push_back({box.center(), 0.5 * size + rounding, begin, end});
    if (end - begin <= largest_leaf)
        return;
    const int widest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto place = [&](std::uint32_t i) { return directions[i].a[widest] + directions[i].b[widest]; };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(
        order.begin() + begin, order.begin() + middle, order.begin() + end,
        [&](std::uint32_t i, std::uint32_t j) { return place(i) != place(j) ? place(i) < place(j) : i < j; });
    add_node(begin, middle, order, directions);
    nodes_[node].second = static_cast<std::uint32_t>(nodes_.size());
    add_node(middle, end, order, directions);
}

std::optional<Fan::Hit> Fan::hit(std::uint32_t triangle, const RaySegment& from_hub) const {
    const auto& [a, b] = arcs_[triangle];
    const Vec3d normal = glm::cross(a, b);
    const double toward = glm::dot(normal, from_hub.direction);
    const double distance = -glm::dot(normal, from_hub.origin) / toward;
    if (!(distance >= from_hub.near && distance <= from_hub.far)) // also for NaN: parallel to the triangle
        return {};
    const Vec3d p = from_hub.origin + distance * from_hub.direction;
    const double area2 = glm::dot(normal, normal);
    const double u = glm::dot(glm::cross(p, b), normal) / area2, v = glm::dot(glm::cross(a, p), normal) / area2;
    if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0))
        return {};
    return Hit{triangle, distance, {1.0 - u - v, u, v}, normal};
}

std::optional<Fan::Hit> Fan::find(const RaySegment& ray, Wanted wanted) const {
    RaySegment from_hub = ray;
    from_hub.origin -= hub_;
    // The ray misses all triangles if it passes the hub farther away than the farthest corner.
    const double closest = std::clamp(-glm::dot(from_hub.origin, ray.direction), ray.near, ray.far);
    const Vec3d p = from_hub.origin + closest * ray.direction;
    std::optional<Hit> found;
    if (glm::dot(p, p) > reach2_)
        return found;
    const Search search = Search::of(from_hub);
    std::array<std::uint32_t, 64> waiting; // enough for the depth of a tree of 2^32 arcs
    std::size_t count = 0;
    for (waiting[count++] = 0; count > 0;) {
        const std::uint32_t at = waiting[--count];
        const Node& node = nodes_[at];
        if (!search.meets(node))
            continue;
        if (node.second != 0) {
            waiting[count++] = node.second;
            waiting[count++] = at + 1;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (const std::optional<Hit> next = hit(i, from_hub)) {
                found = next;
                if (wanted == Wanted::any)
                    return found;
                from_hub.far = next->distance;
            }
    }
    return found;
}

std::vector<Fan> fans_of(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                         std::vector<Triangle>& others) {
    std::vector<std::uint32_t> uses(positions.size(), 0);
    for (const Triangle& t : triangles)
        for (const std::uint32_t corner : t)
            ++uses[corner];
    if (std::all_of(uses.begin(), uses.end(), [](std::uint32_t count) { return count < smallest_fan; }))
        return {};
    std::map<std::uint32_t, std::vector<Triangle>> around;
    for (Triangle t : triangles) {
        const auto hub = std::max_element(t.begin(), t.end(), [&](auto a, auto b) { return uses[a] < uses[b]; });
        if (uses[*hub] < smallest_fan) {
            others.push_back(t);
        } else if (can_be_hit(positions, t) && has_area(positions, t)) {
            std::rotate(t.begin(), hub, t.end());
            around[t[0]].push_back(t);
        }
    }
    std::vector<Fan> fans;
    fans.reserve(around.size());
    for (auto& [hub, fan] : around)
        fans.emplace_back(positions, std::move(fan));
    return fans;
}

}
