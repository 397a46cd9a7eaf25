/// Fields made of fields: union and placement. Cost: one map() of every part.
#pragma once

#include "alcove/field/field.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <tuple>

namespace alcove {

/// Points worked on at a time by batched combinations: small enough for their copies to stay in the L1 cache.
inline constexpr std::size_t combine_block = 256;

/// The union of all parts: the nearest of them. Exact outside; inside a bound.
template <Field... Parts>
struct Union {
    std::tuple<Parts...> parts;

    explicit Union(Parts... fields) : parts(std::move(fields)...) {}

    float map(const Vec3& p) const {
        return std::apply([&](const auto&... part) { return std::min({static_cast<float>(part.map(p))...}); },
                          parts);
    }

    void map(const Points& points, float reach, float* distances) const {
        std::array<float, combine_block> other;
        for (std::size_t begin = 0; begin < points.count; begin += combine_block) {
            const Points block{points.x + begin, points.y + begin, points.z + begin,
                               std::min(combine_block, points.count - begin)};
            std::fill_n(distances + begin, block.count, any_reach);
            const auto join = [&](const auto& part) {
                map_batch(part, block, reach, other.data());
                for (std::size_t i = 0; i < block.count; ++i)
                    distances[begin + i] = std::min(distances[begin + i], other[i]);
            };
            std::apply([&](const auto&... part) { (join(part), ...); }, parts);
        }
    }

    float resolution() const {
        return std::apply([](const auto&... part) { return std::max({alcove::resolution(part)...}); }, parts);
    }
    bool two_sided() const {
        return std::apply([](const auto&... part) { return (alcove::two_sided(part) || ...); }, parts);
    }
};

/// A field placed by p' = rotation · (scale · p) + translation. Uniform scale keeps distances distances.
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
    bool two_sided() const { return alcove::two_sided(field); }

  private:
    Vec3 to_local(const Vec3& p) const { return glm::transpose(rotation) * (p - translation) / scale; }
};

}
