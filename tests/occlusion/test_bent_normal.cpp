/// Bent normals of Traced and Classic against closed forms, and against exact rays on scans.
#include "alcove/occlusion/methods/reference/classic.h"
#include "alcove/occlusion/methods/traced.h"

#include "alcove/field/primitives.h"
#include "alcove/mesh/files.h"
#include "alcove/occlusion/estimator.h"
#include "exact_distance.h"
#include "voxelized.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

namespace alcove {
namespace {

template <class F, class E>
std::vector<Vec3> bent_normals(const std::vector<Surfel>& surfels, const F& field, const E& estimator) {
    const std::vector<float> values = evaluate(surfels, field, estimator, Channel::bent_normal)[Channel::bent_normal];
    std::vector<Vec3> bent;
    for (std::size_t i = 0; i < values.size(); i += 3)
        bent.emplace_back(values[i], values[i + 1], values[i + 2]);
    return bent;
}

/// Half of the sky is hidden at the foot of an infinite wall. The cosine-weighted mean over the open quarter sphere is
/// between the normals of floor and wall. The tangent of its angle to the floor's normal is (4/3) / (2 pi/3) = 2/pi.
TEST(BentNormal, AtTheFootOfAWallInClosedForm) {
    const Union corner(Plane{}, Plane{{1, 0, 0}, 0.0f});
    const std::vector<Surfel> surfels{{{0.001f, 0, 0}, {0, 1, 0}}};
    const Vec3d expected = glm::normalize(Vec3d(2.0 / std::numbers::pi, 1, 0));
    for (const bool cosine_weighted : {true, false}) {
        const Vec3 bent =
            bent_normals(surfels, corner, Traced{.radius = 1.0f, .rays = 4096, .cosine_weighted = cosine_weighted})
                .front();
        EXPECT_NEAR(glm::length(Vec3d(bent) - expected), 0.0, 0.01);
    }
}

struct Buried {
    float map(const Vec3&) const { return -1.0f; }
};

TEST(BentNormal, IsTheNormalInTheOpenAndNothingWhereNothingIsOpen) {
    const Vec3 n = glm::normalize(Vec3(1, 2, -3));
    const std::vector<Surfel> surfels{{{0, 0, 0}, n}};
    EXPECT_LT(glm::length(bent_normals(surfels, Plane{n, 0.0f}, Traced{.rays = 1024}).front() - n), 0.02f);
    EXPECT_EQ(bent_normals(surfels, Buried{}, Traced{}).front(), Vec3(0.0f));
}

/// Bases in all directions, including the axes.
std::vector<Basis> orientations() {
    std::vector<Basis> all{Basis({0, 0, 1}), Basis({0, 0, -1}), Basis({0, 1, 0}), Basis({-1, 0, 0})};
    for (int i = 0; i < 100; ++i) {
        const Vec2 uv = fibonacci_point(i, 100, 0.3f, 0.6f);
        all.emplace_back((i % 2 ? 1.0f : -1.0f) * uniform_hemisphere(uv.x, uv.y));
    }
    return all;
}

TEST(BentNormalOfProbes, IsTheNormalOnPlanesAndBallsAndNothingWhereNothingIsOpen) {
    for (const Basis& basis : orientations()) {
        const Vec3 n = basis.normal;
        const Vec3 on_plane = bent_normals({{{0, 0, 0}, n}}, Plane{n, 0.0f}, Classic{}).front();
        EXPECT_LT(glm::length(on_plane - n), 1e-5f);
        const Vec3 on_ball = bent_normals({{0.2f * n, n}}, Sphere{{0, 0, 0}, 0.2f}, Classic{}).front();
        EXPECT_LT(glm::length(on_ball - n), 1e-5f);
        EXPECT_EQ(bent_normals({{{0, 0, 0}, n}}, Buried{}, Classic{}).front(), Vec3(0.0f));
    }
}

TEST(BentNormalOfProbes, LeansAwayFromAWallTheMoreTheNearerItIs) {
    for (const Basis& floor : orientations())
        for (const float turn : {0.0f, 0.4f, 0.8f, 1.2f}) {
            const Vec3 wall = std::cos(turn) * floor.tangent + std::sin(turn) * floor.bitangent;
            const Union corner(Plane{floor.normal, 0.0f}, Plane{wall, 0.0f});
            float last = 1.0f;
            for (const float away : {0.002f, 0.02f, 0.05f, 0.09f, 0.2f}) {
                const Vec3 bent = bent_normals({{away * wall, floor.normal}}, corner, Classic{.radius = 0.1f}).front();
                const float lean = glm::dot(bent, wall);
                EXPECT_LE(lean, last + 1e-5f);
                EXPECT_LT(std::fabs(glm::dot(bent, glm::cross(wall, floor.normal))), 0.25f);
                last = lean;
                if (away == 0.002f) {
                    // The closed form of the tangent is 2/pi, as above.
                    EXPECT_NEAR(lean / glm::dot(bent, floor.normal), 2.0 / std::numbers::pi, 0.25);
                }
            }
            EXPECT_NEAR(last, 0.0f, 1e-5f);
        }
}

TEST(BentNormalOfProbes, LeansAlongTheBisectorOfASymmetricCorner) {
    for (const Basis& floor : orientations())
        for (const float turn : {0.0f, 0.4f, 0.8f, 1.2f}) {
            const Vec3 one = std::cos(turn) * floor.tangent + std::sin(turn) * floor.bitangent,
                       other = glm::cross(floor.normal, one);
            const Union corner(Plane{floor.normal, 0.0f}, Union(Plane{one, 0.0f}, Plane{other, 0.0f}));
            const Vec3 bent =
                bent_normals({{0.02f * (one + other), floor.normal}}, corner, Classic{.radius = 0.1f}).front();
            const Vec2 lean(glm::dot(bent, one), glm::dot(bent, other));
            EXPECT_GT(glm::dot(lean, glm::normalize(Vec2(1, 1))), 0.2f);
            // Exact only if the probes are symmetric as well.
            EXPECT_NEAR(lean.x, lean.y, turn == 0.0f ? 1e-4f : 0.3f);
        }
}

class BentNormalOfScans : public testing::TestWithParam<const char*> {};

TEST_P(BentNormalOfScans, IsNearerToExactRaysThanTheNormal) {
    const float radius = 0.1f;
    const test::Voxelized scan(read_mesh(std::string(ALCOVE_REAL_MESHES) + "/" + GetParam()), radius, 1.0f / 160);
    const test::ExactSurface exact(scan.mesh, scan.triangles, scan.frame);
    // A few hundred vertices are representative.
    std::vector<Surfel> surfels;
    for (std::size_t v = 0; v < scan.surfels.size(); v += 1 + scan.surfels.size() / 300)
        if (scan.surfels[v].has_normal())
            surfels.push_back(scan.surfels[v]);
    const std::vector<Vec3> traced = bent_normals(surfels, scan.field, Traced{.radius = radius, .rays = 256}),
                            probed = bent_normals(surfels, scan.field, Classic{.radius = radius});
    double of_traced = 0.0, of_probed = 0.0, of_normals = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const Vec3d expected = exact.bent_normal(surfels[i], radius, 1024);
        if (expected == Vec3d(0.0))
            continue;
        const auto angle = [&](const Vec3& v) {
            return std::acos(std::clamp(glm::dot(Vec3d(v), expected), -1.0, 1.0));
        };
        of_traced += angle(traced[i]);
        of_probed += angle(probed[i]);
        of_normals += angle(surfels[i].normal);
        ++count;
    }
    const double degrees = 180.0 / std::numbers::pi / count;
    fmt::print("{}: degrees from the exact bent normal: {:.2f} traced, {:.2f} probes, {:.2f} plain normals\n",
               GetParam(), of_traced * degrees, of_probed * degrees, of_normals * degrees);
    EXPECT_LE(of_traced * degrees, 5.0);
    EXPECT_LT(of_traced, of_probed);
    EXPECT_LE(of_probed, 0.8 * of_normals);
}

INSTANTIATE_TEST_SUITE_P(Scans, BentNormalOfScans,
                         testing::Values("ChineseDragon-10kv.off", "elephant.off", "bear.off", "cow.off", "hand.off"),
                         [](const auto& scan) {
                             const std::string name = scan.param;
                             return name.substr(0, name.find_first_of("-."));
                         });

}
}
