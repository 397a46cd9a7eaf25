#include "alcove/render/camera_rays.h"

#include "alcove/occlusion/directions.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// A distance does not change faster than the way: where a field does, it jumps.
constexpr float steepest_slope = 1.3f;

/// Voxels that a ray may get below a surface without a jump.
constexpr float deepest_landing = 0.25f;

/// Voxels behind its faces where the distances of a sheet are smooth again.
constexpr float behind_sheet = 2.75f;

/// Where a ray is inside a box.
struct Span {
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();

    Span(const Vec3d& origin, const Vec3d& direction, const Vec3d& low, const Vec3d& high) {
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] == 0.0) {
                if (origin[axis] < low[axis] || origin[axis] > high[axis])
                    leave = -1.0;
                continue;
            }
            const double a = (low[axis] - origin[axis]) / direction[axis];
            const double b = (high[axis] - origin[axis]) / direction[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
    }
    bool empty() const { return !(enter < leave); }
};

Vec3 direction_of(const RayBatch& rays, std::size_t i) {
    return {rays.dx[i], rays.dy[i], rays.dz[i]};
}

/// The unit normal on the eye's side. One that points away is mirrored in the plane across the ray, which is
/// continuous at silhouettes, where smoothing makes it lean over.
Vec3 facing(const Vec3& gradient, const Vec3& direction) {
    const float length = glm::length(gradient);
    if (!(length > 0.0f) || !std::isfinite(length))
        return -direction;
    const Vec3 normal = gradient / length;
    const float away = glm::dot(normal, direction);
    return away > 0.0f ? glm::normalize(normal - 2.0f * away * direction) : normal;
}

}

RayPrecision::RayPrecision(float resolution)
    : voxel(resolution), hit_distance(std::max(0.02f * resolution, 1e-5f)),
      shortest_step(std::max(0.1f * resolution, 1e-5f)), difference(std::max(0.75f * resolution, 2e-4f)),
      slack(2.5f * resolution + 1e-4f) {}

CameraRays::CameraRays(const Subject& subject, const Camera& camera, int samples)
    : field_(subject.field), camera_(camera), frame_(subject.frame), precision_(resolution(subject.field)),
      samples_(samples), sheet_(subject.sheet) {
    eye_ = (camera.eye() - frame_.center) / frame_.diagonal;
    low_ = (subject.box.min - frame_.center) / frame_.diagonal - Vec3d(precision_.slack);
    high_ = (subject.box.max - frame_.center) / frame_.diagonal + Vec3d(precision_.slack);
    far_ = static_cast<float>(1.01 * glm::length(high_ - low_));
}

Vec3d CameraRays::direction(std::size_t sample) const {
    const auto samples = static_cast<std::size_t>(samples_);
    const auto width = static_cast<std::size_t>(camera_.size().width);
    const std::size_t pixel = sample / samples;
    const Vec2 within = fibonacci_point(static_cast<int>(sample % samples), samples_, 0.0f, 0.5f);
    return camera_.direction(static_cast<double>(pixel % width) + within.x,
                             static_cast<double>(pixel / width) + within.y);
}

void CameraRays::trace(std::size_t begin, std::size_t end, std::size_t at, Hits& hits) const {
    Batch rays;
    for (std::size_t sample = begin; sample < end; ++sample, ++at) {
        hits.surfels[at] = {Vec3(0.0f), Vec3(0.0f)};
        const Vec3d ray = direction(sample);
        const Span span(eye_, ray, low_, high_);
        if (!span.empty()) {
            // All rays of a batch end at the same length, so each begins where that makes it leave the box.
            // Counting from there, not from the eye, keeps single precision enough for any eye.
            const double before = span.leave - far_;
            rays.before[rays.count] = before;
            rays.owner[rays.count] = at;
            rays.push_back({Vec3(eye_ + before * ray), Vec3(ray)}, static_cast<float>(span.enter - before));
        }
        if (rays.count == RayBatch::capacity || (sample + 1 == end && rays.count > 0)) {
            meet(rays, hits);
            rays.count = 0;
        }
    }
}

CameraRays::Places CameraRays::places(const Batch& rays, const Selection& which, const Values& travelled) {
    Places places;
    for (std::size_t k = 0; k < which.count; ++k) {
        const std::size_t i = which.ray[k];
        places.x[k] = rays.x[i] + travelled[i] * rays.dx[i];
        places.y[k] = rays.y[i] + travelled[i] * rays.dy[i];
        places.z[k] = rays.z[i] + travelled[i] * rays.dz[i];
    }
    return places;
}

void CameraRays::set(const Batch& rays, std::size_t i, const Surfel& surfel, Hits& hits) const {
    hits.surfels[rays.owner[i]] = surfel;
    const double length = (rays.before[i] + static_cast<double>(rays.travelled[i])) * frame_.diagonal;
    hits.depths[rays.owner[i]] =
        static_cast<float>(length * glm::dot(Vec3d(direction_of(rays, i)), camera_.forward()));
}

