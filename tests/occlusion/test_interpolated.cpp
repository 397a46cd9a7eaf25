/// evaluate_interpolated() against closed forms and against the evaluation of all surfels.
#include "alcove/occlusion/detail/interpolated.h"

#include "alcove/base/parallel.h"
#include "alcove/occlusion/detail/local_fit.h"
#include "alcove/occlusion/methods/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace alcove {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float radius = 0.1f;

/// Squares, each given by a corner and two edges.
RaySurface squares(const std::vector<std::array<Vec3, 3>>& corner_and_edges) {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    for (const auto& [corner, along, across] : corner_and_edges) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Vec3& p : {corner, corner + along, corner + along + across, corner + across})
            positions.push_back(p);
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first, first + 2, first + 3});
    }
    return {positions, triangles};
}

const std::array<Vec3, 3> floor_square{Vec3(-50, 0, -50), Vec3(100, 0, 0), Vec3(0, 0, 100)},
    wall_square{Vec3(0, 0, -50), Vec3(0, 50, 0), Vec3(0, 0, 100)};

/// side × side surfels on the floor, within 0.2 of the wall.
std::vector<Surfel> floor_surfels(int side) {
    std::vector<Surfel> surfels;
    for (int i = 0; i < side * side; ++i)
        surfels.push_back({{0.2f * (static_cast<float>(i % side) + 0.5f) / static_cast<float>(side), 0,
                            0.2f * static_cast<float>(i / side) / static_cast<float>(side)},
                           {0, 1, 0}});
    return surfels;
}

double truth_beside_wall(const Surfel& surfel) {
    const double u = std::min(1.0, double(surfel.position.x) / radius);
    return 1.0 - (std::acos(u) - u * std::sqrt(1.0 - u * u)) / pi;
}

double rmse_beside_wall(const std::vector<Surfel>& surfels, const std::vector<float>& ao) {
    double sum = 0.0;
    for (std::size_t i = 0; i < ao.size(); ++i)
        sum += std::pow(ao[i] - truth_beside_wall(surfels[i]), 2);
    return std::sqrt(sum / static_cast<double>(ao.size()));
}

MethodRun exact(int rays, ChannelSet wanted = Channel::ao) {
    const MethodChoice choice = choose(find_method("exact"), rays);
    return {choice.method, choice.settings(radius), wanted};
}

std::optional<InterpolatedValues> interpolated(const std::vector<Surfel>& surfels, const Occluders& occluders,
                                               const MethodRun& run, const Interpolation& interpolation) {
    return evaluate_interpolated(surfels, spatial_order(surfels), occluders, run, interpolation);
}

TEST(Interpolated, BesideAWallAFifthOfTheSurfelsIsAsAccurateAsAll) {
    const Occluders occluders(squares({floor_square, wall_square}));
    const std::vector<Surfel> surfels = floor_surfels(300);
    const MethodRun run = exact(64);
    const auto all = evaluate(surfels, occluders, *run.method, run.settings, Channel::ao)[Channel::ao];
    const auto some = interpolated(surfels, occluders, run, {.stride = 16, .tolerance = 0.03f});
    ASSERT_TRUE(some);
    EXPECT_LT(some->share, 0.2);
    EXPECT_LT(rmse_beside_wall(surfels, some->values[Channel::ao]), rmse_beside_wall(surfels, all));
}

TEST(Interpolated, BentNormalsAreInterpolatedToo) {
    const Occluders occluders(squares({floor_square, wall_square}));
    const std::vector<Surfel> surfels = floor_surfels(200);
    const MethodRun run = exact(256, Channel::ao | Channel::bent_normal);
    const auto all = evaluate(surfels, occluders, *run.method, run.settings, run.wanted)[Channel::bent_normal];
    const auto some = interpolated(surfels, occluders, run, {.stride = 16, .tolerance = 0.03f});
    ASSERT_TRUE(some);
    const std::vector<float>& bent = some->values[Channel::bent_normal];
    double square = 0.0;
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const Vec3 a(all[3 * i], all[3 * i + 1], all[3 * i + 2]), b(bent[3 * i], bent[3 * i + 1], bent[3 * i + 2]);
        ASSERT_NEAR(glm::length(b), 1.0f, 1e-4f);
        square += glm::dot(a - b, a - b);
    }
    EXPECT_LT(std::sqrt(square / static_cast<double>(surfels.size())), 0.02);
}

TEST(Interpolated, TwoSidesOfASheetDoNotMix) {
    // A sheet half a radius above the floor: its top is open, and its underside is not.
    const Occluders occluders(squares({floor_square, {Vec3(-50, 0.05f, -50), Vec3(100, 0, 0), Vec3(0, 0, 100)}}));
    std::vector<Surfel> surfels;
    for (Surfel surfel : floor_surfels(150))
        for (const float side : {1.0f, -1.0f})
            surfels.push_back({surfel.position + Vec3(0, 0.05f, 0), {0, side, 0}});
    const auto some = interpolated(surfels, occluders, exact(256), {.stride = 16, .tolerance = 0.05f});
    ASSERT_TRUE(some);
    const double below = 0.25; // (h/R)²
    for (std::size_t i = 0; i < surfels.size(); ++i)
        ASSERT_NEAR(some->values[Channel::ao][i], surfels[i].normal.y > 0 ? 1.0 : below, 0.03) << i;
}

