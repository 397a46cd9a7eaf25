#include "alcove/bake/detail/pilot.h"
#include "alcove/occlusion/methods/exact.h"

#include "alcove/measure/measure.h"
#include "alcove/occlusion/detail/subset.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr float radius = 0.3f;

/// Two spheres side by side, nearly touching: 2,052 vertices, unoccluded except between the spheres.
class Piloting : public testing::Test {
  protected:
    static Mesh two_spheres() {
        Mesh mesh = test::sphere_mesh(4);
        test::add_part(mesh, test::sphere_mesh(4), 1.0, {2.1, 0, 0});
        return mesh;
    }

    const MeasuredMesh mesh_{"spheres", two_spheres()};
    const Truth truth_ = make_truth(mesh_, radius, {.rays = 4096});
    static constexpr PilotOptions options{.surfels = 1024, .rays = 512};
    const Pilot pilot_{mesh_.surfels, mesh_.rays, radius, options};
};

TEST_F(Piloting, FindsTheErrorOfAWholeBake) {
    ASSERT_GT(mesh_.surfels.size(), options.surfels);
    for (const int rays : {2, 16, 64}) {
        const std::vector<float> ao = evaluate_ao(mesh_.surfels, mesh_.rays, Exact{.radius = radius, .rays = rays});
        double squares = 0.0;
        for (std::size_t i = 0; i < truth_.vertices.size(); ++i)
            squares += std::pow(ao[truth_.vertices[i]] - truth_.ao[i], 2);
        const double rmse = std::sqrt(squares / static_cast<double>(truth_.vertices.size()));
        EXPECT_NEAR(pilot_.rmse(ao), rmse, 0.15 * rmse) << rays;
        EXPECT_DOUBLE_EQ(pilot_.rmse_of_exact(rays, 0), pilot_.rmse(ao)) << rays;
    }
}

TEST_F(Piloting, TakesTheNoiseOfItsReferenceOffErrors) {
    // With few rays, the reference is as noisy as the values that it judges.
    const Pilot noisy(mesh_.surfels, mesh_.rays, radius, {.surfels = 2000, .rays = 16});
    std::vector<float> ao(mesh_.surfels.size());
    for (std::size_t i = 0; i < truth_.vertices.size(); ++i)
        ao[truth_.vertices[i]] = truth_.ao[i];
    EXPECT_LT(noisy.rmse(ao), 0.01);
    for (float& value : ao)
        value += 0.05f;
    EXPECT_NEAR(noisy.rmse(ao), 0.05, 0.005);
}

TEST_F(Piloting, TellsHowHardATruthIs) {
    const std::vector<std::uint32_t> curve = evenly(spatial_order(mesh_.surfels), options.surfels);
    std::vector<float> truth(mesh_.surfels.size());
    for (std::size_t i = 0; i < truth_.vertices.size(); ++i)
        truth[truth_.vertices[i]] = truth_.ao[i];
    double steps2 = 0.0;
    for (std::size_t i = 1; i < curve.size(); ++i)
        steps2 += std::pow(truth[curve[i]] - truth[curve[i - 1]], 2) / 2.0;
    const double step = std::sqrt(steps2 / static_cast<double>(curve.size() - 1));
    const double expected = std::sqrt(step * pilot_.rmse_of_exact(16, 3));
    EXPECT_NEAR(pilot_.difficulty(), expected, 0.1 * expected);
    const Pilot noisy(mesh_.surfels, mesh_.rays, radius, {.rays = 64});
    EXPECT_NEAR(noisy.difficulty(), expected, 0.15 * expected) << "independent of the numbers of surfels and rays";
}

