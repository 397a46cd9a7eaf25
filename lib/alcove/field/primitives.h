/// Exact signed distances of simple shapes. Source: I. Quilez, "Distance functions" (2008).
#pragma once

#include "alcove/base/types.h"

#include <algorithm>
#include <cmath>

namespace alcove {

/// The half-space below the plane {p : normal · p = offset}.
struct Plane {
    Vec3 normal{0.0f, 1.0f, 0.0f}; ///< unit length
    float offset = 0.0f;

    float map(const Vec3& p) const { return glm::dot(p, normal) - offset; }
};

struct Sphere {
    Vec3 center{0.0f};
    float radius = 1.0f;

    float map(const Vec3& p) const { return glm::length(p - center) - radius; }
};

/// A solid box along the axes.
struct Cuboid {
    Vec3 center{0.0f};
    Vec3 half_extent{1.0f};

    float map(const Vec3& p) const {
        const Vec3 q = glm::abs(p - center) - half_extent;
        return glm::length(glm::max(q, Vec3(0.0f))) + std::min(std::max(q.x, std::max(q.y, q.z)), 0.0f);
    }
};

/// A torus around the y axis through its centre.
struct Torus {
    Vec3 center{0.0f};
    float ring_radius = 1.0f;
    float tube_radius = 0.25f;

    float map(const Vec3& p) const {
        const Vec3 q = p - center;
        const float ring = std::sqrt(q.x * q.x + q.z * q.z) - ring_radius;
        return std::sqrt(ring * ring + q.y * q.y) - tube_radius;
    }
};

/// All points within `radius` of the segment from `start` to `end`.
struct Capsule {
    Vec3 start{0.0f};
    Vec3 end{0.0f, 1.0f, 0.0f};
    float radius = 0.5f;

    float map(const Vec3& p) const {
        const Vec3 axis = end - start;
        const float length2 = glm::dot(axis, axis);
        const float t = length2 > 0.0f ? std::clamp(glm::dot(p - start, axis) / length2, 0.0f, 1.0f) : 0.0f;
        return glm::length(p - start - t * axis) - radius;
    }
};

}
