#include "alcove/render/detail/creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

namespace alcove {
namespace {

/// Cosine of incidence below which a hit is corrected. Interpolation rounds edges by up to 0.3 voxels, and moves hits
/// at grazing incidence by several times that.
constexpr float grazing = 0.4f;

/// A shorter gradient means that the sides of an edge meet within the central-difference stencil.
constexpr float steady_slope = 0.95f;

/// A ray may have passed an edge if, bend_reach voxels before the hit, the field differed from the distance to the
/// hit's tangent plane by more than min_bend voxels.
constexpr float bend_reach = 1.5f, min_bend = 0.15f;

/// Distance, in voxels, from a hit to the samples that search for the sides of an edge: beyond the cells that the edge
/// crosses.
constexpr float side_reach = 2.25f;

/// The half width of the central differences, in voxels, and the tolerance of the gradient length, which is 1 where all
/// nearby distances are distances to one plane.
constexpr float difference = 0.25f, flatness = 0.002f;

/// The largest cosine between the normals of two sides, the smallest cosine between normals of the same side, and the
/// largest error of the planes at a sample, in voxels.
constexpr float max_turn_cosine = 0.9f, same_side = 0.995f, misfit = 0.05f;

/// Largest move of a hit along its ray, voxels.
constexpr float max_move = 4.0f;

struct Side {
    Vec3 normal;
    float offset;

    float distance(const Vec3& p) const { return glm::dot(normal, p) - offset; }
};

/// The field at a point `place`, relative to the hit.
struct Sample {
    Vec3 place, gradient;
    float distance;

    bool is_flat() const { return std::fabs(glm::length(gradient) - 1.0f) < flatness; }
    Side side() const {
        const Vec3 normal = glm::normalize(gradient);
        return {normal, glm::dot(normal, place) - distance};
    }
};

/// The planes of a convex or concave edge or corner.
class Crease {
  public:
    /// The crease that fits the samples; std::nullopt if none does.
    static std::optional<Crease> through(std::span<const Sample> samples, float voxel) {
        Crease crease;
        std::vector<Sample> flat;
        std::copy_if(samples.begin(), samples.end(), std::back_inserter(flat),
                     [](const Sample& sample) { return sample.is_flat(); });
        for (const Sample& sample : flat) {
            const Side side = sample.side();
            const auto same = std::find_if(crease.sides_.begin(), crease.sides_.end(), [&](const Side& s) {
                return glm::dot(s.normal, side.normal) > max_turn_cosine;
            });
            if (same == crease.sides_.end())
                crease.sides_.push_back(side);
            else if (glm::dot(same->normal, side.normal) < same_side)
                return std::nullopt;
        }
        if (crease.sides_.size() < 2 || crease.sides_.size() > 3)
            return std::nullopt;
        for (const bool convex : {true, false}) {
            crease.convex_ = convex;
            if (std::all_of(flat.begin(), flat.end(), [&](const Sample& sample) {
                    return std::fabs(crease.distance(sample.place) - sample.distance) < misfit * voxel;
                }))
                return crease;
        }
        return std::nullopt;
    }

    /// For a ray through the hit: the distance from the hit to the point where the ray enters the solid, if it is
    /// between -far and far.
    std::optional<float> meet(const Vec3& direction, float far) const {
        float enter = convex_ ? -far : far, leave = far;
        for (const Side& side : sides_) {
            const float along = glm::dot(side.normal, direction);
            const float t = side.offset / along;
            const bool starts_inside = side.distance(-far * direction) <= 0.0f;
            if (along < 0.0f)
                enter = convex_ ? std::max(enter, t) : std::min(enter, t);
            else if (convex_ && along > 0.0f)
                leave = std::min(leave, t);
            if (convex_ ? along == 0.0f && !starts_inside : starts_inside)
                return std::nullopt;
        }
        return std::fabs(enter) < far && enter < leave ? std::optional(enter) : std::nullopt;
    }

  private:
    float distance(const Vec3& p) const {
        float distance = sides_[0].distance(p);
        for (const Side& side : sides_)
            distance = convex_ ? std::max(distance, side.distance(p)) : std::min(distance, side.distance(p));
        return distance;
    }

    std::vector<Side> sides_;
    bool convex_ = true;
};

constexpr std::size_t first_directions = 4, all_directions = 14;

/// Directions to the corners and faces of a cube. The first four point to the corners of a tetrahedron: near an edge,
/// at least two of them point above its sides.
std::array<Vec3, all_directions> around() {
    std::array<Vec3, all_directions> directions;
    std::size_t count = 0;
    for (const float parity : {1.0f, -1.0f})
        for (const float x : {-1.0f, 1.0f})
            for (const float y : {-1.0f, 1.0f})
                directions[count++] = glm::normalize(Vec3(x, y, parity * x * y));
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            directions[count] = Vec3(0.0f);
            directions[count++][axis] = sign;
        }
    return directions;
}

std::vector<Sample> sample(const AnyField& field, const Vec3& hit, std::span<const Vec3> directions, float voxel) {
    constexpr std::size_t probes = 7; // the point itself and two along each axis
    const float h = difference * voxel;
    std::array<float, probes * all_directions> x, y, z, distance;
    std::vector<Sample> samples;
    std::size_t count = 0;
    for (const Vec3& direction : directions) {
        samples.push_back({side_reach * voxel * direction, Vec3(0.0f), 0.0f});
        const Vec3 place = hit + samples.back().place;
        for (std::size_t probe = 0; probe < probes; ++probe, ++count) {
            x[count] = place.x + (probe == 1 ? h : probe == 2 ? -h : 0.0f);
            y[count] = place.y + (probe == 3 ? h : probe == 4 ? -h : 0.0f);
            z[count] = place.z + (probe == 5 ? h : probe == 6 ? -h : 0.0f);
        }
    }
    map_batch(field, Points{x.data(), y.data(), z.data(), count}, any_reach, distance.data());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const float* d = &distance[probes * i];
        samples[i].distance = d[0];
        samples[i].gradient = Vec3(d[1] - d[2], d[3] - d[4], d[5] - d[6]) / (2.0f * h);
    }
    return samples;
}

/// Whether the ray passed a bend before the hit: whether the field in front of the hit differs from the distance to the
/// tangent plane of the hit.
bool passed_a_bend(const AnyField& field, const Vec3& hit, const Vec3& direction, float approach, float voxel) {
    const float reach = bend_reach * voxel;
    return std::fabs(field.map(hit - reach * direction) - reach * approach) > min_bend * voxel;
}

}

std::optional<float> meet_crease(const AnyField& field, const Vec3& hit, const Vec3& gradient, const Vec3& direction) {
    const float slope = glm::length(gradient), approach = -glm::dot(gradient, direction) / slope;
    const float voxel = resolution(field);
    if (approach > grazing || !(voxel > 0.0f) || two_sided(field))
        return std::nullopt;
    if (slope > steady_slope && !passed_a_bend(field, hit, direction, approach, voxel))
        return std::nullopt;
    static const std::array<Vec3, all_directions> directions = around();
    const std::span<const Vec3> all(directions);
    std::vector<Sample> samples = sample(field, hit, all.first(first_directions), voxel);
    if (std::none_of(samples.begin(), samples.end(), [](const Sample& s) { return s.is_flat(); }))
        return std::nullopt;
    const std::vector<Sample> others = sample(field, hit, all.subspan(first_directions), voxel);
    samples.insert(samples.end(), others.begin(), others.end());
    const auto crease = Crease::through(samples, voxel);
    return crease ? crease->meet(direction, max_move * voxel) : std::nullopt;
}

}
