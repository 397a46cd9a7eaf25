#include "alcove/render/renderer.h"

#include "alcove/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove {
namespace {

constexpr std::size_t capacity = 256;
constexpr int max_steps = 512;

/// Marches up to `capacity` shadow rays at once.
class ShadowRays {
  public:
    ShadowRays(const AnyField& field, const Vec3& toward_sun, const SoftShadow& shadow)
        : field_(field), toward_sun_(toward_sun), shadow_(shadow), both_sides_(two_sided(field)),
          shortest_(std::max(0.25f * resolution(field), 1e-4f)),
          begin_(std::max(shadow.begin, 2.0f * resolution(field))) {}

    void add(const Vec3& origin, float& light) {
        origin_[count_] = origin;
        travelled_[count_] = begin_;
        light_[count_] = &light;
        light = 1.0f;
        if (++count_ == capacity)
            march();
    }

    void march() {
        for (int step = 0; step < max_steps && count_ > 0; ++step) {
            for (std::size_t i = 0; i < count_; ++i) {
                const Vec3 p = origin_[i] + travelled_[i] * toward_sun_;
                x_[i] = p.x, y_[i] = p.y, z_[i] = p.z;
            }
            map_batch(field_, Points{x_.data(), y_.data(), z_.data(), count_}, any_reach, distance_.data());
            std::size_t left = 0;
            for (std::size_t i = 0; i < count_; ++i) {
                const float d = both_sides_ ? std::fabs(distance_[i]) : distance_[i];
                float& light = *light_[i];
                light = std::min(light, shadow_.sharpness * std::max(d, 0.0f) / travelled_[i]);
                constexpr float dark = 1e-3f; // invisible in an image
                if (light < dark)
                    light = 0.0f;
                const float travelled = travelled_[i] + std::max(d, shortest_);
                if (light == 0.0f || travelled > shadow_.end)
                    continue;
                origin_[left] = origin_[i];
                light_[left] = light_[i];
                travelled_[left++] = travelled;
            }
            count_ = left;
        }
        count_ = 0;
    }

  private:
    const AnyField& field_;
    Vec3 toward_sun_;
    SoftShadow shadow_;
    bool both_sides_;
    float shortest_, begin_;
    std::array<Vec3, capacity> origin_;
    std::array<float, capacity> travelled_, x_, y_, z_, distance_;
    std::array<float*, capacity> light_;
    std::size_t count_ = 0;
};

}

std::vector<float> soft_shadows(std::span<const Surfel> surfels, const AnyField& field, const Vec3& toward_sun,
                                const SoftShadow& shadow) {
    std::vector<float> light(surfels.size(), 1.0f);
    parallel_for(surfels.size(), 16 * capacity, [&](std::size_t begin, std::size_t end) {
        ShadowRays rays(field, toward_sun, shadow);
        for (std::size_t i = begin; i < end; ++i) {
            if (!surfels[i].has_normal())
                continue;
            if (glm::dot(surfels[i].normal, toward_sun) > 0.0f)
                rays.add(surfels[i].position, light[i]);
            else
                light[i] = 0.0f;
        }
        rays.march();
    });
    return light;
}

}
