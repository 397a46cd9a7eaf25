/// A field is anything with `map(p)`, the signed distance from p to the surface.
///
/// Distances and points share one unit (unit space for fields of meshes, see types.h). Where a field does not know the
/// true distance, it may return less (a *bound*). The result must never exceed the true distance by more than the
/// resolution of the field: tracing and estimators rely on this. `const` use is safe from any number of threads.
#pragma once

#include "alcove/base/types.h"

#include <concepts>
#include <cstddef>
#include <limits>
#include <memory>

namespace alcove {

/// A view of points as three arrays, suited to SIMD.
struct Points {
    const float* x;
    const float* y;
    const float* z;
    std::size_t count;

    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

inline constexpr float any_reach = std::numeric_limits<float>::infinity();

template <class F>
concept Field = requires(const F& field, Vec3 p) {
    { field.map(p) } -> std::convertible_to<float>;
};

/// A field with a batched form. `reach` is an upper bound on the distances that the caller needs, such as the height of
/// a probe above the surface. The field may use data that is correct only up to that distance.
template <class F>
concept BatchedField = Field<F> && requires(const F& field, Points points, float reach, float* distances) {
    field.map(points, reach, distances);
};

/// distances[i] = field.map(points[i]), with the batched form if there is one. Cost: `count` map() calls.
template <Field F>
void map_batch(const F& field, const Points& points, float reach, float* distances) {
    if constexpr (BatchedField<F>) {
        field.map(points, reach, distances);
    } else {
        for (std::size_t i = 0; i < points.count; ++i)
            distances[i] = field.map(points[i]);
    }
}

/// The length below which a field is not reliable: the finest voxel of a grid, 0 for analytic shapes.
template <Field F>
float resolution(const F& field) {
    if constexpr (requires {
                      { field.resolution() } -> std::convertible_to<float>;
                  })
        return field.resolution();
    else
        return 0.0f;
}

/// An upper bound on the distance of the surface from the origin: a ray that starts on the surface hits the surface
/// again within twice this length, or never. Infinite for fields without such a bound.
template <Field F>
float extent(const F& field) {
    if constexpr (requires {
                      { field.extent() } -> std::convertible_to<float>;
                  })
        return field.extent();
    else
        return std::numeric_limits<float>::infinity();
}

/// Whether both sides of the surface count as outside, with negative values only in a thin layer along the surface
/// (Sign::sheet).
template <Field F>
bool two_sided(const F& field) {
    if constexpr (requires {
                      { field.two_sided() } -> std::convertible_to<bool>;
                  })
        return field.two_sided();
    else
        return false;
}

/// A type-erased field, for choices made at run time. Costs one virtual call per batch, not per point. Owns a copy of a
/// field, which the copies of an AnyField share. Models BatchedField.
class AnyField {
  public:
    template <class F>
    requires(!std::same_as<F, AnyField> && Field<F>) AnyField(F field)
        : self_(std::make_shared<const Holder<F>>(std::move(field))) {}

    float map(const Vec3& p) const { return self_->map_point(p); }
    void map(const Points& points, float reach, float* distances) const { self_->map_points(points, reach, distances); }
    float resolution() const { return self_->finest(); }
    float extent() const { return self_->furthest(); }
    bool two_sided() const { return self_->both_sides(); }

  private:
    struct Interface {
        virtual ~Interface() = default;
        virtual float map_point(const Vec3& p) const = 0;
        virtual void map_points(const Points& points, float reach, float* distances) const = 0;
        virtual float finest() const = 0;
        virtual float furthest() const = 0;
        virtual bool both_sides() const = 0;
    };

    template <class F>
    struct Holder final : Interface {
        explicit Holder(F f) : field(std::move(f)) {}
        float map_point(const Vec3& p) const override { return field.map(p); }
        void map_points(const Points& points, float reach, float* distances) const override {
            map_batch(field, points, reach, distances);
        }
        float finest() const override { return alcove::resolution(field); }
        float furthest() const override { return alcove::extent(field); }
        bool both_sides() const override { return alcove::two_sided(field); }
        F field;
    };

    std::shared_ptr<const Interface> self_;
};

}
