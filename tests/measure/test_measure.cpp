#include "alcove/measure/measure.h"

#include "alcove/base/types.h"
#include "alcove/measure/detail/heat_map.h"

#include "shapes.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

/// Two spheres side by side, nearly touching: 516 vertices, open except between the spheres.
Mesh two_spheres() {
    Mesh mesh = test::sphere_mesh(3);
    test::add_part(mesh, test::sphere_mesh(3), 1.0, {2.1, 0, 0});
    return mesh;
}

class Measuring : public testing::Test {
  protected:
    Measurement measured(const char* method, int samples) const {
        return measure(mesh_, truth_, &grid_, choose(find_method(method), samples));
    }

    MeasuredMesh mesh_{"spheres", two_spheres()};
    Truth truth_ = make_truth(mesh_, 0.3f);
    MeasuredGrid grid_ = build_grid(mesh_, 0.3f, 0.01f);
};

TEST_F(Measuring, ComparesExactRaysWithTheTruth) {
    const Measurement many = measured("exact", 1024), few = measured("exact", 4);
    EXPECT_EQ(many.label(), "exact:1024");
    EXPECT_EQ(many.vertices, 516u);
    EXPECT_EQ(many.error.count, 516u);
    EXPECT_GT(many.error.deviation, 0.05);
    EXPECT_GT(many.error.rmse, 0.0) << "shares its rays with the truth";
    EXPECT_LT(many.error.rmse, 0.01);
    EXPECT_GT(few.error.rmse, 4.0 * many.error.rmse);
    EXPECT_EQ(many.rays, 1024.0);
    EXPECT_GT(many.occlusion_seconds, few.occlusion_seconds);
    EXPECT_GT(many.tree_seconds, 0.0);
    EXPECT_EQ(many.grid_seconds + many.map_calls + static_cast<double>(many.grid_bytes + many.levels), 0.0);
}

TEST_F(Measuring, CountsTheCallsOfMap) {
    EXPECT_EQ(measured("classic", 7).map_calls, 7.0);
    EXPECT_EQ(measured("calibrated", 38).map_calls, 38.0);
    EXPECT_EQ(measured("guided", 3).map_calls, 38.0);
    const double traced = measured("traced", 16).map_calls;
    EXPECT_GT(traced, 6.0 + 16.0);
    EXPECT_LT(traced, 6.0 + 16.0 * 40.0);
}

TEST_F(Measuring, LeavesMostOfASmallMeshForTheTruth) {
    const MeasuredMesh small("sphere", test::sphere_mesh(3)); // 258 vertices
    const Truth truth = make_truth(small, 0.3f, {.rays = 64, .labels = labels_of_pilot});
    ASSERT_TRUE(truth.labels);
    EXPECT_EQ(truth.labels->surfels.size(), 64u);
    EXPECT_EQ(truth.vertices.size(), 258u - 64u);
}

TEST_F(Measuring, CountsTheGridToThoseThatProbeIt) {
    const Measurement classic = measured("classic", 5);
    EXPECT_EQ(classic.grid_seconds, grid_.seconds);
    EXPECT_EQ(classic.grid_bytes, grid_.bytes);
    EXPECT_EQ(classic.tree_seconds, 0.0);
    EXPECT_NEAR(classic.voxel, 0.01, 1e-6);
    EXPECT_GT(classic.active_voxels, 10'000u);
    EXPECT_GE(classic.peak_rss_bytes, classic.grid_bytes);
    EXPECT_DOUBLE_EQ(classic.seconds(), classic.grid_seconds + classic.occlusion_seconds);
    EXPECT_GT(measured("guided", 1).tree_seconds, 0.0);
    EXPECT_THROW(measure(mesh_, truth_, nullptr, choose(find_method("classic"))), InputError);
}

TEST_F(Measuring, TakesTheTruthOfSomeForAll) {
    const Truth some = make_truth(mesh_, 0.3f, {.rays = 1024, .most = 64});
    ASSERT_EQ(some.vertices.size(), 64u);
    const Measurement part = measure(mesh_, some, &grid_, choose(find_method("classic")));
    const Measurement all = measured("classic", 5);
    EXPECT_EQ(part.error.count, 64u);
    EXPECT_NEAR(part.error.rmse, all.error.rmse, 0.35 * all.error.rmse);
    // The truth of a vertex does not depend on the other vertices.
    std::size_t at = 0;
    for (std::size_t i = 0; i < some.vertices.size(); ++i) {
        while (truth_.vertices[at] != some.vertices[i])
            ASSERT_LT(++at, truth_.vertices.size());
        EXPECT_EQ(some.ao[i], truth_.ao[at]);
    }
}

TEST_F(Measuring, PaintsErrorsAsAPictureOfItsOwn) {
    const std::string right = heat_map(mesh_.mesh, mesh_.triangles, std::vector<float>(516, 0.0f));
    EXPECT_TRUE(right.starts_with("data:image/png;base64,iVBORw0KGgo")) << "the signature of a PNG";
    EXPECT_EQ((right.size() - right.find(',') - 1) % 4, 0u);
    const std::string wrong = heat_map(mesh_.mesh, mesh_.triangles, std::vector<float>(516, 1.0f));
    EXPECT_NE(wrong, right);
    EXPECT_EQ(heat_map(mesh_.mesh, mesh_.triangles, std::vector<float>(516, -1.0f)), wrong);
    EXPECT_TRUE(measured("classic", 5).picture.empty());
}

TEST(MeasuredMesh, NeedsAVertexWithANormal) {
    Mesh points;
    points.positions = {{0, 0, 0}, {1, 0, 0}};
    EXPECT_THROW(MeasuredMesh("points", points), InputError);
}

}
}
