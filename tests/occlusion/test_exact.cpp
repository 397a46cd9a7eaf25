/// exact against closed forms on triangles (Howell 1982), against brute force over all triangles in double precision,
/// and against an independent ray tracer.
#include "alcove/field/detail/trace.h"
#include "alcove/occlusion/methods/exact.h"

#include "alcove/base/types.h"
#include "alcove/mesh/normals.h"
#include "exact_distance.h"
#include "real_mesh.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace alcove {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr double pi = std::numbers::pi;

struct Triangles {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;

    /// Corners in order around the quad.
    void add_quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c, d});
        triangles.insert(triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
    }
    RaySurface surface() const { return {positions, triangles}; }
};

Triangles floor_of(float half) {
    Triangles floor;
    floor.add_quad({-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half});
    return floor;
}

/// A floor and a wall at x = 0, large enough to count as infinite.
Triangles floor_and_wall(float height, bool toward_negative_x = false) {
    constexpr float half = 500.0f;
    Triangles scene = floor_of(half);
    if (toward_negative_x)
        scene.add_quad({0, 0, half}, {0, height, half}, {0, height, -half}, {0, 0, -half});
    else
        scene.add_quad({0, 0, -half}, {0, height, -half}, {0, height, half}, {0, 0, half});
    return scene;
}

double exact(const Triangles& scene, const Surfel& surfel, float radius, int rays = 4096) {
    return evaluate_ao(std::vector{surfel}, scene.surface(), Exact{.radius = radius, .rays = rays}).front();
}

double exact_on_floor(const Triangles& scene, float x, float radius) {
    return exact(scene, {{x, 0, 0}, {0, 1, 0}}, radius);
}

TEST(Exact, OpenOnAPlane) {
    for (const float radius : {0.1f, 1.0f, infinite})
        EXPECT_EQ(exact_on_floor(floor_of(1.0f), 0.3f, radius), 1.0);
}

TEST(Exact, FloorBesideAWall) {
    const Triangles scene = floor_and_wall(500.0f);
    for (const float x : {0.05f, 0.2f, 0.5f, 0.9f})
        for (const float radius : {0.3f, 1.0f, 2.5f}) {
            const double u = std::min(1.0, double(x) / radius);
            EXPECT_NEAR(exact_on_floor(scene, x, radius), 1.0 - (std::acos(u) - u * std::sqrt(1 - u * u)) / pi, 0.005)
                << x << " " << radius;
        }
    EXPECT_NEAR(exact_on_floor(scene, 0.3f, infinite), 0.5, 0.005);
}

TEST(Exact, FloorBesideAWallOfSomeHeight) {
    for (const float height : {0.5f, 1.0f, 3.0f})
        for (const float x : {0.1f, 0.5f, 2.0f})
            EXPECT_NEAR(exact_on_floor(floor_and_wall(height), x, infinite), 0.5 * (1.0 + x / std::hypot(x, height)),
                        0.005)
                << height << " " << x;
}

TEST(Exact, FacesAreTwoSided) {
    for (const float x : {0.05f, 0.5f})
        EXPECT_EQ(exact_on_floor(floor_and_wall(1.0f), x, 1.0f), exact_on_floor(floor_and_wall(1.0f, true), x, 1.0f));
}

TEST(Exact, InsideASphere) {
    const Mesh sphere = test::sphere_mesh(6);
    Triangles scene;
    for (const Vec3d& p : sphere.positions)
        scene.positions.emplace_back(p);
    scene.triangles = triangulate(sphere).triangles;
    for (const float radius : {0.5f, 1.0f, 1.7f})
        for (const Vec3 p : {Vec3(0, -1, 0), Vec3(scene.positions[1000])})
            EXPECT_NEAR(exact(scene, {p, -p}, radius), 1.0 - std::pow(radius / 2.0, 2), 0.006) << radius;
    EXPECT_EQ(exact(scene, {{0, -1, 0}, {0, 1, 0}}, infinite), 0.0);
    EXPECT_EQ(exact(scene, {{0, -1, 0}, {0, -1, 0}}, infinite), 1.0);
}

