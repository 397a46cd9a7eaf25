/// Union and difference of solids with optionally rounded seams. Cost: one map() call per part.
///
/// The results are bounds, with and without rounding: they have Lipschitz constant 1 and never exceed the distance
/// to the surface that they describe. This requires that the distances of every part are correct within the blend
/// width outside its surface and, for a difference, inside it too.
#pragma once

#include "alcove/field/primitives.h"

#include <cassert>

namespace alcove {

/// The quadratic smooth minimum of two distances (Quilez 2013). It fills the seam where the distances differ by less
/// than `width`. Where they are equal, it lowers them by a quarter of `width`; at a right-angled edge, the filling
/// begins `width` away from the edge.
inline float smooth_min(float a, float b, float width) {
    const float overlap = width - std::fabs(a - b);
    return std::min(a, b) - (overlap > 0.0f ? overlap * overlap / (4.0f * width) : 0.0f);
}

/// Base class that combines the parts from first to last by `Self::join(so_far, part)`.
template <class Self, Field F>
struct Folded {
    std::vector<F> parts;     ///< at least one; all solids, that is, not two_sided()
    float blend_width = 0.0f; ///< width of the seams, ≥ 0

    Folded(std::vector<F> fields, float width) : parts(std::move(fields)), blend_width(width) {
        assert(!parts.empty() && width >= 0.0f);
    }

    float map(const Vec3& p) const {
        float distance = parts.front().map(p);
        for (std::size_t part = 1; part < parts.size(); ++part)
            distance = self().join(distance, parts[part].map(p));
        return distance;
    }

    void map(const Points& points, float reach, float* distances) const {
        std::array<float, combine_block> other;
        for (std::size_t begin = 0; begin < points.count; begin += combine_block) {
            const Points block{points.x + begin, points.y + begin, points.z + begin,
                               std::min(combine_block, points.count - begin)};
            map_batch(parts.front(), block, reach + blend_width, distances + begin);
            for (std::size_t part = 1; part < parts.size(); ++part) {
                map_batch(parts[part], block, reach + blend_width, other.data());
                for (std::size_t i = 0; i < block.count; ++i)
                    distances[begin + i] = self().join(distances[begin + i], other[i]);
            }
        }
    }

    float resolution() const {
        float coarsest = 0.0f;
        for (const F& part : parts)
            coarsest = std::max(coarsest, alcove::resolution(part));
        return coarsest;
    }

  private:
    const Self& self() const { return static_cast<const Self&>(*this); }
};

/// The points in any of the parts.
template <Field F>
struct BlendedUnion : Folded<BlendedUnion<F>, F> {
    using Folded<BlendedUnion, F>::Folded;

    float join(float so_far, float part) const { return smooth_min(so_far, part, this->blend_width); }
    float extent() const {
        float furthest = 0.0f;
        for (const F& part : this->parts)
            furthest = std::max(furthest, alcove::extent(part));
        return furthest + this->blend_width;
    }
};

/// The points in the first part and in none of the others.
template <Field F>
struct Difference : Folded<Difference<F>, F> {
    using Folded<Difference, F>::Folded;

    float join(float so_far, float part) const { return -smooth_min(-so_far, part, this->blend_width); }
    float extent() const { return alcove::extent(this->parts.front()); }
};

}
