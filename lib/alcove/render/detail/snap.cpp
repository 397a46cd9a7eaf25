#include "alcove/render/detail/snap.h"

#include "alcove/occlusion/detail/directions.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// Interpolates a vertex value at a hit.
template <class T>
T interpolated(const std::vector<T>& values, const SurfaceHit& hit) {
    T sum = hit.weights[0] * values[hit.vertices[0]];
    for (int corner = 1; corner < 3; ++corner)
        sum += hit.weights[corner] * values[hit.vertices[static_cast<std::size_t>(corner)]];
    return sum;
}

class Snapper {
  public:
    Snapper(const Renderable& renderable, const Camera& camera, Hits& hits)
        : renderable_(renderable), camera_(camera), hits_(hits),
          eye_((camera.eye() - renderable.frame.center) / renderable.frame.diagonal) {
        const auto reach_of = [](const AnyField& field) { return std::max(3.0f * resolution(field), 1e-3f); };
        if (renderable.parts.empty())
            reaches_.push_back(reach_of(renderable.field));
        for (const Part& part : renderable.parts)
            reaches_.push_back(reach_of(part.field));
    }

    void add(std::size_t sample) {
        const Vec3 direction(glm::normalize(Vec3d(hits_.surfels[sample].position) - eye_));
        owner_[rays_.count] = sample;
        rays_.push_back({hits_.surfels[sample].position - reach(sample) * direction, direction}, 0.0f);
        if (rays_.count == RayBatch::capacity)
            flush();
    }

    void flush() {
        // The first triangle may belong to another object that crosses this one.
        constexpr int attempts = 4;
        for (int attempt = 0; attempt < attempts && rays_.count > 0; ++attempt) {
            float far = 0.0f;
            for (std::size_t i = 0; i < rays_.count; ++i)
                far = std::max(far, 2.0f * reach(owner_[i]));
            renderable_.mesh->surface.find_nearest(rays_, far, places_);
            RayBatch left;
            for (std::size_t i = 0; i < rays_.count; ++i) {
                if (!rays_.hit[i] || rays_.travelled[i] > 2.0f * reach(owner_[i])) {
                    missed_.push_back(owner_[i]);
                    continue;
                }
                if (renderable_.mesh->objects[places_[i].vertices[0]] == hits_.objects[owner_[i]]) {
                    move(owner_[i], i);
                    continue;
                }
                owner_[left.count] = owner_[i];
                left.push_back({{rays_.x[i], rays_.y[i], rays_.z[i]}, {rays_.dx[i], rays_.dy[i], rays_.dz[i]}},
                               rays_.travelled[i] + 1e-5f);
            }
            rays_ = left;
        }
        missed_.insert(missed_.end(), owner_.begin(), owner_.begin() + static_cast<std::ptrdiff_t>(rays_.count));
        rays_.count = 0;
        if (!hits_.colors.empty())
            for (const std::size_t sample : missed_)
                take_nearest_color(sample);
        missed_.clear();
    }

  private:
    float reach(std::size_t sample) const { return reaches_[hits_.objects[sample] - 1u]; }

    void move(std::size_t sample, std::size_t i) {
        Surfel& surfel = hits_.surfels[sample];
        const Vec3 direction(rays_.dx[i], rays_.dy[i], rays_.dz[i]);
        const float further = rays_.travelled[i] - reach(sample);
        surfel.position += further * direction;
        hits_.depths[sample] += static_cast<float>(double(further) * renderable_.frame.diagonal *
                                                   glm::dot(Vec3d(direction), camera_.forward()));
        const Vec3 normal = interpolated(renderable_.mesh->normals, places_[i]);
        if (const float length = glm::length(normal); length > 1e-6f) {
            const float away = glm::dot(normal, direction);
            // Mirrored if it tilts away at a silhouette, negated if the back is seen.
            const bool back = glm::dot(places_[i].normal, normal) * glm::dot(places_[i].normal, direction) > 0.0f;
            const Vec3 toward = back ? -normal : away > 0.0f ? normal - 2.0f * away * direction : normal;
            surfel.normal = toward / length;
        }
        hits_.faces[sample] = places_[i].vertices;
        if (!hits_.colors.empty())
            hits_.colors[sample] = interpolated(renderable_.mesh->colors, places_[i]);
    }

    /// Takes the colour from the nearest triangle around the sample. At some outlines, rays meet the field but no
    /// triangle.
    void take_nearest_color(std::size_t sample) {
        RayBatch around;
        for (int i = 0; i < static_cast<int>(RayBatch::capacity); ++i) {
            const Vec2 point = fibonacci_point(i, RayBatch::capacity, 0.0f, 0.0f);
            const Vec3 up = uniform_hemisphere(std::fabs(2.0f * point.x - 1.0f), point.y);
            around.push_back({hits_.surfels[sample].position, point.x < 0.5f ? -up : up}, 0.0f);
        }
        float nearest = 2.0f * reach(sample);
        renderable_.mesh->surface.find_nearest(around, nearest, places_);
        for (std::size_t i = 0; i < around.count; ++i)
            if (around.hit[i] && around.travelled[i] < nearest &&
                renderable_.mesh->objects[places_[i].vertices[0]] == hits_.objects[sample]) {
                nearest = around.travelled[i];
                hits_.colors[sample] = interpolated(renderable_.mesh->colors, places_[i]);
            }
    }

    const Renderable& renderable_;
    const Camera& camera_;
    Hits& hits_;
    Vec3d eye_;
    std::vector<float> reaches_; // by part: how far its triangles may be from its field
    RayBatch rays_;
    std::array<std::size_t, RayBatch::capacity> owner_;
    std::array<SurfaceHit, RayBatch::capacity> places_;
    std::vector<std::size_t> missed_; // samples of the batch without a triangle
};

}

void snap(const Renderable& renderable, const Camera& camera, std::size_t begin, std::size_t end, Hits& hits) {
    Snapper snapper(renderable, camera, hits);
    for (std::size_t sample = begin; sample < end; ++sample) {
        if (!hits.colors.empty())
            hits.colors[sample] = Vec3(1.0f);
        if (hits.objects[sample] != no_object && ground_of(renderable, hits.objects[sample]) == nullptr)
            snapper.add(sample);
    }
    snapper.flush();
}

}
