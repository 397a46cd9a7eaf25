/// The reference scene (sdfao2026): a sphere and a torus on a plane.
#pragma once

#include "alcove/base/types.h"
#include "alcove/field/primitives.h"

#include <cmath>
#include <random>
#include <vector>

namespace alcove::test {

struct ReferenceScene {
    Union<Plane, Sphere, Torus> field{Plane{}, Sphere{{0, 1, 0}, 1.0f}, Torus{{0, 0.5f, 0}, 1.5f, 0.4f}};

    /// The distance in double precision.
    double distance(const Vec3d& p) const {
        const double sphere = glm::length(p - Vec3d(0, 1, 0)) - 1.0;
        const double ring = std::sqrt(p.x * p.x + p.z * p.z) - 1.5, height = p.y - 0.5;
        const double torus = std::sqrt(ring * ring + height * height) - 0.4;
        return std::fmin(p.y, std::fmin(sphere, torus));
    }

    /// Points on the surface near the objects, with normals by central differences of step 0.001.
    std::vector<Surfel> surfels(std::size_t count) const {
        std::mt19937 random(11);
        std::uniform_real_distribution<double> across(-2.5, 2.5), up(0.0, 2.2);
        std::vector<Surfel> found;
        while (found.size() < count) {
            Vec3d p(across(random), up(random), across(random));
            for (int step = 0; step < 20; ++step)
                p -= distance(p) * glm::normalize(gradient(p));
            if (std::fabs(distance(p)) < 1e-9 && std::fabs(glm::length(gradient(p)) - 1.0) < 0.05)
                found.push_back({Vec3(p), Vec3(glm::normalize(gradient(p)))});
        }
        return found;
    }

  private:
    Vec3d gradient(const Vec3d& p) const {
        const double h = 0.001;
        const auto slope = [&](const Vec3d& e) { return (distance(p + h * e) - distance(p - h * e)) / (2 * h); };
        return {slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
    }
};

}