void CameraRays::meet(Batch& rays, Hits& hits) const {
    const Values start = rays.travelled;
    alcove::trace(
        field_, rays,
        {.far = far_, .hit_distance = precision_.hit_distance, .shortest_step = precision_.shortest_step});
    Selection hit;
    for (std::size_t i = 0; i < rays.count; ++i)
        if (rays.hit[i])
            hit.add(i);

    const Values landed = rays.travelled;
    std::array<bool, RayBatch::capacity> too_deep{};
    constexpr int refinements = 3;
    for (int round = 0; round < refinements; ++round) {
        Values distance;
        map_batch(field_, places(rays, hit, rays.travelled).points(hit.count), any_reach, distance.data());
        for (std::size_t k = 0; k < hit.count; ++k) {
            const std::size_t i = hit.ray[k];
            too_deep[i] = too_deep[i] || distance[k] < -deepest_landing * precision_.voxel;
            rays.travelled[i] = std::max(rays.travelled[i] + distance[k], start[i]);
        }
    }

    const Places met = places(rays, hit, rays.travelled);
    std::array<Vec3, RayBatch::capacity> gradient;
    differences(met.points(hit.count), gradient.data());
    Selection back;
    for (std::size_t k = 0; k < hit.count; ++k) {
        const std::size_t i = hit.ray[k];
        const Vec3 direction = direction_of(rays, i);
        set(rays, i, {met.points(hit.count)[k], facing(gradient[k], direction)}, hits);
        if (too_deep[i] || glm::dot(gradient[k], direction) > 0.0f ||
            glm::length(gradient[k]) > steepest_slope * 2.0f * precision_.difference)
            back.add(i);
    }
    if (sheet_ && back.count > 0)
        go_through(rays, back, landed, hits);
}

/// A sheet is solid in a thin layer behind its faces. From behind, a ray falls into that layer where
/// distances jump, along the steps of the voxels; the face is where it comes out again. The occlusion there
/// is that of a point behind the layer. Rays that meet no jump stay as they are.
void CameraRays::go_through(Batch& rays, const Selection& back, Values travelled, Hits& hits) const {
    const float stride = 0.25f * precision_.voxel;
    constexpr int rounds_before = 32, rounds = 72;
    for (std::size_t k = 0; k < back.count; ++k)
        travelled[back.ray[k]] -= rounds_before * stride;
    Values distance, last;
    last.fill(-1.0f);
    std::array<bool, RayBatch::capacity> jumped{}, within{};
    for (int round = 0; round < rounds; ++round) {
        map_batch(field_, places(rays, back, travelled).points(back.count), any_reach, distance.data());
        for (std::size_t k = 0; k < back.count; ++k) {
            // Further out, distances change a little where a finer level takes over.
            jumped[k] = jumped[k] || (last[k] < behind_sheet * precision_.voxel &&
                                      last[k] - distance[k] > steepest_slope * stride);
            within[k] = within[k] || (jumped[k] && distance[k] < -stride);
            travelled[back.ray[k]] += within[k] ? -distance[k] : stride;
            last[k] = distance[k];
        }
    }

    // The layer is too thin for differences within it: those in front of the face tell the same.
    Values in_front = travelled;
    for (std::size_t k = 0; k < back.count; ++k)
        in_front[back.ray[k]] += precision_.voxel;
    const Places clear = places(rays, back, in_front);
    map_batch(field_, clear.points(back.count), any_reach, distance.data());
    std::array<Vec3, RayBatch::capacity> gradient;
    differences(clear.points(back.count), gradient.data());
    const Places faces = places(rays, back, travelled);
    for (std::size_t k = 0; k < back.count; ++k) {
        const std::size_t i = back.ray[k];
        // At its rim a layer is left by another jump.
        const bool by_jump = distance[k] > steepest_slope * precision_.voxel;
        if (!within[k] || by_jump || std::fabs(last[k]) > stride ||
            glm::dot(gradient[k], direction_of(rays, i)) <= 0.0f)
            continue;
        rays.travelled[i] = travelled[i];
        const Vec3 normal = facing(-gradient[k], direction_of(rays, i));
        set(rays, i, {faces.points(back.count)[k] + behind_sheet * precision_.voxel * normal, normal}, hits);
    }
}

/// Differences of the field along the axes, around points on the surface.
void CameraRays::differences(const Points& points, Vec3* gradient) const {
    const float h = precision_.difference;
    Values shifted, above, below;
    const float* const all[3] = {points.x, points.y, points.z};
    for (int axis = 0; axis < 3; ++axis) {
        const auto probe = [&](float shift, float* values) {
            for (std::size_t k = 0; k < points.count; ++k)
                shifted[k] = all[axis][k] + shift;
            const float* moved[3] = {all[0], all[1], all[2]};
            moved[axis] = shifted.data();
            map_batch(field_, Points{moved[0], moved[1], moved[2], points.count}, 2.0f * h, values);
        };
        probe(h, above.data());
        probe(-h, below.data());
        for (std::size_t k = 0; k < points.count; ++k)
            gradient[k][axis] = above[k] - below[k];
    }
}

}
