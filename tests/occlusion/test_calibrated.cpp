#include "alcove/occlusion/methods/calibrated.h"

#include "alcove/field/level_stack.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/normals.h"
#include "alcove/occlusion/estimator.h"
#include "exact_distance.h"
#include "real_mesh.h"
#include "reference_scene.h"
#include "shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

namespace alcove {
namespace {

constexpr int sizes[] = {13, 38, 63};

/// A field that counts map() calls.
struct Counted {
    mutable int calls = 0;

    float map(const Vec3& p) const {
        ++calls;
        return p.y;
    }
};

TEST(Calibrated, AsksTheFieldNoOftenerThanItSays) {
    const std::vector<Surfel> surfel(1, Surfel{{0, 0, 0}, {0, 1, 0}});
    for (const auto& [samples, calls] : {std::pair{13, 13}, {37, 13}, {38, 38}, {62, 38}, {63, 63}}) {
        const Counted field;
        SurfelBatch batch;
        batch.push_back(surfel.front());
        SurfelBatch::Values ao;
        Outputs out;
        out[Channel::ao] = ao.data();
        Calibrated{.radius = 0.2f, .samples = samples}(field, batch, out);
        EXPECT_EQ(field.calls, calls);
    }
}

TEST(Calibrated, IsOneOnAPlaneHoweverItLies) {
    for (const Vec3 n : {Vec3(0, 1, 0), Vec3(0, 0, -1), glm::normalize(Vec3(1, -2, 3))})
        for (const float radius : {1e-3f, 0.1f, 10.0f}) {
            const std::vector<Surfel> surfel(1, Surfel{0.5f * n, n});
            for (const int samples : sizes)
                EXPECT_NEAR(evaluate_ao(surfel, Plane{n, 0.5f}, Calibrated{radius, samples}).front(), 1.0f, 1e-2f);
        }
}

TEST(Calibrated, IsOneOnTheFacesOfAVoxelizedBox) {
    const Mesh box = test::box_mesh({1, 1, 1}, 16);
    const std::vector<Triangle> triangles = triangulate(box).triangles;
    const float radius = 0.1f;
    VoxelizeOptions options;
    options.grid.radius = radius;
    const LevelStack field(voxelize(box, triangles, options));
    std::vector<Surfel> middles; // farther than the radius from any edge
    for (const Surfel& s : make_surfels(box, triangles, frame_of(box.box())))
        if (const Vec3 a = glm::abs(s.position); (a.x < 0.15f) + (a.y < 0.15f) + (a.z < 0.15f) == 2)
            middles.push_back(s);
    ASSERT_GT(middles.size(), 100u);
    for (const int samples : sizes)
        for (const float ao : evaluate_ao(middles, field, Calibrated{radius, samples}))
            EXPECT_NEAR(ao, 1.0f, 1e-2f);
}

TEST(Calibrated, DoesNotDependOnTheScaleOfTheScene) {
    const test::ReferenceScene scene;
    const std::vector<Surfel> surfels = scene.surfels(300);
    for (const int samples : sizes) {
        const std::vector<float> unit = evaluate_ao(surfels, scene.field, Calibrated{0.4f, samples});
        for (const float scale : {1e-3f, 1e3f}) {
            std::vector<Surfel> scaled = surfels;
            for (Surfel& s : scaled)
                s.position *= scale;
            const Transformed<decltype(scene.field)> field{scene.field, glm::mat3(1.0f), scale};
            const std::vector<float> ao = evaluate_ao(scaled, field, Calibrated{0.4f * scale, samples});
            for (std::size_t i = 0; i < ao.size(); ++i)
                EXPECT_NEAR(ao[i], unit[i], 1e-3);
        }
    }
}

/// The rings of probes are not rotationally symmetric, so the wall is tried at several angles.
TEST(Calibrated, DarkensTowardAWallWhereverItStands) {
    for (const int samples : sizes)
        for (int turn = 0; turn < 12; ++turn) {
            const float angle = static_cast<float>(turn) * std::numbers::pi_v<float> / 6.0f;
            const Vec3 away(std::cos(angle), 0.0f, std::sin(angle));
            const Union corner(Plane{}, Plane{away, 0.0f});
            double squares = 0.0;
            float before = 0.0f;
            constexpr int steps = 20;
            for (int i = 1; i <= steps; ++i) {
                const float u = static_cast<float>(i) / steps;
                const std::vector<Surfel> surfel(1, Surfel{u * away, {0, 1, 0}});
                const float ao = evaluate_ao(surfel, corner, Calibrated{1.0f, samples}).front();
                const double exact =
                    1.0 - (std::acos(double(u)) - u * std::sqrt(1.0 - double(u) * u)) / std::numbers::pi;
                squares += (ao - exact) * (ao - exact);
                EXPECT_GE(ao, before - 0.02f) << u;
                before = ao;
            }
            fmt::print("wall, {} probes, turn {}: RMSE {:.4f}\n", samples, turn, std::sqrt(squares / steps));
            EXPECT_LE(std::sqrt(squares / steps), 0.05);
        }
}

/// A field of random values, unrelated to any surface.
struct Noise {
    float scale;

