#include "alcove/render/detail/camera_rays.h"

#include "alcove/occlusion/detail/directions.h"
#include "alcove/render/detail/creases.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// Distance, in voxels, from a hit to the probes that measure the local slope, and to the point where the ray
/// continues.
constexpr float nearness = 0.1f;

/// Over-relaxation of the steps: a tenth faster on planes seen at a grazing angle, a twentieth slower elsewhere.
constexpr float relaxation = 1.4f;

/// Apart from interpolation errors, a distance changes no faster than the position. A steeper change is a jump, and a
/// zero crossing inside it is not a surface.
constexpr float max_slope = 1.15f;

/// If the slope is below min_slope, or if the cosine between the gradients at a hit and a little in front of it is
/// below min_agreement, the hit is on a crease or inside a jump.
constexpr float min_slope = 0.8f, min_agreement = 0.97f;

/// Largest distance, in voxels, between the zero crossing inside a jump and the face in front of it.
constexpr float max_jump = 1.5f;

/// The part of a ray that is inside a box.
struct Span {
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();

    Span(const Vec3d& origin, const Vec3d& direction, const Vec3d& low, const Vec3d& high) {
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] == 0.0) {
                if (origin[axis] < low[axis] || origin[axis] > high[axis])
                    leave = -1.0;
                continue;
            }
            const double inverse = 1.0 / direction[axis];
            const double a = (low[axis] - origin[axis]) * inverse;
            const double b = (high[axis] - origin[axis]) * inverse;
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
    }
    bool empty() const { return !(enter < leave); }
};

Vec3 normalized(const Vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : Vec3(0.0f);
}

/// The unit normal on the eye's side. A normal that points away is mirrored in the plane perpendicular to the ray.
/// Unlike a change of sign, this is continuous at silhouettes, where smoothing tilts normals away.
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

CameraRays::CameraRays(const Renderable& renderable, const Camera& camera, int samples)
    : renderable_(renderable), field_(renderable.field), camera_(camera), frame_(renderable.frame),
      precision_(resolution(renderable.field)), two_sided_(two_sided(renderable.field)) {
    // Steps sized for a coarse part must not skip a finer part.
    for (const Part& part : renderable.parts)
        precision_.shortest_step = std::min(precision_.shortest_step, std::max(0.1f * resolution(part.field), 1e-4f));
    eye_ = (camera.eye() - frame_.center) / frame_.diagonal;
    low_ = (renderable.box.min - frame_.center) / frame_.diagonal - Vec3d(precision_.slack);
    high_ = (renderable.box.max - frame_.center) / frame_.diagonal + Vec3d(precision_.slack);
    far_ = static_cast<float>(1.01 * glm::length(high_ - low_));
    nearest_ = glm::length(glm::max(glm::max(low_ - eye_, eye_ - high_), Vec3d(0.0)));
    furthest_ = glm::length(glm::max(glm::abs(low_ - eye_), glm::abs(high_ - eye_)));
    for (int i = 0; i < samples; ++i)
        within_.push_back(fibonacci_point(i, samples, 0.0f, 0.5f));
}

CameraRays::GroundHit CameraRays::meet_ground(const Vec3d& ray) const {
    GroundHit nearest;
    for (std::size_t i = 0; i < renderable_.grounds.size(); ++i) {
        const Ground& ground = renderable_.grounds[i];
        const Vec3d normal(ground.plane.normal);
        const double approach = -glm::dot(normal, ray);
        const double height = glm::dot(normal, eye_) - double(ground.plane.offset);
        if (!(approach > 0.0 && height > 0.0 && height < nearest.distance * approach))
            continue;
        const double distance = height / approach;
        if (glm::length(eye_ + distance * ray) < double(ground.gone))
            nearest = {distance, static_cast<ObjectId>(std::max<std::size_t>(1, renderable_.parts.size()) + i + 1)};
    }
    return nearest;
}

void CameraRays::set_ground(const Vec3d& ray, const GroundHit& ground, std::size_t at, Hits& hits) const {
    hits.surfels[at] = {Vec3(eye_ + ground.distance * ray), ground_of(renderable_, ground.object)->plane.normal};
    hits.objects[at] = ground.object;
    hits.depths[at] = static_cast<float>(ground.distance * frame_.diagonal * glm::dot(ray, camera_.forward()));
}

