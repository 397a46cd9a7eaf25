#include "alcove/render/detail/screen_space.h"

#include "alcove/base/parallel.h"
#include "alcove/occlusion/detail/directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alcove {
namespace {

/// Computes the visibility of one pixel.
class Kernel {
  public:
    Kernel(const ScreenSpace& method, const DepthBuffer& seen, double radius)
        : seen_(seen), lattice_(method.samples), samples_(method.samples), radius_(radius),
          min_cosine_(std::sin(method.bias * std::numbers::pi_v<float> / 180.0f)) {}

    float operator()(std::size_t pixel) const {
        const Vec3d p = seen_.from_eye(pixel);
        const Basis basis(seen_.normal[pixel]);
        const std::uint32_t random = hash(static_cast<std::uint32_t>(pixel));
        const CosineLattice::Shift turn(random);
        int open = 0, counted = 0;
        for (int i = 0; i < samples_; ++i) {
            const Vec3 direction = lattice_.direction(i, turn);
            if (direction.z <= min_cosine_)
                continue;
            ++counted;
            const float jitter = unit_interval(hash(random + static_cast<std::uint32_t>(i)));
            const double length = radius_ * std::sqrt(1.0 - double(jitter));
            open += !hidden(p + length * Vec3d(basis.to_world(direction)));
        }
        return counted > 0 ? static_cast<float>(open) / static_cast<float>(counted) : 1.0f;
    }

  private:
    /// Whether q is hidden by a surface that is nearer to the eye, but by less than the radius.
    bool hidden(const Vec3d& q) const {
        const Vec3d place = seen_.camera.project(seen_.camera.eye() + q);
        if (!(place.z > 0.0 && place.x >= 0.0 && place.y >= 0.0 && place.x < static_cast<double>(seen_.width()) &&
              place.y < static_cast<double>(seen_.height())))
            return false;
        const auto pixel = static_cast<std::size_t>(place.y) * seen_.width() + static_cast<std::size_t>(place.x);
        if (!seen_.seen(pixel))
            return false;
        const double in_front = place.z - depth_at(pixel, q, place.z);
        return in_front > 1e-4 * radius_ && in_front < radius_;
    }

    /// Depth of the visible surface on the line from the eye to q: on the tangent plane at the centre of the pixel, or
    /// the stored depth if that plane is seen edge-on.
    double depth_at(std::size_t pixel, const Vec3d& q, double depth_of_q) const {
        const Vec3d normal(seen_.normal[pixel]);
        const double stored = double(seen_.depth[pixel]), facing = glm::dot(normal, q);
        if (!(facing < -0.05 * glm::length(q)))
            return stored;
        return depth_of_q * glm::dot(normal, seen_.from_eye(pixel)) / facing;
    }

    const DepthBuffer& seen_;
    CosineLattice lattice_;
    int samples_;
    double radius_;
    float min_cosine_;
};

/// One pass of a separable blur, along rows or columns.
class Smoother {
  public:
    Smoother(const ScreenSpace& method, const DepthBuffer& seen, double radius)
        : seen_(seen), bilateral_(static_cast<Blur>(method.blur) == Blur::bilateral),
          // A point farther than a tenth of the radius from the tangent plane is probably on another surface.
          height_(0.1f * static_cast<float>(radius)),
          reach_(method.blur_reach *
                 static_cast<float>(radius * static_cast<double>(seen.width()) / seen.camera.screen_window_width())),
          places_(seen.depth.size()) {
        for (std::size_t pixel = 0; pixel < places_.size(); ++pixel)
            if (seen.seen(pixel))
                places_[pixel] = Vec3(seen.from_eye(pixel));
    }

    std::vector<float> operator()(const std::vector<float>& ao, bool along_rows) const {
        const auto length = static_cast<int>(along_rows ? seen_.width() : seen_.height());
        const std::size_t step = along_rows ? 1 : seen_.width();
        std::vector<float> result(ao.size(), 1.0f);
        parallel_for(ao.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t pixel = begin; pixel < end; ++pixel) {
                if (!seen_.seen(pixel))
                    continue;
                const auto at = static_cast<int>(along_rows ? pixel % seen_.width() : pixel / seen_.width());
                const float exact_reach = std::clamp(reach_ / seen_.depth[pixel], 1.0f, 64.0f);
                const int reach = static_cast<int>(exact_reach);
                float sum = 0.0f, total = 0.0f;
                for (int k = std::max(-reach, -at); k <= std::min(reach, length - 1 - at); ++k) {
                    const std::size_t other =
                        pixel + static_cast<std::size_t>(k) * step; // unsigned wrap-around for k < 0
                    if (!seen_.seen(other))
                        continue;
                    const float weight = weight_of(2.0f * static_cast<float>(k) / exact_reach, pixel, other);
                    sum += weight * ao[other];
                    total += weight;
                }
                result[pixel] = sum / total; // the pixel itself has a weight of 1
            }
        });
        return result;
    }

  private:
    /// `away` is the distance between the pixels in standard deviations; the reach is two standard deviations.
    float weight_of(float away, std::size_t pixel, std::size_t other) const {
        if (!bilateral_)
            return std::exp(-0.5f * away * away);
        const Vec3& n = seen_.normal[pixel];
        const float above = glm::dot(n, places_[other] - places_[pixel]) / height_;
        const float cosine = std::max(0.0f, glm::dot(n, seen_.normal[other]));
        return std::exp(-0.5f * (away * away + above * above)) * cosine * cosine * cosine * cosine;
    }

    const DepthBuffer& seen_;
    bool bilateral_;
    float height_;             // τ, scene units
    float reach_;              // pixels at depth 1
    std::vector<Vec3> places_; // relative to the eye, scene units
};

}

std::vector<float> ScreenSpace::operator()(const DepthBuffer& seen, double scene_radius) const {
    std::vector<float> ao(seen.depth.size(), 1.0f);
    const Kernel kernel(*this, seen, scene_radius);
    parallel_for(ao.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel)
            if (seen.seen(pixel))
                ao[pixel] = kernel(pixel);
    });
    if (static_cast<Blur>(blur) == Blur::none)
        return ao;
    const Smoother smooth(*this, seen, scene_radius);
    for (const bool along_rows : {true, false})
        ao = smooth(ao, along_rows);
    return ao;
}

std::vector<float> ScreenSpace::operator()(const Renderable& renderable, const Camera& camera) const {
    // The visible surface says little about occluders further away than the size of the scene.
    return (*this)(look(renderable, camera), std::min(double(radius), 1.0) * renderable.frame.diagonal);
}

}