    float map(const Vec3& p) const { return scale * (unit_interval(hash(p, 1)) - 0.5f); }
};

TEST(Calibrated, StaysWithinItsBoundsWhateverTheFieldAnswers) {
    const std::vector<Surfel> surfels = test::ReferenceScene().surfels(300);
    for (const int samples : sizes)
        for (const float scale : {0.0f, 1e-6f, 1.0f, 1e30f})
            for (const float radius : {1e-4f, 0.1f, 1e4f})
                for (const float ao : evaluate_ao(surfels, Noise{scale}, Calibrated{radius, samples})) {
                    EXPECT_GE(ao, 0.0f);
                    EXPECT_LE(ao, 1.0f);
                }
}

/// Meshes from the half to which no network was fitted. The RMSE of the best constant is the standard deviation of the
/// truth.
TEST(Calibrated, IsNearExactRaysOnMeshesItNeverSaw) {
    for (const char* name : {"elephant.off", "homer.off"}) {
        const test::RealMesh real(name);
        const std::vector<Surfel> all = make_surfels(real.mesh, real.triangles, real.frame);
        std::vector<Surfel> surfels;
        for (std::size_t i = 0; i < all.size(); i += all.size() / 300)
            surfels.push_back(all[i]);
        const test::ExactSurface exact(real.mesh, real.triangles, real.frame);
        VoxelizeOptions options;
        options.grid.radius = 0.2f;
        const LevelStack field(voxelize(real.mesh, real.triangles, options));
        for (const float radius : {0.05f, 0.2f}) {
            std::vector<double> truth;
            double mean = 0.0, variance = 0.0;
            for (const Surfel& s : surfels)
                truth.push_back(exact.visibility(s, radius, 256));
            for (const double t : truth)
                mean += t / static_cast<double>(truth.size());
            for (const double t : truth)
                variance += (t - mean) * (t - mean) / static_cast<double>(truth.size());
            for (const int samples : sizes) {
                const std::vector<float> ao = evaluate_ao(surfels, field, Calibrated{radius, samples});
                double squares = 0.0;
                for (std::size_t i = 0; i < ao.size(); ++i)
                    squares += (ao[i] - truth[i]) * (ao[i] - truth[i]);
                const double rmse = std::sqrt(squares / static_cast<double>(ao.size()));
                fmt::print("{}, radius {}, {} probes: RMSE {:.4f}, deviation of the truth {:.4f}\n", name, radius,
                           samples, rmse, std::sqrt(variance));
                EXPECT_LE(rmse, 0.5 * std::sqrt(variance));
                EXPECT_LE(rmse, samples == 13 ? (radius < 0.1f ? 0.045 : 0.085) : (radius < 0.1f ? 0.038 : 0.065));
            }
        }
    }
}

}
}