TEST(Interpolated, ValuesDependNeitherOnTheOrderNorOnThreads) {
    const Occluders occluders(squares({floor_square, wall_square}));
    std::vector<Surfel> surfels = floor_surfels(150);
    surfels.insert(surfels.end(), surfels.begin(), surfels.begin() + 5000); // duplicates
    const auto ao = [&](const std::vector<Surfel>& of, unsigned threads) {
        const ThreadLimit limit(threads);
        return interpolated(of, occluders, exact(16), {.stride = 16, .tolerance = 0.03f})->values[Channel::ao];
    };
    const std::vector<float> one = ao(surfels, 1);
    EXPECT_EQ(one, ao(surfels, 3));
    for (std::size_t i = 0; i < 5000; ++i)
        ASSERT_EQ(one[i], one[150 * 150 + i]);
    std::vector<std::size_t> order(surfels.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    std::vector<Surfel> shuffled;
    for (const std::size_t i : order)
        shuffled.push_back(surfels[i]);
    const std::vector<float> other = ao(shuffled, 2);
    for (std::size_t i = 0; i < order.size(); ++i)
        ASSERT_EQ(other[i], one[order[i]]);
}

TEST(Interpolated, ContactsAreEvaluatedAndSurfelsWithoutNormalGetOne) {
    const Occluders occluders(squares({floor_square, wall_square}));
    std::vector<Surfel> surfels = floor_surfels(100);
    surfels[50].covered = true;
    surfels[60] = {{0, 0, 0.1f}, {0, 1, 0}, {1, 0, 0}}; // at the foot of the wall
    surfels[70].normal = Vec3(0.0f);
    const auto some = interpolated(surfels, occluders, exact(256), {.stride = 16, .tolerance = 0.1f});
    ASSERT_TRUE(some);
    EXPECT_EQ(some->values[Channel::ao][50], 0.0f);
    EXPECT_NEAR(some->values[Channel::ao][60], 0.5f, 0.02f);
    EXPECT_EQ(some->values[Channel::ao][70], 1.0f);
}

TEST(Interpolated, IsRefusedWhereNeighboursDisagree) {
    // One ray per surfel; a ceiling stops half of them.
    const Occluders occluders(squares({floor_square, {Vec3(-50, 0.07f, -50), Vec3(100, 0, 0), Vec3(0, 0, 100)}}));
    const std::vector<Surfel> surfels = floor_surfels(100);
    EXPECT_FALSE(interpolated(surfels, occluders, exact(1), {16, 0.02f, 0.5}));
    EXPECT_TRUE(interpolated(surfels, occluders, exact(1), {16, 0.02f, 1.0}));
}

TEST(LocalFit, ReproducesLinearFunctionsWithoutDeviation) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> coordinate(-1.0f, 1.0f);
    FitSources sources;
    for (int i = 0; i < 200; ++i) {
        const Vec3 p(coordinate(random), coordinate(random), 0.0f);
        sources.push_back({p, {0, 0, 1}}, {0.3f + 0.2f * p.x - 0.1f * p.y, p.x, 1.0f, 0.0f});
        sources.push_back({p, {0, 0, -1}}, {9.0f, 9.0f, 9.0f, 9.0f}); // the other side
    }
    const LocalFit fit = local_fit(sources.arrays(), {{0.1f, 0.2f, 0.0f}, {0, 0, 1}}, 0.8f, 4);
    EXPECT_NEAR(fit.values[0], 0.3f + 0.02f - 0.02f, 1e-3f);
    EXPECT_NEAR(fit.values[1], 0.1f, 3e-3f);
    EXPECT_NEAR(fit.values[2], 1.0f, 1e-5f);
    EXPECT_NEAR(fit.values[3], 0.0f, 1e-5f);
    EXPECT_LT(fit.deviation, 0.01f);
    EXPECT_EQ(local_fit(sources.arrays(), {{5, 5, 5}, {0, 0, 1}}, 0.8f, 1).weight, 0.0f);
}

TEST(LocalFit, DeviationIsThatOfTheNoise) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> coordinate(-1.0f, 1.0f);
    std::normal_distribution<float> noise(0.5f, 0.1f);
    FitSources sources;
    for (int i = 0; i < 4000; ++i)
        sources.push_back({{coordinate(random), coordinate(random), 0.0f}, {0, 0, 1}}, {noise(random), 0, 0, 0});
    const LocalFit fit = local_fit(sources.arrays(), {Vec3(0.0f), {0, 0, 1}}, 0.8f, 1);
    EXPECT_NEAR(fit.deviation, 0.1f, 0.01f);
    EXPECT_NEAR(fit.values[0], 0.5f, 0.02f);
}

}
}
