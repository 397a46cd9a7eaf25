/// A field that counts its map() calls.
#pragma once

#include "alcove/field/level_stack.h"

#include <atomic>
#include <memory>

namespace alcove {

/// Copies share the count. Thread-safe.
class CountingField {
  public:
    explicit CountingField(const LevelStack& field) : field_(field) {}

    float map(const Vec3& p) const {
        ++*calls_;
        return field_.map(p);
    }
    void map(const Points& points, float reach, float* distances) const {
        *calls_ += points.count;
        field_.map(points, reach, distances);
    }
    float resolution() const { return field_.resolution(); }
    float extent() const { return field_.extent(); }
    bool two_sided() const { return field_.two_sided(); }
    std::size_t calls() const { return *calls_; }

  private:
    LevelStack field_;
    std::shared_ptr<std::atomic<std::size_t>> calls_ = std::make_shared<std::atomic<std::size_t>>(0);
};

}