void CameraRays::set_background(const Vec3d& ray, std::size_t at, Hits& hits) const {
    hits.surfels[at] = {Vec3(0.0f), Vec3(0.0f)};
    hits.objects[at] = no_object;
    if (const GroundHit ground = meet_ground(ray); ground.object != no_object)
        set_ground(ray, ground, at, hits);
}

void CameraRays::trace(const PixelRegion& region, std::size_t begin, std::size_t end, Hits& hits) const {
    const int columns = (region.width + tile_side - 1) / tile_side;
    std::vector<PixelRegion> tiles;
    std::vector<Cone> cones;
    for (std::size_t i = begin; i < end; ++i) {
        const int x = static_cast<int>(i % static_cast<std::size_t>(columns)) * tile_side;
        const int y = static_cast<int>(i / static_cast<std::size_t>(columns)) * tile_side;
        tiles.push_back({region.x + x, region.y + y, std::min(tile_side, region.width - x),
                         std::min(tile_side, region.height - y)});
        cones.push_back(cone_around(tiles.back()));
    }
    // Distances are less accurate behind a sheet than in front of it.
    march_cones(field_, eye_, cones, furthest_, two_sided_ ? precision_.slack : precision_.voxel);
    Batch rays;
    for (std::size_t i = 0; i < tiles.size(); ++i)
        trace_tile(tiles[i], region, cones[i].travelled, rays, hits);
    flush(rays, hits);
}

Cone CameraRays::cone_around(const PixelRegion& tile) const {
    const double left = tile.x, right = tile.x + tile.width, top = tile.y, bottom = tile.y + tile.height;
    Cone cone{camera_.direction(0.5 * (left + right), 0.5 * (top + bottom)), 0.0, nearest_};
    for (const double x : {left, right})
        for (const double y : {top, bottom})
            cone.slope = std::max(cone.slope, glm::length(camera_.direction(x, y) - cone.axis));
    return cone;
}

void CameraRays::trace_tile(const PixelRegion& tile, const PixelRegion& region, double start, Batch& rays,
                            Hits& hits) const {
    const auto samples = within_.size();
    for (int y = tile.y; y < tile.y + tile.height; ++y)
        for (int x = tile.x; x < tile.x + tile.width; ++x) {
            std::size_t at = (static_cast<std::size_t>(y - region.y) * static_cast<std::size_t>(region.width) +
                              static_cast<std::size_t>(x - region.x)) *
                             samples;
            for (const Vec2& place : within_) {
                hits.surfels[at] = {Vec3(0.0f), Vec3(0.0f)};
                hits.objects[at] = no_object;
                if (!hits.steps.empty())
                    hits.steps[at] = 0.0f;
                if (start < furthest_ || !renderable_.grounds.empty()) {
                    const Vec3d ray = camera_.direction(x + double(place.x), y + double(place.y));
                    const GroundHit ground = meet_ground(ray);
                    // Any hit in front of the ground overwrites this later.
                    if (ground.object != no_object)
                        set_ground(ray, ground, at, hits);
                    Span span(eye_, ray, low_, high_);
                    span.enter = std::max(span.enter, start);
                    span.leave = std::min(span.leave, ground.distance);
                    if (!span.empty()) {
                        // All rays of a batch end at length far_, so the origin is moved such that each ray leaves
                        // the box there. Measuring from this origin keeps single precision sufficient, however far
                        // away the eye is.
                        const double before = span.leave - far_;
                        rays.add(Vec3(eye_ + before * ray), Vec3(ray), static_cast<float>(span.enter - before), before,
                                 at);
                        if (rays.count == RayBatch::capacity)
                            flush(rays, hits);
                    }
                }
                ++at;
            }
        }
}

/// Computes the hits of the rays and empties the batch.
void CameraRays::flush(Batch& rays, Hits& hits) const {
    const auto owner = rays.owner;
    const std::size_t count = rays.count;
    meet(rays, hits);
    rays.count = 0;
    if (two_sided_ && renderable_.parts.size() > 1)
        name_parts({owner.data(), count}, hits);
}