TEST(Exact, FloorOfAPit) {
    constexpr int sides = 256;
    for (const float a : {0.3f, 1.0f})
        for (const float depth : {0.2f, 2.0f}) {
            Triangles pit = floor_of(2.0f * a);
            for (int i = 0; i < sides; ++i) {
                const auto corner = [&](int k, float y) {
                    const double angle = 2.0 * pi * k / sides;
                    return Vec3(a * std::cos(angle), y, a * std::sin(angle));
                };
                pit.add_quad(corner(i, 0), corner(i + 1, 0), corner(i + 1, depth), corner(i, depth));
            }
            for (const float radius : {0.25f, 0.6f, 1.5f, infinite}) {
                const double a2 = double(a) * a, r = radius;
                const double expected = std::min(1.0, std::max(a2 / (a2 + double(depth) * depth), a2 / (r * r)));
                EXPECT_NEAR(exact_on_floor(pit, 0.0f, radius), expected, 0.005) << a << " " << depth << " " << r;
            }
        }
}

TEST(Exact, BentNormalInACorner) {
    const Triangles scene = floor_and_wall(500.0f);
    const std::vector<Surfel> surfels{{{0.1f, 0, 0}, {0, 1, 0}}, {{0.1f, 1e-3f, 0}, {0, -1, 0}}};
    const ChannelValues baked =
        evaluate(surfels, scene.surface(), Exact{.radius = infinite, .rays = 4096}, Channel::ao | Channel::bent_normal);
    const std::vector<float>& bent = baked[Channel::bent_normal];
    // ∫ ω cos θ over the quarter of the sphere that is open: (2/3, π/3, 0).
    const Vec3 expected = glm::normalize(Vec3(2.0f / 3.0f, pi / 3.0, 0.0f));
    EXPECT_LT(glm::length(Vec3(bent[0], bent[1], bent[2]) - expected), 0.01f);
    EXPECT_NEAR(glm::length(Vec3(bent[0], bent[1], bent[2])), 1.0f, 1e-6f);
    // Just above the floor and facing it, nothing is open.
    EXPECT_EQ(baked[Channel::ao][1], 0.0f);
    EXPECT_EQ(Vec3(bent[3], bent[4], bent[5]), Vec3(0.0f));
}

TEST(CosineLattice, IsTheShiftedLatticeOverTheHemisphere) {
    constexpr int count = 37;
    const CosineLattice lattice(count);
    for (std::uint32_t random = 1; random < 200; ++random) {
        const CosineLattice::Shift shift(hash(random));
        for (int i = 0; i < count; ++i) {
            const Vec2 uv = fibonacci_point(i, count, unit_interval(hash(random)), unit_interval(hash(hash(random))));
            EXPECT_LT(glm::length(lattice.direction(i, shift) - cosine_hemisphere(uv.x, uv.y)), 1e-3f);
        }
    }
}

/// Whether the ray hits any triangle within `far`, by brute force in double precision (Möller and Trumbore 1997).
enum class Meets { no, yes, too_close_to_call };
Meets meets_any(const Triangles& scene, const Vec3d& origin, const Vec3d& direction, double far) {
    constexpr double margin = 1e-5;
    Meets meets = Meets::no;
    for (const auto& [ia, ib, ic] : scene.triangles) {
        const Vec3d a = scene.positions[ia], ab = Vec3d(scene.positions[ib]) - a, ac = Vec3d(scene.positions[ic]) - a;
        const Vec3d across = glm::cross(direction, ac);
        const double determinant = glm::dot(ab, across);
        const Vec3d from = origin - a, q = glm::cross(from, ab);
        // The smallest margin of the hit over all bounds; negative outside.
        const double u = glm::dot(from, across) / determinant, v = glm::dot(direction, q) / determinant;
        const double t = glm::dot(ac, q) / determinant;
        const double inside = std::min({u, v, 1.0 - u - v, t / 1e-2, (far - t) / far});
        if (inside > margin)
            return Meets::yes;
        if (inside > -margin)
            meets = Meets::too_close_to_call;
    }
    return meets;
}

