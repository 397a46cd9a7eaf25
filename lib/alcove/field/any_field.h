/// Any field behind one type, for choices made at run time. A virtual call a batch, not a point.
#pragma once

#include "alcove/field/field.h"

#include <memory>

namespace alcove {

/// Owns a copy of a field; copies of an AnyField share it. Models BatchedField.
class AnyField {
  public:
    template <class F>
    requires(!std::same_as<F, AnyField> && Field<F>) AnyField(F field)
        : self_(std::make_shared<const Holder<F>>(std::move(field))) {}

    float map(const Vec3& p) const { return self_->map_one(p); }
    void map(const Points& points, float reach, float* distances) const {
        self_->map_many(points, reach, distances);
    }
    float resolution() const { return self_->finest(); }
    float extent() const { return self_->furthest(); }
    bool two_sided() const { return self_->both_sides(); }

  private:
    struct Interface {
        virtual ~Interface() = default;
        virtual float map_one(const Vec3& p) const = 0;
        virtual void map_many(const Points& points, float reach, float* distances) const = 0;
        virtual float finest() const = 0;
        virtual float furthest() const = 0;
        virtual bool both_sides() const = 0;
    };

    template <class F>
    struct Holder final : Interface {
        explicit Holder(F f) : field(std::move(f)) {}
        float map_one(const Vec3& p) const override { return field.map(p); }
        void map_many(const Points& points, float reach, float* distances) const override {
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
