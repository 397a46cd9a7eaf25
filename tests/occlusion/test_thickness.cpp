#include "alcove/occlusion/methods/thickness.h"

#include "alcove/field/primitives.h"
#include "alcove/occlusion/estimator.h"
#include "shapes.h"
#include "voxelized.h"

#include <gtest/gtest.h>

#include <limits>

namespace alcove {
namespace {

template <class F>
std::vector<float> thickness(const std::vector<Surfel>& surfels, const F& field, float radius) {
    return evaluate(surfels, field, Thickness{.radius = radius}, Channel::thickness)[Channel::thickness];
}

TEST(Thickness, OfExactShapes) {
    const std::vector<Surfel> top{{{0.1f, 0.3f, 0.2f}, {0, 1, 0}}};
    EXPECT_NEAR(thickness(top, Cuboid{{0, 0, 0}, {1, 0.3f, 1}}, 2.0f).front(), 0.6f, 1e-3f);
    EXPECT_EQ(thickness(top, Cuboid{{0, 0, 0}, {1, 0.3f, 1}}, 0.5f).front(), 0.5f);
    const Vec3 n = glm::normalize(Vec3(1, 2, 3));
    EXPECT_NEAR(thickness({{0.7f * n, n}}, Sphere{{0, 0, 0}, 0.7f}, 2.0f).front(), 1.4f, 1e-3f);
}

// Against an inward normal there is no solid. Where nothing limits the ray, the thickness is the radius or twice the
// extent.
TEST(Thickness, AgainstInwardNormalsAndWithoutAFarSide) {
    const Mesh sphere = test::sphere_mesh(4);
    const test::Voxelized ball(sphere, 0.3f, 1.0f / 64);
    std::vector<Surfel> inward;
    for (const Surfel& surfel : ball.surfels)
        inward.push_back({surfel.position, -surfel.normal});
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (const float radius : {0.3f, infinite})
        for (const float t : thickness(inward, ball.field, radius))
            EXPECT_LE(t, 1.0f / 64);
    const Plane solid{{0, 1, 0}, 0.0f};
    EXPECT_EQ(thickness({{{0, 0, 0}, {0, 1, 0}}}, solid, 0.3f).front(), 0.3f);
    EXPECT_EQ(thickness({{{0, 0, 0}, {0, 1, 0}}}, solid, infinite).front(), longest_ray(solid, infinite));
}

TEST(Thickness, IsOfTheFirstPlateWhereMoreStandBehind) {
    for (const float thick : {0.003f, 0.01f, 0.03f, 0.1f, 0.3f})
        for (const float gap : {0.002f, 0.02f, 0.2f}) {
            const Union plates(Cuboid{{0, -thick / 2, 0}, {2, thick / 2, 2}},
                               Cuboid{{0, -thick - gap - 0.5f, 0}, {2, 0.5f, 2}});
            const std::vector<Surfel> top{{{0.1f, 0, 0.2f}, {0, 1, 0}}};
            EXPECT_NEAR(thickness(top, plates, 0.7f).front(), thick, 1e-3f);
        }
}

/// A plate measured at points away from its rim, not aligned with the planes of the grid.
class ThicknessOfPlates : public testing::TestWithParam<double> {};

TEST_P(ThicknessOfPlates, IsWithinAVoxel) {
    constexpr float voxel = 1.0f / 64, radius = 0.2f;
    // In units of the diagonal, which is computed without the thickness of the plate.
    const double thick = GetParam() * voxel;
    const double half = 0.5 / std::sqrt(2.0);
    const Mesh solid = test::box_mesh({half, half, thick / 2}, 1);
    // Two parallel sheets: the plate without its rim.
    Mesh sheets;
    sheets.positions = solid.positions;
    for (std::size_t f = 0; f < solid.face_count(); ++f) {
        const double z = solid.positions[solid.face(f)[0]].z;
        if (std::all_of(solid.face(f).begin(), solid.face(f).end(),
                        [&](std::uint32_t v) { return solid.positions[v].z == z; }))
            sheets.add_face(solid.face(f));
    }
    ASSERT_EQ(sheets.face_count(), 2u);
    for (const Mesh& mesh : {solid, sheets}) {
        SCOPED_TRACE(mesh.face_count() == 6 ? "solid" : "sheets");
        if (mesh.face_count() == 2 && GetParam() < 1.9)
            continue; // missed, as documented in the header
        const test::Voxelized plate(mesh, radius, voxel);
        EXPECT_EQ(plate.field.two_sided(), mesh.face_count() == 2);
        std::vector<Surfel> surfels;
        for (int i = 0; i < 20; ++i)
            for (const double side : {1.0, -1.0})
                surfels.push_back(
                    {plate.frame.to_unit({0.0213 * (i - 10), 0.0107 * (i - 5), side * thick / 2}), {0, 0, side}});
        for (const float found : thickness(surfels, plate.field, radius))
            EXPECT_NEAR(found, thick / plate.frame.diagonal, voxel);
    }
}

INSTANTIATE_TEST_SUITE_P(Voxels, ThicknessOfPlates, testing::Values(1.5, 2.3, 2.6, 3.0, 3.3, 4.4, 5.2, 6.0, 10.0, 10.5),
                         [](const auto& voxels) { return std::to_string(static_cast<int>(voxels.param * 100)); });

TEST(Thickness, OfAVoxelizedSphereIsItsDiameter) {
    const test::Voxelized sphere(test::sphere_mesh(5), 0.7f, 1.0f / 100);
    const double diameter = 2.0 / sphere.frame.diagonal;
    for (const float found : thickness(sphere.surfels, sphere.field, 0.7f))
        EXPECT_NEAR(found, diameter, sphere.field.resolution());
    for (const float found : thickness(sphere.surfels, sphere.field, 0.2f))
        EXPECT_EQ(found, 0.2f);
}

}
}