TEST(Exact, EveryRayIsAsEveryTriangleTriedSays) {
    const test::RealMesh real("elephant.off");
    const std::vector<Surfel> surfels = make_surfels(real.mesh, real.triangles, real.frame);
    Triangles scene{{}, real.triangles};
    for (const Surfel& surfel : surfels)
        scene.positions.push_back(surfel.position);
    constexpr int rays = 32;
    const Exact estimator{.radius = 0.2f, .rays = rays, .seed = 7};
    const std::vector<float> ao = evaluate_ao(surfels, scene.surface(), estimator);
    int compared = 0;
    for (std::size_t s = 0; s < surfels.size(); s += 47) {
        const Surfel& surfel = surfels[s];
        const std::uint32_t h = hash(surfel.position, estimator.seed);
        int open = 0, unsure = 0;
        for (int r = 0; r < rays; ++r) {
            const Vec2 uv = fibonacci_point(r, rays, unit_interval(h), unit_interval(hash(h)));
            const Vec3 direction = Basis(surfel.normal).to_world(cosine_hemisphere(uv.x, uv.y));
            const Vec3d origin = Vec3d(surfel.position) + 1e-4 * Vec3d(surfel.normal);
            const Meets meets = meets_any(scene, origin, direction, estimator.radius);
            open += meets == Meets::no;
            unsure += meets == Meets::too_close_to_call;
        }
        compared += unsure == 0;
        EXPECT_GE(ao[s] * rays, open) << s;
        EXPECT_LE(ao[s] * rays, open + unsure) << s;
    }
    EXPECT_GT(compared, 50);
}

TEST(Exact, AgreesWithRaysShotElsewhere) {
    for (const char* name : {"elephant.off", "mesh_with_border.off", "fandisk.off"}) {
        const test::RealMesh real(name);
        const std::vector<Surfel> surfels = make_surfels(real.mesh, real.triangles, real.frame);
        std::vector<Vec3> positions;
        std::vector<Surfel> some;
        for (const Surfel& surfel : surfels) {
            positions.push_back(surfel.position);
            if (positions.size() % 10 == 0)
                some.push_back(surfel);
        }
        const RaySurface surface(positions, real.triangles);
        const test::ExactSurface oracle(real.mesh, real.triangles, real.frame);
        std::vector<float> previous(some.size(), 1.0f);
        for (const float radius : {0.02f, 0.1f, 0.5f, infinite}) {
            const std::vector<float> ao = evaluate_ao(some, surface, Exact{.radius = radius, .rays = 1024});
            double sum = 0.0;
            for (std::size_t i = 0; i < some.size(); ++i) {
                const double error = some[i].has_normal() ? ao[i] - oracle.visibility(some[i], radius, 1024) : 0.0;
                sum += error * error;
                if (radius > 0.1f) { // below, the offset of rays grows with the radius
                    EXPECT_LE(ao[i], previous[i]) << "the same rays, reaching further";
                }
            }
            EXPECT_LE(std::sqrt(sum / static_cast<double>(some.size())), 0.006) << name << " " << radius;
            previous = ao;
        }
    }
}

