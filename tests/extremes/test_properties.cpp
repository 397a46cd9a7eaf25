/// Properties of any mesh, tested on random ones. The tests print the seed.
#include "extreme.h"
#include "shapes.h"

#include "alcove/base/parallel.h"
#include "alcove/occlusion/methods/traced.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace alcove::extremes {
namespace {

constexpr unsigned first_seed = 20261126, meshes = 6;

/// One to three shapes with random bumps, which may intersect.
class Properties : public testing::TestWithParam<unsigned> {
  protected:
    Properties() : random_(GetParam()) {
        const int bodies = 1 + static_cast<int>(random_() % 3);
        for (int i = 0; i < bodies; ++i)
            test::add_part(mesh_, body(), uniform(0.3, 1.0), 1.5 * direction());
        std::printf("seed %u: %d bodies, %zu vertices\n", GetParam(), bodies, mesh_.vertex_count());
    }
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    Vec3d direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(Vec3d(normal(random_), normal(random_), normal(random_)));
    }
    template <class Move>
    Mesh moved(const Move& move) const {
        Mesh mesh = mesh_;
        std::transform(mesh.positions.begin(), mesh.positions.end(), mesh.positions.begin(), move);
        return mesh;
    }
    static void expect(const Result& result) {
        for (const Figure& figure : result.figures)
            EXPECT_LE(figure.value, figure.bound) << figure.of;
    }

    std::mt19937 random_;
    Mesh mesh_;

  private:
    Mesh body() {
        Mesh mesh = test::sphere_mesh(4);
        for (int bump = 0; bump < 6; ++bump) {
            const Vec3d wave = uniform(1.0, 9.0) * direction();
            const double phase = uniform(0.0, 6.0), height = uniform(0.0, 0.1);
            for (Vec3d& p : mesh.positions)
                p *= 1.0 + height * std::sin(glm::dot(wave, p) + phase);
        }
        return mesh;
    }
};

TEST_P(Properties, ScaleAndPlaceDoNotMatter) {
    const double scale = std::pow(10.0, uniform(-20.0, 20.0));
    const Vec3d offset = scale * uniform(0.0, 1e3) * direction();
    expect(rmse_against(mesh_, moved([&](const Vec3d& p) { return scale * p + offset; }), all_kinds, 1e-3));
}

/// The tangent frame of a surfel does not rotate with the mesh, so ray directions differ, and voxels do not rotate
/// either: what remains is noise.
TEST_P(Properties, RotationMattersNoMoreThanNoise) {
    const glm::dquat turn = glm::angleAxis(uniform(0.0, 6.0), direction());
    const Mesh turned = moved([&](const Vec3d& p) { return turn * p; });
    const Baked one(mesh_, {.rays = 1024}), other(turned, {.rays = 1024});
    const std::vector<float> truth = one.truth();
    for (const std::string_view method : {"exact", "traced"}) {
        const std::vector<float> a = one.by(method), b = other.by(method);
        const double noise = compare(a, truth).rmse + compare(b, other.truth()).rmse;
        EXPECT_LE(compare(a, b).rmse, 3.0 * noise + 1e-3) << method;
    }
    for (const std::string_view method : {"calibrated", "guided"}) {
        const std::vector<float> a = one.by(method), b = other.by(method);
        EXPECT_LE(compare(a, b).rmse, 3.0 * compare(a, truth).rmse) << method;
    }
}

// Tests radii from 0.1 on, where the offset of rays no longer grows with the radius.
TEST_P(Properties, ALargerRadiusIsNeverBrighter) {
    const MeasuredMesh mesh("mesh", mesh_);
    const LevelStack field(voxelize(mesh.mesh, mesh.triangles, {.grid = {.radius = 0.5f}}));
    std::vector<float> exact(mesh.surfels.size(), 1.0f), traced = exact;
    for (const float radius : {0.1f, 0.2f, 0.3f, 0.5f}) {
        const std::vector<float> e = evaluate_ao(mesh.surfels, mesh.rays, Exact{.radius = radius}),
                                 t = evaluate_ao(mesh.surfels, field, Traced{.radius = radius});
        for (std::size_t i = 0; i < e.size(); ++i) {
            ASSERT_LE(e[i], exact[i]) << i;
            ASSERT_LE(t[i], traced[i]) << i;
        }
        exact = e, traced = t;
    }
}