/// Sets the object of each hit of the field to the part whose surface is nearest. Takes at most one batch of hits.
void CameraRays::name_parts(std::span<const std::size_t> hit_indices, Hits& hits) const {
    Places places;
    std::array<std::size_t, RayBatch::capacity> owner;
    for (const std::size_t at : hit_indices)
        if (hits.objects[at] == 1) {
            owner[places.count] = at;
            places.add(hits.surfels[at].position);
        }
    Values nearest, distance;
    nearest.fill(std::numeric_limits<float>::infinity());
    for (std::size_t part = 0; part < renderable_.parts.size(); ++part) {
        map_batch(renderable_.parts[part].field, places.points(), any_reach, distance.data());
        for (std::size_t i = 0; i < places.count; ++i)
            if (std::fabs(distance[i]) < nearest[i]) {
                nearest[i] = std::fabs(distance[i]);
                hits.objects[owner[i]] = static_cast<ObjectId>(part + 1);
            }
    }
}

void CameraRays::meet(Batch& rays, Hits& hits) const {
    if (!two_sided_) {
        Batch met = traced(rays, hits);
        if (renderable_.parts.size() > 1) {
            meet_parts(met, hits);
            return;
        }
        const Gradients gradient = differences(field_, places(met), precision_.difference);
        for (std::size_t i = 0; i < met.count; ++i)
            set_sharpened(field_, met, i, gradient[i], 1, hits);
        return;
    }
    // A thin wall has two jumps; more occur only where faces cross. The last attempt accepts its hit as a surface.
    constexpr int attempts = 6;
    for (int attempt = 1; attempt <= attempts && rays.count > 0; ++attempt)
        rays = meet_two_sided(rays, attempt == attempts, hits);
}

/// Sets the hits. Refines each hit with the field of the part whose surface is nearest, because other parts may be
/// coarser.
void CameraRays::meet_parts(Batch& met, Hits& hits) const {
    const std::size_t parts = renderable_.parts.size();
    const Places all = places(met);
    std::array<std::size_t, RayBatch::capacity> nearest_part{};
    Values nearest, distance;
    nearest.fill(std::numeric_limits<float>::infinity());
    for (std::size_t part = 0; part < parts; ++part) {
        map_batch(renderable_.parts[part].field, all.points(), any_reach, distance.data());
        for (std::size_t i = 0; i < met.count; ++i)
            if (std::fabs(distance[i]) < std::fabs(nearest[i])) {
                nearest[i] = distance[i];
                nearest_part[i] = part;
            }
    }
    for (std::size_t part = 0; part < parts; ++part) {
        Places own;
        std::array<std::size_t, RayBatch::capacity> index;
        for (std::size_t i = 0; i < met.count; ++i)
            if (nearest_part[i] == part) {
                met.travelled[i] += nearest[i];
                index[own.count] = i;
                own.add(met.place(i));
            }
        const AnyField& field = renderable_.parts[part].field;
        const Gradients gradient = differences(field, own, RayPrecision(resolution(field)).difference);
        for (std::size_t k = 0; k < own.count; ++k)
            set_sharpened(field, met, index[k], gradient[k], static_cast<ObjectId>(part + 1), hits);
    }
}

/// Sets the hits and returns the rays to trace further: along a ray from behind a sheet, distances jump before the ray
/// reaches the face. A hit that is clearly a jump is skipped. A hit that may be a jump is kept, unless the ray
/// certainly meets a face from behind a short distance further on.
CameraRays::Batch CameraRays::meet_two_sided(Batch& rays, bool last, Hits& hits) const {
    const Batch met = traced(rays, hits);
    const float voxel = precision_.voxel, near = nearness * voxel;
    const Values error = distances(places(met));
    const Gradients slope = differences(field_, places(met), near);
    // Distances are valid only in the cells around a face. Central differences at a point on the face would reach
    // behind these cells.
    Places in_front;
    for (std::size_t i = 0; i < met.count; ++i)
        in_front.add(met.place(i) + precision_.difference * normalized(slope[i]));
    const Values distance = distances(in_front);
    const Gradients gradient = differences(field_, in_front, precision_.difference);

    Batch further;
    for (std::size_t i = 0; i < met.count; ++i) {
        const float start = met.travelled[i] + near;
        if (distance[i] > max_slope * precision_.difference && !last) {
            further.add(met, i, start, 0.0f);
            continue;
        }
        const Vec3 normal = normalized(gradient[i]);
        const float along = glm::dot(normal, met.direction(i));
        const bool smooth =
            glm::length(slope[i]) > min_slope * 2.0f * near && glm::dot(normalized(slope[i]), normal) > min_agreement;
        const bool uncertain = !smooth || std::fabs(error[i]) > 0.5f * near;
        // Only the normal of a smooth surface can tilt away at a silhouette.
        const bool behind = (smooth ? glm::dot(slope[i], met.direction(i)) : along) > 0.0f;
        const ObjectId previous = hits.objects[met.owner[i]];
        if (previous != 1 || (!uncertain && behind))
            set(met, i, behind ? -normal : normal, 1, hits);
        if (uncertain) {
            const float end = start + max_jump * voxel / std::max(std::fabs(along), 0.1f);
            further.add(met, i, start, end - far_);
        }
    }
    return further;
}

