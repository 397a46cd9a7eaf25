/// surface_of_points(): surfaces at known positions.
#include "alcove/grid/voxelize.h"

#include "alcove/base/types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace alcove {
namespace {

constexpr double radius = 2.0;

/// Points of a sphere that are evenly spread (Fibonacci lattice), with normals outward.
Mesh sphere(std::size_t count, const Vec3d& center = Vec3d(5.0, -3.0, 1.0)) {
    Mesh points;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const double angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * static_cast<double>(i);
        const Vec3d n(std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z);
        points.positions.push_back(center + radius * n);
        points.normals.emplace_back(n);
    }
    return points;
}

double spacing_of_sphere(std::size_t count) {
    return radius * std::sqrt(4.0 * std::numbers::pi / static_cast<double>(count));
}

/// The largest distance of the surface's vertices from the sphere.
double error_of_sphere(const Mesh& surface) {
    double largest = 0.0;
    for (const Vec3d& p : surface.positions)
        largest = std::max(largest, std::fabs(glm::distance(p, Vec3d(5.0, -3.0, 1.0)) - radius));
    return largest;
}

bool has_warning(const Mesh& mesh, const std::string& text) {
    return std::any_of(mesh.warnings.begin(), mesh.warnings.end(),
                       [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

/// Adds a square grid of points at height `z`, 0.02 apart, that faces +z.
void add_square(Mesh& points, double z, float side, double hole = 0.0) {
    for (double x = 0.0; x <= 1.0; x += 0.02)
        for (double y = 0.0; y <= 1.0; y += 0.02)
            if (std::hypot(x - 0.5, y - 0.5) >= hole) {
                points.positions.emplace_back(x, y, z);
                points.normals.emplace_back(0.0f, 0.0f, side);
            }
}

TEST(Points, ASphereIsReconstructed) {
    const Mesh points = sphere(20000);
    const PointSurface surface = surface_of_points(points);
    const double spacing = spacing_of_sphere(20000);
    EXPECT_LT(error_of_sphere(surface.mesh), 0.1 * spacing);
    EXPECT_TRUE(surface.mesh.warnings.empty());
    double volume = 0.0; // by the divergence theorem, so it also tells the orientation
    const auto corner = [&](std::size_t f, std::size_t k) { return surface.mesh.positions[surface.mesh.face(f)[k]]; };
    for (std::size_t f = 0; f < surface.mesh.face_count(); ++f)
        volume += glm::dot(corner(f, 0), glm::cross(corner(f, 1), corner(f, 2))) / 6.0;
    EXPECT_NEAR(volume / (4.0 / 3.0 * std::numbers::pi * radius * radius * radius), 1.0, 0.01);
    for (std::size_t i = 0; i < points.vertex_count(); ++i) {
        ASSERT_EQ(surface.normals[i], points.normals[i]);
        EXPECT_LT(glm::distance(surface.positions[i], points.positions[i]), 0.2 * spacing);
        const std::size_t face = surface.faces[i];
        const Vec3d a = corner(face, 0), normal = glm::normalize(glm::cross(corner(face, 1) - a, corner(face, 2) - a));
        EXPECT_NEAR(glm::dot(surface.positions[i] - a, normal), 0.0, 1e-5 * spacing);
    }
}

TEST(Points, TheOrderOfThePointsDoesNotMatter) {
    Mesh points = sphere(5000), reversed = points;
    std::reverse(reversed.positions.begin(), reversed.positions.end());
    std::reverse(reversed.normals.begin(), reversed.normals.end());
    EXPECT_EQ(surface_of_points(points).mesh.positions, surface_of_points(reversed).mesh.positions);
}

TEST(Points, OutliersDuplicatesAndBrokenPointsDoNoHarm) {
    Mesh points = sphere(20000);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto add = [&](const Vec3d& p, const Vec3& n) {
        points.positions.push_back(p);
        points.normals.push_back(n);
    };
    for (int i = 0; i < 4000; ++i) // in and around the sphere
        add(Vec3d(5.0, -3.0, 1.0) + 4.0 * Vec3d(uniform(random), uniform(random), uniform(random)),
            glm::normalize(Vec3(uniform(random), uniform(random), uniform(random))));
    for (std::size_t i = 0; i < 3000; ++i)
        add(points.positions[i], points.normals[i]);
    add(Vec3d(1e12, 0, 0), Vec3(1, 0, 0));
    add(Vec3d(std::numeric_limits<double>::quiet_NaN(), 0, 0), Vec3(1, 0, 0));
    const PointSurface surface = surface_of_points(points);
    std::size_t far = 0;
    for (const Vec3d& p : surface.mesh.positions)
        far += std::fabs(glm::distance(p, Vec3d(5.0, -3.0, 1.0)) - radius) > 0.5 * spacing_of_sphere(20000);
    EXPECT_LT(far, surface.mesh.vertex_count() / 100);
    EXPECT_TRUE(has_warning(surface.mesh, "are outliers"));
    EXPECT_TRUE(has_warning(surface.mesh, "3,000 points repeat the position of another"));
    EXPECT_TRUE(has_warning(surface.mesh, "1 point has coordinates that are not finite"));
    EXPECT_EQ(surface.positions[24000], surface.positions[0]); // a duplicate has the position of its twin
    EXPECT_EQ(surface.normals[24000], surface.normals[0]);
    EXPECT_EQ(surface.normals.back(), Vec3(0.0f));
}

TEST(Points, MissingNormalsAreEstimatedAndPointOutward) {
    Mesh points = sphere(5000);
    const std::vector<Vec3> truth = std::exchange(points.normals, {});
    const PointSurface surface = surface_of_points(points);
    EXPECT_TRUE(has_warning(surface.mesh, "5,000 points have no normal"));
    for (std::size_t i = 0; i < truth.size(); ++i)
        ASSERT_GT(glm::dot(surface.normals[i], truth[i]), 0.98f);
    EXPECT_LT(error_of_sphere(surface.mesh), 0.2 * spacing_of_sphere(5000));
    // The normals that exist determine the orientation of the others.
    points.normals.assign(5000, Vec3(0.0f));
    points.normals[7] = -truth[7];
    const PointSurface inward = surface_of_points(points);
    for (std::size_t i = 0; i < truth.size(); ++i)
        ASSERT_LT(glm::dot(inward.normals[i], truth[i]), -0.98f);
}

TEST(Points, SmallHolesAreClosedAndLargeOnesStay) {
    const auto reaches = [](const Mesh& surface, double distance) { // to the centre of the square
        return std::any_of(surface.positions.begin(), surface.positions.end(),
                           [&](const Vec3d& p) { return std::hypot(p.x - 0.5, p.y - 0.5) < distance; });
    };
    Mesh small, large;
    add_square(small, 0.0, 1.0f, 0.03);
    add_square(large, 0.0, 1.0f, 0.2);
    EXPECT_TRUE(reaches(surface_of_points(small).mesh, 0.015));
    EXPECT_FALSE(reaches(surface_of_points(large).mesh, 0.1));
    EXPECT_TRUE(reaches(surface_of_points(large, {.point_size = Length(0.15)}).mesh, 0.1));
}

TEST(Points, TwoSidesOfAWallStayApart) {
    Mesh points;
    add_square(points, 0.0, -1.0f);
    add_square(points, 0.1, 1.0f); // five spacings
    const PointSurface surface = surface_of_points(points);
    std::size_t between = 0;
    for (const Vec3d& p : surface.mesh.positions)
        between += p.z > 0.02 && p.z < 0.08 && p.x > 0.05 && p.x < 0.95 && p.y > 0.05 && p.y < 0.95;
    EXPECT_EQ(between, 0u);
    for (std::size_t i = 0; i < points.vertex_count(); ++i)
        if (surface.normals[i] != Vec3(0.0f)) {
            EXPECT_NEAR(surface.positions[i].z, points.positions[i].z, 1e-3);
        }
}

TEST(Points, RefusesWhatDeterminesNoSurface) {
    Mesh points;
    points.positions = {{0, 0, 0}, {1, 0, 0}};
    EXPECT_THROW(surface_of_points(points), InputError);
    points.positions.assign(100, Vec3d(1.0));
    EXPECT_THROW(surface_of_points(points), InputError);
    points.positions.assign(10, Vec3d(std::numeric_limits<double>::infinity()));
    EXPECT_THROW(surface_of_points(points), InputError);
    EXPECT_THROW(surface_of_points(sphere(5000), {.point_size = Length(1e-4)}), InputError);
}

}
}