TEST(PilotFor, TakesMoreRaysOfFewerSurfelsTheSmallerTheError) {
    double rays = 0.0;
    for (const double error : {0.5, 0.05, 0.03, 0.02, 0.01, 0.005, 0.001}) {
        const PilotOptions options = pilot_for(error);
        if (error >= 0.005 && error <= 0.03) {
            EXPECT_EQ(options.surfels * static_cast<std::size_t>(options.rays), 4096u * 128u);
        }
        EXPECT_GE(options.rays, rays);
        EXPECT_GE(options.surfels, 1024u);
        rays = options.rays;
    }
    EXPECT_EQ(pilot_for(0.05).surfels, 4096u);
    EXPECT_EQ(pilot_for(0.05).rays, 64);
    EXPECT_EQ(pilot_for(0.005).surfels, 1024u);
}

TEST_F(Piloting, TellsSmallErrorsOfManyRaysByMany) {
    const std::vector<float> ao = evaluate_ao(mesh_.surfels, mesh_.rays, Exact{.radius = radius, .rays = 1024});
    const double known = Pilot(mesh_.surfels, mesh_.rays, radius, {.surfels = 4096, .rays = 4096}).rmse(ao);
    ASSERT_GT(known, 0.0);
    EXPECT_NEAR(Pilot(mesh_.surfels, mesh_.rays, radius, pilot_beside(1024)).rmse(ao), known, 0.5 * known);
    EXPECT_EQ(pilot_beside(1024).rays, 512);
    EXPECT_EQ(pilot_beside(0).surfels, 4096u);
}

TEST_F(Piloting, TellsHowManyRaysHoldAnError) {
    int fewer = 0;
    for (const double error : {0.05, 0.02, 0.005}) {
        const int rays = pilot_.rays_for(error, 7);
        EXPECT_GT(rays, fewer);
        const double rmse = pilot_.rmse_of_exact(rays, 7);
        EXPECT_LE(rmse, error);
        EXPECT_GT(rmse, 0.7 * error);
        fewer = rays;
    }
}

/// The noise of the reference must not hide the error, or the rays would never be enough.
TEST_F(Piloting, FindsTheRaysOfAVerySmallError) {
    const Pilot pilot(mesh_.surfels, mesh_.rays, radius, pilot_for(0.001));
    const int rays = pilot.rays_for(0.001, 7);
    EXPECT_LT(rays, 8192);
    EXPECT_NEAR(pilot.rmse_of_exact(rays, 7), 0.001, 0.0003);
}

TEST_F(Piloting, MeasuresErrorsAtOtherSurfelsThanItsLabels) {
    ASSERT_TRUE(pilot_.labels());
    EXPECT_EQ(pilot_.labels()->surfels.size(), options.surfels / 4);
    std::vector<float> ao(mesh_.surfels.size());
    for (std::size_t i = 0; i < truth_.vertices.size(); ++i)
        ao[truth_.vertices[i]] = truth_.ao[i];
    for (std::size_t i = 0; i < pilot_.labels()->surfels.size(); ++i) {
        const auto label = std::find_if(mesh_.surfels.begin(), mesh_.surfels.end(), [&](const Surfel& s) {
            return s.position == pilot_.labels()->surfels[i].position;
        });
        float& value = ao[static_cast<std::size_t>(label - mesh_.surfels.begin())];
        EXPECT_NEAR(pilot_.labels()->ao[i], value, 0.02f);
        value = 1.0f - value; // without effect on the pilot
    }
    EXPECT_LT(pilot_.rmse(ao), 0.005);
    const MeasuredMesh small("sphere", test::sphere_mesh(2));
    EXPECT_FALSE(Pilot(small.surfels, small.rays, radius, options).labels());
}

TEST_F(Piloting, OfNoSurfelIsEmpty) {
    const Pilot nothing(std::vector<Surfel>{{{0, 0, 0}, {0, 0, 0}}}, mesh_.rays, radius);
    EXPECT_TRUE(nothing.empty());
    EXPECT_FALSE(pilot_.empty());
    EXPECT_EQ(nothing.rmse(std::vector<float>{1.0f}), 0.0);
    EXPECT_EQ(nothing.difficulty(), 0.0);
}

}
}
