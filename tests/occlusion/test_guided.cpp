/// guided against closed forms: filtering must improve on the rays of single surfels, and must not mix surfels with
/// different surroundings.
#include "alcove/occlusion/methods/guided.h"

#include "alcove/field/level_stack.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/normals.h"
#include "exact_distance.h"
#include "real_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alcove {
namespace {

constexpr double pi = std::numbers::pi;

struct Quads {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;

    Quads& add(const Vec3& corner, const Vec3& along, const Vec3& across) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {corner, corner + along, corner + along + across, corner + across});
        triangles.insert(triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
        return *this;
    }
    /// A large square at y = height.
    Quads& add_plane(float height) { return add({-50, height, -50}, {100, 0, 0}, {0, 0, 100}); }
    RaySurface surface() const { return {positions, triangles}; }
};

std::vector<float> guided(const std::vector<Surfel>& surfels, const AnyField& field, const RaySurface& surface,
                          const Guided& method) {
    return evaluate(surfels, field, surface, method, Channel::ao)[Channel::ao];
}

/// A floor at y = 0 and a wall at x = 0, and 100 × 100 surfels on the floor within 0.2 of it.
struct Corner {
    AnyField field{Union(Plane{}, Plane{{1, 0, 0}, 0.0f})};
    RaySurface surface = Quads{}.add_plane(0).add({0, 0, -50}, {0, 50, 0}, {0, 0, 100}).surface();
    std::vector<Surfel> surfels;
    static constexpr float radius = 0.1f;

    Corner() {
        for (int i = 0; i < 10000; ++i)
            surfels.push_back(
                {{0.002f * (static_cast<float>(i % 100) + 0.5f), 0, 0.002f * static_cast<float>(i / 100)}, {0, 1, 0}});
    }
    static double truth(const Surfel& surfel) {
        const double u = std::min(1.0, double(surfel.position.x) / radius);
        return 1.0 - (std::acos(u) - u * std::sqrt(1.0 - u * u)) / pi;
    }
    double rmse(const std::vector<float>& ao) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < ao.size(); ++i)
            sum += std::pow(ao[i] - truth(surfels[i]), 2);
        return std::sqrt(sum / static_cast<double>(ao.size()));
    }
};

TEST(Guided, FewSharedRaysAreWorthTenTimesAsManyAlone) {
    const Corner corner;
    for (const int rays : {1, 2, 4}) {
        const Guided method{.radius = Corner::radius, .rays = rays};
        const auto alone =
            evaluate_ao(corner.surfels, corner.surface, Exact{.radius = Corner::radius, .rays = 10 * rays});
        EXPECT_LT(corner.rmse(guided(corner.surfels, corner.field, corner.surface, method)), corner.rmse(alone))
            << rays;
    }
}

TEST(Guided, StaysSharpInTheCrevice) {
    const Corner corner;
    const std::vector<float> ao =
        guided(corner.surfels, corner.field, corner.surface, {.radius = Corner::radius, .rays = 4});
    double bias = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < ao.size(); ++i)
        if (corner.surfels[i].position.x < 0.1f * Corner::radius) {
            bias += ao[i] - Corner::truth(corner.surfels[i]);
            ++count;
        }
    EXPECT_LT(std::fabs(bias / count), 0.01);
}

TEST(Guided, TendsToExact) {
    const test::RealMesh real("elephant.off");
    const std::vector<Surfel> surfels = make_surfels(real.mesh, real.triangles, real.frame);
    std::vector<Vec3> positions;
    for (const Surfel& surfel : surfels)
        positions.push_back(surfel.position);
    const RaySurface surface(positions, real.triangles);
    const auto truth = evaluate_ao(surfels, surface, Exact{.radius = 0.1f, .rays = 4096, .seed = 9});
    // A field without information about the neighbours: the worst case.
    const AnyField nothing(Plane{{0, 1, 0}, -10.0f});
    double previous = 1.0;
    for (const int rays : {4, 32, 256, 1024}) {
        const auto ao = guided(surfels, nothing, surface, {.radius = 0.1f, .rays = rays});
        double sum = 0.0;
        for (std::size_t i = 0; i < ao.size(); ++i)
            sum += std::pow(ao[i] - truth[i], 2);
        const double rmse = std::sqrt(sum / static_cast<double>(ao.size()));
        EXPECT_LT(rmse, previous);
        previous = rmse;
    }
    EXPECT_LT(previous, 0.006);
}

TEST(Guided, WhatIsTheSameEverywhereStays) {
    std::vector<Surfel> surfels;
    for (int i = 0; i < 3000; ++i)
        surfels.push_back({{0.001f * static_cast<float>(i % 60), 0, 0.001f * static_cast<float>(i / 60)}, {0, 1, 0}});
    for (const float ao : guided(surfels, Plane{}, Quads{}.add_plane(0).surface(), {.rays = 2}))
        EXPECT_NEAR(ao, 1.0f, 1e-5f);
    for (const float ao :
         guided(surfels, Plane{}, Quads{}.add_plane(0).add_plane(0.01f).surface(), {.radius = 100.0f, .rays = 2}))
        EXPECT_NEAR(ao, 0.0f, 1e-5f);
}

