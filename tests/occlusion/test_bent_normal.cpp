/// The bent normal of Traced: in closed form, and against exact rays on scans.
#include "alcove/occlusion/methods/traced.h"

#include "alcove/field/combine.h"
#include "alcove/field/primitives.h"
#include "alcove/mesh/read.h"
#include "alcove/occlusion/bake.h"
#include "exact_distance.h"
#include "voxelized.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

namespace alcove {
namespace {

template <class F>
std::vector<Vec3> bent_normals(const std::vector<Surfel>& surfels, const F& field, const Traced& traced) {
    const std::vector<float> values =
        bake_channels(surfels, field, traced, Channel::bent_normal)[Channel::bent_normal];
    std::vector<Vec3> bent;
    for (std::size_t i = 0; i < values.size(); i += 3)
        bent.emplace_back(values[i], values[i + 1], values[i + 2]);
    return bent;
}

/// Half of the sky is hidden at the foot of an endless wall: the mean over the quarter of a sphere, weighted by
/// the cosine, lies between the wall's normal and the floor's at tan = (4/3) / (2 pi/3) = 2/pi.
TEST(BentNormal, AtTheFootOfAWallInClosedForm) {
    const Union corner(Plane{}, Plane{{1, 0, 0}, 0.0f});
    const std::vector<Surfel> surfels{{{0.001f, 0, 0}, {0, 1, 0}}};
    const Vec3d expected = glm::normalize(Vec3d(2.0 / std::numbers::pi, 1, 0));
    for (const bool cosine_weighted : {true, false}) {
        const Vec3 bent =
            bent_normals(surfels, corner, {.radius = 1.0f, .rays = 4096, .cosine_weighted = cosine_weighted})
                .front();
        EXPECT_NEAR(glm::length(Vec3d(bent) - expected), 0.0, 0.01);
    }
}

TEST(BentNormal, IsTheNormalInTheOpenAndNothingWhereNothingIsOpen) {
    const Vec3 n = glm::normalize(Vec3(1, 2, -3));
    const std::vector<Surfel> surfels{{{0, 0, 0}, n}};
    EXPECT_LT(glm::length(bent_normals(surfels, Plane{n, 0.0f}, {.rays = 1024}).front() - n), 0.02f);
    struct Buried {
        float map(const Vec3&) const { return -1.0f; }
    };
    EXPECT_EQ(bent_normals(surfels, Buried{}, {}).front(), Vec3(0.0f));
}

class BentNormalOfScans : public testing::TestWithParam<const char*> {};

TEST_P(BentNormalOfScans, IsWithinFiveDegreesOfExactRays) {
    const float radius = 0.1f;
    const test::Voxelized scan(read_mesh(std::string(ALCOVE_REAL_MESHES) + "/" + GetParam()), radius,
                               1.0f / 160);
    const test::ExactSurface exact(scan.mesh, scan.triangles, scan.frame);
    // Some hundreds of its vertices tell as much as all.
    std::vector<Surfel> surfels;
    for (std::size_t v = 0; v < scan.surfels.size(); v += 1 + scan.surfels.size() / 300)
        if (scan.surfels[v].has_normal())
            surfels.push_back(scan.surfels[v]);
    const std::vector<Vec3> bent = bent_normals(surfels, scan.field, {.radius = radius, .rays = 256});
    double sum = 0.0, of_normals = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const Vec3d expected = exact.bent_normal(surfels[i], radius, 1024);
        if (expected == Vec3d(0.0))
            continue;
        const auto angle = [&](const Vec3& v) {
            return std::acos(std::clamp(glm::dot(Vec3d(v), expected), -1.0, 1.0));
        };
        sum += angle(bent[i]);
        of_normals += angle(surfels[i].normal);
        ++count;
    }
    const double degrees = 180.0 / std::numbers::pi / count;
    fmt::print("{}: {:.2f} degrees from the exact bent normal; the normals are {:.2f}\n", GetParam(),
               sum * degrees, of_normals * degrees);
    EXPECT_LE(sum * degrees, 5.0);
    EXPECT_LT(sum, of_normals);
}

INSTANTIATE_TEST_SUITE_P(Scans, BentNormalOfScans,
                         testing::Values("ChineseDragon-10kv.off", "elephant.off", "bear.off", "cow.off",
                                         "hand.off"),
                         [](const auto& scan) {
                             const std::string name = scan.param;
                             return name.substr(0, name.find_first_of("-."));
                         });

}
}