/// The rays that hit the surface, advanced to their hits.
CameraRays::Batch CameraRays::traced(Batch& rays, Hits& hits) const {
    const Values start = rays.travelled;
    alcove::trace(field_, rays,
                  {.far = far_,
                   .hit_distance = two_sided_ ? precision_.hit_distance : 0.0f,
                   .shortest_step = precision_.shortest_step,
                   .relaxation = relaxation,
                   .two_sided = two_sided_});
    if (!hits.steps.empty())
        for (std::size_t i = 0; i < rays.count; ++i)
            hits.steps[rays.owner[i]] += static_cast<float>(rays.steps[i]);
    Batch met;
    Values earliest;
    for (std::size_t i = 0; i < rays.count; ++i)
        if (rays.hit[i]) {
            earliest[met.count] = start[i];
            met.add(rays, i, rays.travelled[i], 0.0f);
        }

    // Where a ray meets a face from behind, distances grow along the ray.
    Values sign;
    sign.fill(1.0f);
    if (two_sided_) {
        const float near = nearness * precision_.voxel;
        const Values before = distances(places(met, -near)), after = distances(places(met, near));
        for (std::size_t i = 0; i < met.count; ++i)
            sign[i] = after[i] > before[i] ? -1.0f : 1.0f;
    }
    const int refinements = two_sided_ ? 3 : 1;
    for (int round = 0; round < refinements; ++round) {
        const Values distance = distances(places(met));
        for (std::size_t i = 0; i < met.count; ++i)
            met.travelled[i] = std::max(met.travelled[i] + sign[i] * distance[i], earliest[i]);
    }
    return met;
}

/// Sets a hit of a field. Moves it onto a sharp edge if there is one, unless snap() will move it onto triangles anyway.
/// `gradient` is the result of differences().
void CameraRays::set_sharpened(const AnyField& field, Batch& met, std::size_t i, const Vec3& gradient, ObjectId object,
                               Hits& hits) const {
    if (!renderable_.mesh) {
        const float width = 2.0f * RayPrecision(resolution(field)).difference;
        if (const auto further = meet_crease(field, met.place(i), gradient / width, met.direction(i)))
            met.travelled[i] += *further;
    }
    set(met, i, gradient, object, hits);
}

void CameraRays::set(const Batch& rays, std::size_t i, const Vec3& gradient, ObjectId object, Hits& hits) const {
    const Vec3 direction = rays.direction(i);
    hits.surfels[rays.owner[i]] = {rays.place(i), facing(gradient, direction)};
    hits.objects[rays.owner[i]] = object;
    const double length = (rays.before[i] + static_cast<double>(rays.travelled[i])) * frame_.diagonal;
    hits.depths[rays.owner[i]] = static_cast<float>(length * glm::dot(Vec3d(direction), camera_.forward()));
}

CameraRays::Places CameraRays::places(const Batch& rays, float ahead) {
    Places places;
    for (std::size_t i = 0; i < rays.count; ++i)
        places.add(rays.place(i, ahead));
    return places;
}

CameraRays::Values CameraRays::distances(const Places& places) const {
    Values values;
    map_batch(field_, places.points(), any_reach, values.data());
    return values;
}

/// Differences f(x + h) − f(x − h) of the field along each axis, not divided by 2h.
CameraRays::Gradients CameraRays::differences(const AnyField& field, const Places& places, float h) {
    Gradients gradient;
    Values above, below;
    for (int axis = 0; axis < 3; ++axis) {
        const auto probe = [&](float shift, float* values) {
            Places moved = places;
            Values& coordinate = axis == 0 ? moved.x : axis == 1 ? moved.y : moved.z;
            for (std::size_t i = 0; i < places.count; ++i)
                coordinate[i] += shift;
            map_batch(field, moved.points(), 2.0f * h, values);
        };
        probe(h, above.data());
        probe(-h, below.data());
        for (std::size_t i = 0; i < places.count; ++i)
            gradient[i][axis] = above[i] - below[i];
    }
    return gradient;
}

}