/// A plate 0.02 above the floor, whose thickness is half the spacing of its surfels. Its upper side is open. Its lower
/// side is open only along the gap, where cos θ < 0.02/R: a share of (0.02/R)².
TEST(Guided, NothingLeaksThroughAThinPlate) {
    constexpr float thickness = 5e-4f, gap = 0.02f, radius = 0.1f;
    const RaySurface surface = Quads{}.add_plane(0).add_plane(gap).add_plane(gap + thickness).surface();
    const Union field(Plane{}, Cuboid{{0, gap + 0.5f * thickness, 0}, {50, 0.5f * thickness, 50}});
    std::vector<Surfel> surfels;
    for (int i = 0; i < 10000; ++i) {
        const float x = 0.001f * static_cast<float>(i / 2 % 70), z = 0.001f * static_cast<float>(i / 140);
        surfels.push_back(i % 2 ? Surfel{{x, gap + thickness, z}, {0, 1, 0}} : Surfel{{x, gap, z}, {0, -1, 0}});
    }
    const std::vector<float> ao = guided(surfels, field, surface, {.radius = radius, .rays = 4});
    double below = 0.0;
    for (std::size_t i = 0; i < ao.size(); ++i)
        if (i % 2)
            EXPECT_NEAR(ao[i], 1.0f, 1e-5f);
        else
            below += ao[i] / (0.5 * static_cast<double>(ao.size()));
    EXPECT_NEAR(below, (gap / radius) * (gap / radius), 0.005);
}

/// The plate again, with a grid whose voxel is twice the thickness of the plate: the sides must not influence each
/// other.
TEST(Guided, NothingLeaksThroughAPlateOfHalfAVoxel) {
    constexpr std::uint32_t quads = 80;
    constexpr double voxel = 1.0 / 128, gap = 0.05;
    Mesh mesh;
    const auto add_sheet = [&](double height, bool up) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t i = 0; i <= quads; ++i)
            for (std::uint32_t j = 0; j <= quads; ++j)
                mesh.positions.emplace_back(double(i) / quads - 0.5, height, double(j) / quads - 0.5);
        for (std::uint32_t i = 0; i < quads; ++i)
            for (std::uint32_t j = 0; j < quads; ++j) {
                const std::uint32_t a = first + i * (quads + 1) + j, b = a + 1, c = b + quads + 1, d = a + quads + 1;
                if (up)
                    mesh.add_face(std::array{a, b, c, d});
                else
                    mesh.add_face(std::array{d, c, b, a});
            }
    };
    add_sheet(0.0, true);
    const double thickness = 0.5 * voxel * std::sqrt(2.0 + gap * gap);
    add_sheet(gap, false);
    add_sheet(gap + thickness, true);
    const auto triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    const std::vector<Surfel> surfels = make_surfels(mesh, triangles, frame);
    std::vector<Vec3> positions;
    for (const Surfel& surfel : surfels)
        positions.push_back(surfel.position);
    const RaySurface surface(positions, triangles);
    const LevelStack field(voxelize(mesh, triangles, {.grid = {.radius = 0.1f, .voxel = float(voxel)}}));
    const std::vector<float> ao = guided(surfels, field, surface, {.radius = 0.1f, .rays = 4});
    const std::vector<float> exact = evaluate_ao(surfels, surface, Exact{.radius = 0.1f, .rays = 1024});
    double below = 0.0;
    int count = 0;
    for (std::size_t i = surfels.size() / 3; i < surfels.size(); ++i) {
        const Vec3 p = Vec3(mesh.positions[i]);
        if (std::max(std::fabs(p.x), std::fabs(p.z)) > 0.3f)
            continue;
        if (i >= 2 * surfels.size() / 3) {
            EXPECT_GT(ao[i], 0.98f) << "above";
        } else {
            below += ao[i] - exact[i];
            ++count;
        }
    }
    EXPECT_NEAR(below / count, 0.0, 0.02);
}