TEST(Exact, DependsOnThePlaceAndTheSeedAlone) {
    const RaySurface surface = floor_and_wall(1.0f).surface();
    std::vector<Surfel> surfels;
    for (int i = 0; i < 5000; ++i)
        surfels.push_back({{0.001f * static_cast<float>(1 + i % 977), 0, 0.01f * static_cast<float>(i)}, {0, 1, 0}});
    const Exact estimator{.radius = 0.5f, .rays = 8};
    const std::vector<float> ao = evaluate_ao(surfels, surface, estimator);
    const std::vector<Surfel> reversed(surfels.rbegin(), surfels.rend());
    const std::vector<float> backward = evaluate_ao(reversed, RaySurface(surface), estimator);
    EXPECT_TRUE(std::equal(ao.begin(), ao.end(), backward.rbegin()));
    {
        const ThreadLimit one(1);
        EXPECT_EQ(evaluate_ao(surfels, surface, estimator), ao);
    }
    EXPECT_NE(evaluate_ao(surfels, surface, Exact{.radius = 0.5f, .rays = 8, .seed = 1}), ao);
}

TEST(RaySurface, TakesDegenerateTrianglesAndNone) {
    Triangles scene = floor_and_wall(1.0f);
    const double before = exact_on_floor(scene, 0.2f, 1.0f);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    scene.positions.insert(scene.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0}, {nan, 0, 0}, {0, infinite, 0}});
    scene.triangles.insert(scene.triangles.end(), {{first, first, first},
                                                   {first, first + 1, first + 2},
                                                   {first, first + 1, first + 3},
                                                   {first, first + 1, first + 4}});
    EXPECT_EQ(exact_on_floor(scene, 0.2f, 1.0f), before);
    EXPECT_EQ(exact_on_floor({}, 0.2f, infinite), 1.0);
}

TEST(RaySurface, RefusesACornerThatNamesNoPosition) {
    const std::vector<Vec3> positions(3);
    const std::vector<Triangle> triangles{{0, 1, 3}};
    EXPECT_THROW(RaySurface(positions, triangles), InputError);
}

TEST(NearestHits, AreThePlacesThatTheirWeightsName) {
    const Mesh mesh = test::sphere_mesh(3);
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    std::vector<Vec3> positions(mesh.positions.begin(), mesh.positions.end());
    const RaySurface surface(positions, triangles);
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    RayBatch rays;
    while (rays.count < RayBatch::capacity) {
        const Vec3 from = 2.0f * glm::normalize(Vec3(normal(random), normal(random), normal(random)));
        const Vec3 to = 0.6f * Vec3(normal(random), normal(random), normal(random));
        rays.push_back({from, glm::normalize(to - from)}, 0.0f);
    }
    std::array<SurfaceHit, RayBatch::capacity> hits;
    surface.find_nearest(rays, 10.0f, hits);
    RayBatch again = rays;
    again.travelled.fill(0.0f);
    surface.find_occluded(again, 10.0f);
    int met = 0;
    for (std::size_t i = 0; i < rays.count; ++i) {
        EXPECT_EQ(rays.hit[i], again.hit[i]);
        if (!rays.hit[i])
            continue;
        ++met;
        const Vec3 place =
            Vec3(rays.x[i], rays.y[i], rays.z[i]) + rays.travelled[i] * Vec3(rays.dx[i], rays.dy[i], rays.dz[i]);
        Vec3 weighted(0.0f);
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(hits[i].weights[k], -1e-5f);
            weighted += hits[i].weights[k] * positions[hits[i].vertices[static_cast<std::size_t>(k)]];
        }
        EXPECT_NEAR(glm::length(weighted - place), 0.0f, 2e-5f);
        EXPECT_NEAR(hits[i].weights.x + hits[i].weights.y + hits[i].weights.z, 1.0f, 1e-5f);
        EXPECT_LT(glm::length(place), 1.0f);
        EXPECT_LT(rays.travelled[i], 2.0f);
        EXPECT_NE(std::find_if(triangles.begin(), triangles.end(),
                               [&](const Triangle& t) { return std::ranges::is_permutation(t, hits[i].vertices); }),
                  triangles.end());
    }
    EXPECT_GT(met, 100);
}

}
}