TEST_P(Properties, AnotherOccluderIsNeverBrighter) {
    Mesh more = mesh_;
    test::add_part(more, test::sphere_mesh(3), 0.4, mesh_.positions[random_() % mesh_.vertex_count()]);
    // Use the unit space of both shapes, so that the rays are the same.
    const MeasuredMesh both("both", more);
    const std::span<const Surfel> surfels = std::span(both.surfels).first(mesh_.vertex_count());
    std::vector<Vec3> unit;
    for (const Vec3d& p : more.positions)
        unit.push_back(both.frame.to_unit(p));
    std::vector<Triangle> own;
    std::copy_if(both.triangles.begin(), both.triangles.end(), std::back_inserter(own),
                 [&](const Triangle& t) { return t[0] < mesh_.vertex_count(); });
    const std::vector<float> alone = evaluate_ao(surfels, RaySurface(unit, own), Exact{}),
                             occluded = evaluate_ao(surfels, both.rays, Exact{});
    for (std::size_t i = 0; i < alone.size(); ++i)
        ASSERT_LE(occluded[i], alone[i]) << i;
}

TEST_P(Properties, SplitTrianglesChangeNothing) {
    Mesh split;
    split.positions = mesh_.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, added] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(split.positions.size()));
        if (added)
            split.positions.push_back(0.5 * (mesh_.positions[a] + mesh_.positions[b]));
        return at->second;
    };
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
        const std::uint32_t a = mesh_.face(f)[0], b = mesh_.face(f)[1], c = mesh_.face(f)[2];
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const Triangle& t : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
            split.add_face(t);
    }
    expect(rmse_against(mesh_, split, {"traced", "exact", "calibrated", "classic"}, 2e-3));
}

TEST_P(Properties, OrderDoesNotMatter) {
    std::vector<std::uint32_t> to(mesh_.vertex_count());
    std::iota(to.begin(), to.end(), 0u);
    std::shuffle(to.begin(), to.end(), random_);
    Mesh shuffled;
    shuffled.positions.resize(mesh_.vertex_count());
    for (std::size_t v = 0; v < to.size(); ++v)
        shuffled.positions[to[v]] = mesh_.positions[v];
    std::vector<std::size_t> order(mesh_.face_count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random_);
    for (const std::size_t f : order) {
        const auto face = mesh_.face(f);
        const std::size_t turn = random_() % 3; // which corner comes first
        shuffled.add_face(std::array{to[face[turn]], to[face[(turn + 1) % 3]], to[face[(turn + 2) % 3]]});
    }
    const Baked one(mesh_), other(shuffled);
    for (const std::string_view method : {"traced", "exact", "calibrated", "classic", "guided"}) {
        const std::vector<float> a = one.by(method), b = other.by(method);
        std::vector<float> back(a.size());
        for (std::size_t v = 0; v < to.size(); ++v)
            back[v] = b[to[v]];
        EXPECT_LE(compare(back, a).rmse, 1e-3) << method;
    }
}

TEST_P(Properties, ThreadsDoNotMatter) {
    std::vector<std::vector<float>> results;
    for (const unsigned threads : {1u, 3u}) {
        const ThreadLimit limit(threads);
        const Baked baked(mesh_);
        std::vector<float> all;
        for (const std::string_view method : all_kinds) {
            const std::vector<float> ao = baked.by(method);
            all.insert(all.end(), ao.begin(), ao.end());
        }
        results.push_back(std::move(all));
    }
    EXPECT_TRUE(results[0] == results[1]);
}

INSTANTIATE_TEST_SUITE_P(Random, Properties, testing::Range(first_seed, first_seed + meshes));

}
}