/// Open ground and the dark walls of a slot meet in a right-angled edge.
TEST(Guided, NothingLeaksAroundASharpEdge) {
    constexpr float half = 0.04f;
    Quads quads;
    quads.add({-50, 0, -50}, {50 - half, 0, 0}, {0, 0, 100}).add({half, 0, -50}, {50, 0, 0}, {0, 0, 100});
    for (const float x : {-half, half})
        quads.add({x, 0, -50}, {0, -1, 0}, {0, 0, 100});
    const Union field(Cuboid{{-half - 25, -0.5f, 0}, {25, 0.5f, 50}}, Cuboid{{half + 25, -0.5f, 0}, {25, 0.5f, 50}});
    std::vector<Surfel> surfels;
    for (int i = 0; i < 8000; ++i) {
        const float along = 0.0005f * static_cast<float>(i / 2 % 40), z = 0.0005f * static_cast<float>(i / 80);
        surfels.push_back(i % 2 ? Surfel{{half + along, 0, z}, {0, 1, 0}} : Surfel{{half, -along, z}, {-1, 0, 0}});
    }
    const std::vector<float> ao = guided(surfels, field, quads.surface(), {.radius = 0.1f, .rays = 4});
    const std::vector<float> exact = evaluate_ao(surfels, quads.surface(), Exact{.radius = 0.1f, .rays = 1024});
    std::array<double, 40> bias{}; // bias on the walls, by depth
    for (std::size_t i = 0; i < ao.size(); ++i) {
        if (i % 2) {
            EXPECT_NEAR(ao[i], 1.0f, 0.002f); // the model also has to fit the walls
        } else {
            bias[i / 2 % 40] += (ao[i] - exact[i]) / 100.0;
        }
    }
    for (std::size_t depth = 0; depth < 8; ++depth)
        EXPECT_NEAR(bias[depth], 0.0, 0.02) << depth;
}

TEST(Guided, SharesBentNormalsToo) {
    const Corner corner;
    const auto bent = [&](const ChannelValues& baked, std::size_t i) {
        const float* v = baked[Channel::bent_normal].data() + 3 * i;
        return Vec3(v[0], v[1], v[2]);
    };
    const ChannelSet wanted = Channel::ao | Channel::bent_normal;
    const float radius = Corner::radius;
    const auto truth = evaluate(corner.surfels, corner.surface, Exact{radius, 1024, 3}, wanted);
    const auto alone = evaluate(corner.surfels, corner.surface, Exact{radius, 16}, wanted);
    const auto shared = evaluate(corner.surfels, corner.field, corner.surface, Guided{radius, 4}, wanted);
    double error_alone = 0.0, error_shared = 0.0;
    for (std::size_t i = 0; i < corner.surfels.size(); ++i) {
        EXPECT_NEAR(glm::length(bent(shared, i)), 1.0f, 1e-5f);
        error_alone += std::pow(glm::length(bent(alone, i) - bent(truth, i)), 2);
        error_shared += std::pow(glm::length(bent(shared, i) - bent(truth, i)), 2);
    }
    EXPECT_LT(error_shared, error_alone);
}

TEST(Guided, DependsOnNeitherOrderNorThreads) {
    Corner corner;
    // Seams: duplicate positions, with the same normal and with a different one.
    for (std::size_t i = 0; i < 500; ++i) {
        corner.surfels.push_back(corner.surfels[7 * i]);
        corner.surfels.push_back({corner.surfels[5 * i].position, glm::normalize(Vec3(0.1f, 1, 0))});
    }
    corner.surfels[3].normal = Vec3(0.0f);
    const Guided method{.radius = Corner::radius, .rays = 2};
    const std::vector<float> ao = guided(corner.surfels, corner.field, corner.surface, method);
    EXPECT_EQ(ao[3], 1.0f);
    EXPECT_EQ(ao[7 * 11], ao[10000 + 2 * 11]);
    const std::vector<Surfel> reversed(corner.surfels.rbegin(), corner.surfels.rend());
    const std::vector<float> backward = guided(reversed, corner.field, corner.surface, method);
    EXPECT_TRUE(std::equal(ao.begin(), ao.end(), backward.rbegin()));
    {
        const ThreadLimit one(1);
        EXPECT_EQ(guided(corner.surfels, corner.field, corner.surface, method), ao);
    }
    EXPECT_NE(guided(corner.surfels, corner.field, corner.surface, {Corner::radius, 2, 1}), ao);
}

TEST(Guided, TakesFewSurfelsAndNone) {
    const Corner corner;
    EXPECT_TRUE(guided({}, corner.field, corner.surface, {}).empty());
    EXPECT_EQ(guided({{{0, 0, 0}, {0, 0, 0}}}, corner.field, corner.surface, {}), std::vector<float>{1.0f});
    const std::vector<Surfel> three{{{0.5f, 0, 0}, {0, 1, 0}}, {{0.6f, 0, 0}, {0, 1, 0}}, {{0.6f, 0, 0}, {0, 1, 0}}};
    for (const float ao : guided(three, corner.field, corner.surface, {}))
        EXPECT_NEAR(ao, 1.0f, 1e-6f);
}

TEST(RecurrencePoint, IsLowDiscrepancyInEveryRun) {
    // Of any 64 consecutive points, each half of the unit square, in u or in v, contains 32 ± 3.
    for (std::uint64_t first = 0; first < 100000; first += 997) {
        int left = 0, low = 0;
        for (std::uint64_t i = first; i < first + 64; ++i) {
            const Vec2 p = recurrence_point(i, 5);
            left += p.x < 0.5f;
            low += p.y < 0.5f;
        }
        EXPECT_NEAR(left, 32, 3);
        EXPECT_NEAR(low, 32, 3);
    }
}

}
}
