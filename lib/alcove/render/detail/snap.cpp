#include "alcove/render/detail/snap.h"

#include "alcove/render/detail/texture.h"

#include "alcove/occlusion/detail/directions.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    Snapper(const Renderable& renderable, const CameraRays& camera_rays, Hits& hits)
        : renderable_(renderable), camera_rays_(camera_rays), hits_(hits),
          eye_((camera_rays.camera().eye() - renderable.frame.center) / renderable.frame.diagonal) {
        const auto reach_of = [](const AnyField& field) { return std::max(3.0f * resolution(field), 1e-3f); };
        if (renderable.parts.empty())
            reaches_.push_back(reach_of(renderable.field));
        for (const Part& part : renderable.parts)
            reaches_.push_back(reach_of(part.field));
    }

    void add(std::size_t sample) {
        start(sample);
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
                    move(owner_[i], i, rays_.travelled[i] - reach(owner_[i]));
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
        for (const std::size_t sample : missed_)
            if (is_on_triangles(sample))
                start(sample);
            else if (!hits_.colors.empty())
                take_nearest_color(sample);
        look_further();
        missed_.clear();
    }

  private:
    /// Adds the ray of a sample; the ray starts in front of the hit.
    void start(std::size_t sample) {
        const Vec3 direction(glm::normalize(Vec3d(hits_.surfels[sample].position) - eye_));
        owner_[rays_.count] = sample;
        rays_.push_back({hits_.surfels[sample].position - reach(sample) * direction, direction}, 0.0f);
    }

    bool is_on_triangles(std::size_t sample) const {
        return !renderable_.parts.empty() && renderable_.parts[hits_.objects[sample] - 1u].on_triangles;
    }

    /// Sets each sample of the batch to the next triangle or ground on its ray, and empties the batch.
    void look_further() {
        renderable_.mesh->surface.find_nearest(rays_, std::numeric_limits<float>::infinity(), places_);
        for (std::size_t i = 0; i < rays_.count; ++i) {
            const std::size_t sample = owner_[i];
            const Vec3 direction(rays_.dx[i], rays_.dy[i], rays_.dz[i]), position = hits_.surfels[sample].position;
            const float depth = hits_.depths[sample], further = rays_.travelled[i] - reach(sample);
            camera_rays_.set_background(Vec3d(direction), sample, hits_);
            const ObjectId object = rays_.hit[i] ? renderable_.mesh->objects[places_[i].vertices[0]] : no_object;
            const bool is_behind_ground =
                hits_.objects[sample] != no_object && hits_.depths[sample] < depth + depth_of(further, direction);
            if (object == no_object || is_behind_ground)
                continue;
            const Vec3 normal = glm::normalize(places_[i].normal);
            hits_.objects[sample] = object;
            hits_.depths[sample] = depth;
            hits_.surfels[sample] = {position, glm::dot(normal, direction) > 0.0f ? -normal : normal};
            move(sample, i, further);
        }
        rays_.count = 0;
    }

    /// The depth, in scene units, that corresponds to a distance along a ray.
    float depth_of(float distance, const Vec3& direction) const {
        return static_cast<float>(double(distance) * renderable_.frame.diagonal *
                                  glm::dot(Vec3d(direction), camera_rays_.camera().forward()));
    }

    float reach(std::size_t sample) const { return reaches_[hits_.objects[sample] - 1u]; }

    /// Moves a sample further along its ray, to triangle i.
    void move(std::size_t sample, std::size_t i, float further) {
        Surfel& surfel = hits_.surfels[sample];
        const Vec3 direction(rays_.dx[i], rays_.dy[i], rays_.dz[i]);
        surfel.position += further * direction;
        hits_.depths[sample] += depth_of(further, direction);
        const Vec3 normal = interpolated(renderable_.mesh->normals, places_[i]);
        if (const float length = glm::length(normal); length > 1e-6f) {
            const float away = glm::dot(normal, direction);
            // The normal is mirrored if it tilts away at a silhouette, and negated if the back is seen.
            const bool back = glm::dot(places_[i].normal, normal) * glm::dot(places_[i].normal, direction) > 0.0f;
            const Vec3 toward = back ? -normal : away > 0.0f ? normal - 2.0f * away * direction : normal;
            surfel.normal = toward / length;
        }
        hits_.faces[sample] = places_[i].vertices;
        if (!hits_.colors.empty())
            hits_.colors[sample] = color_at(places_[i]);
    }

    Vec3 color_at(const SurfaceHit& place) const {
        const RenderableMesh& mesh = *renderable_.mesh;
        const Vec3 color = interpolated(mesh.colors, place);
        if (!mesh.texture)
            return color;
        const Vec2 uv = interpolated(mesh.uvs, place);
        return std::isfinite(uv.x) && std::isfinite(uv.y) ? mesh.texture->at(uv) : color;
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
                hits_.colors[sample] = color_at(places_[i]);
            }
    }

    const Renderable& renderable_;
    const CameraRays& camera_rays_;
    Hits& hits_;
    Vec3d eye_;
    std::vector<float> reaches_; // by part: how far its triangles may be from its field
    RayBatch rays_;
    std::array<std::size_t, RayBatch::capacity> owner_;
    std::array<SurfaceHit, RayBatch::capacity> places_;
    std::vector<std::size_t> missed_; // samples of the batch without a triangle
};

}

void snap(const Renderable& renderable, const CameraRays& camera_rays, std::size_t begin, std::size_t end, Hits& hits) {
    Snapper snapper(renderable, camera_rays, hits);
    for (std::size_t sample = begin; sample < end; ++sample) {
        if (!hits.colors.empty())
            hits.colors[sample] = Vec3(1.0f);
        if (hits.objects[sample] != no_object && ground_of(renderable, hits.objects[sample]) == nullptr)
            snapper.add(sample);
    }
    snapper.flush();
}

}
