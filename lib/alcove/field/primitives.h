/// Exact signed distances of simple shapes (Quilez 2008).
#pragma once

#include "alcove/base/types.h"

#include "alcove/field/field.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <tuple>
#include <vector>

namespace alcove {

/// The half-space below the plane {p : normal · p = offset}.
struct Plane {
    Vec3 normal{0.0f, 1.0f, 0.0f}; ///< unit length
    float offset = 0.0f;

    float map(const Vec3& p) const { return glm::dot(p, normal) - offset; }
};

struct Sphere {
    Vec3 center{0.0f};
    float radius = 1.0f;

    float map(const Vec3& p) const { return glm::length(p - center) - radius; }
};

/// An axis-aligned solid box.
struct Cuboid {
    Vec3 center{0.0f};
    Vec3 half_extent{1.0f};

    float map(const Vec3& p) const {
        const Vec3 q = glm::abs(p - center) - half_extent;
        return glm::length(glm::max(q, Vec3(0.0f))) + std::min(std::max(q.x, std::max(q.y, q.z)), 0.0f);
    }
};

/// A torus whose axis is parallel to the y axis.
struct Torus {
    Vec3 center{0.0f};
    float ring_radius = 1.0f;
    float tube_radius = 0.25f;

    float map(const Vec3& p) const {
        const Vec3 q = p - center;
        const float ring = std::sqrt(q.x * q.x + q.z * q.z) - ring_radius;
        return std::sqrt(ring * ring + q.y * q.y) - tube_radius;
    }
};

/// All points within `radius` of the segment from `start` to `end`.
struct Capsule {
    Vec3 start{0.0f};
    Vec3 end{0.0f, 1.0f, 0.0f};
    float radius = 0.5f;

    float map(const Vec3& p) const {
        const Vec3 axis = end - start;
        const float length2 = glm::dot(axis, axis);
        const float t = length2 > 0.0f ? std::clamp(glm::dot(p - start, axis) / length2, 0.0f, 1.0f) : 0.0f;
        return glm::length(p - start - t * axis) - radius;
    }
};

/// The number of points that batched combinations process at a time, small enough that the intermediate arrays stay in
/// the L1 cache.
inline constexpr std::size_t combine_block = 256;

/// Base class of unions. `Self` provides `for_each_part(visit)`, which calls `visit(part)` for each part.
///
/// If no part is two-sided, the result is the smallest distance. Otherwise it is the distance nearest to 0, where the
/// inside of the solid parts counts as 0. The reasons: the sign of a sheet says nothing about other parts, the depth
/// inside a solid must not hide a sheet within it, and rays must end in a solid as they would without the sheets.
template <class Self>
struct UnionBase {
    float map(const Vec3& p) const {
        const bool sheets = two_sided();
        float distance = any_reach;
        self().for_each_part([&](const auto& part) {
            distance = join(distance, static_cast<float>(part.map(p)), sheets && !alcove::two_sided(part), sheets);
        });
        return distance;
    }

    void map(const Points& points, float reach, float* distances) const {
        const bool sheets = two_sided();
        std::array<float, combine_block> other;
        for (std::size_t begin = 0; begin < points.count; begin += combine_block) {
            const Points block{points.x + begin, points.y + begin, points.z + begin,
                               std::min(combine_block, points.count - begin)};
            std::fill_n(distances + begin, block.count, any_reach);
            self().for_each_part([&](const auto& part) {
                map_batch(part, block, reach, other.data());
                const bool filled = sheets && !alcove::two_sided(part);
                for (std::size_t i = 0; i < block.count; ++i)
                    distances[begin + i] = join(distances[begin + i], other[i], filled, sheets);
            });
        }
    }

    float resolution() const {
        float coarsest = 0.0f;
        self().for_each_part([&](const auto& part) { coarsest = std::max(coarsest, alcove::resolution(part)); });
        return coarsest;
    }
    float extent() const {
        float furthest = 0.0f;
        self().for_each_part([&](const auto& part) { furthest = std::max(furthest, alcove::extent(part)); });
        return furthest;
    }
    bool two_sided() const {
        bool any = false;
        self().for_each_part([&](const auto& part) { any = any || alcove::two_sided(part); });
        return any;
    }

  private:
    const Self& self() const { return static_cast<const Self&>(*this); }

    static float join(float so_far, float part, bool filled, bool sheets) {
        if (!sheets)
            return std::min(so_far, part);
        const float d = filled ? std::max(part, 0.0f) : part;
        return std::fabs(d) < std::fabs(so_far) ? d : so_far;
    }
};

/// The union of parts of different types. Exact outside; a bound inside.
template <Field... Parts>
struct Union : UnionBase<Union<Parts...>> {
    std::tuple<Parts...> parts;

    explicit Union(Parts... fields) : parts(std::move(fields)...) {}

    template <class Visit>
    void for_each_part(const Visit& visit) const {
        std::apply([&](const auto&... part) { (visit(part), ...); }, parts);
    }
};

/// The union of any number of parts of one type. An empty union has no surface.
template <Field F>
struct UnionOf : UnionBase<UnionOf<F>> {
    std::vector<F> parts;

    explicit UnionOf(std::vector<F> fields) : parts(std::move(fields)) {}

    template <class Visit>
    void for_each_part(const Visit& visit) const {
        for (const F& part : parts)
            visit(part);
    }
};

/// A field transformed by p' = rotation · (scale · p) + translation. As the scale is uniform, distances remain
/// distances.
template <Field F>
struct Transformed {
    F field;
    glm::mat3 rotation{1.0f}; ///< orthonormal
    float scale = 1.0f;       ///< > 0
    Vec3 translation{0.0f};

    float map(const Vec3& p) const { return scale * field.map(to_local(p)); }

    void map(const Points& points, float reach, float* distances) const {
        std::array<float, combine_block> x, y, z;
        for (std::size_t begin = 0; begin < points.count; begin += combine_block) {
            const std::size_t count = std::min(combine_block, points.count - begin);
            for (std::size_t i = 0; i < count; ++i) {
                const Vec3 p = to_local(points[begin + i]);
                x[i] = p.x, y[i] = p.y, z[i] = p.z;
            }
            map_batch(field, Points{x.data(), y.data(), z.data(), count}, reach / scale, distances + begin);
            for (std::size_t i = 0; i < count; ++i)
                distances[begin + i] *= scale;
        }
    }

    float resolution() const { return scale * alcove::resolution(field); }
    float extent() const { return scale * alcove::extent(field) + glm::length(translation); }
    bool two_sided() const { return alcove::two_sided(field); }

  private:
    Vec3 to_local(const Vec3& p) const { return glm::transpose(rotation) * (p - translation) / scale; }
};

/// Converts a field from the unit space of one frame to that of another.
template <Field F>
Transformed<F> placed(F field, const Frame& from, const Frame& to) {
    return {std::move(field), glm::mat3(1.0f), static_cast<float>(from.diagonal / to.diagonal),
            Vec3((from.center - to.center) / to.diagonal)};
}

}
