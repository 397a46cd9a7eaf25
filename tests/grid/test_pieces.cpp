#include "alcove/grid/pieces.h"

#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace alcove {
namespace {

template <class Key>
class RadixSort : public testing::Test {};
using KeyTypes = testing::Types<std::uint32_t, std::uint64_t>;
TYPED_TEST_SUITE(RadixSort, KeyTypes);

TYPED_TEST(RadixSort, IsTheStableSort) {
    std::mt19937_64 random(7);
    for (const std::size_t count : {0u, 1u, 2u, 1000u, 200'000u})
        for (const auto& [low, high] : {std::pair{0, 30}, {0, 8}, {3, 20}, {0, 0}}) {
            HugeVector<Keyed<TypeParam>> items(count);
            for (std::uint32_t i = 0; i < count; ++i)
                items[i] = {static_cast<TypeParam>(random() & ((TypeParam{1} << high) - 1)), i};
            auto expected = items;
            std::stable_sort(expected.begin(), expected.end(),
                             [low](const auto& a, const auto& b) { return a.key >> low < b.key >> low; });
            radix_sort(items, low, high);
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(items[i].value, expected[i].value) << count << " " << low << " " << high;
                ASSERT_EQ(items[i].key, expected[i].key);
            }
        }
}

double area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    return 0.5 * glm::length(glm::cross(Vec3d(b - a), Vec3d(c - a)));
}

/// Every part of every triangle is in one group, and none is longer than it may be.
void expect_whole(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
    const GroupedPieces pieces(positions, triangles);
    std::vector<double> areas(triangles.size());
    for (std::size_t g = 0; g < pieces.count(); ++g) {
        ASSERT_LT(pieces.begin(g), pieces.begin(g + 1));
        ASSERT_LE(pieces.begin(g + 1) - pieces.begin(g), GroupedPieces::largest_group);
        for (std::size_t i = pieces.begin(g); i < pieces.begin(g + 1); ++i) {
            const Piece piece = pieces.piece(i);
            const auto& [a, b, c] = piece.corners;
            EXPECT_LE(std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)}),
                      1.0001 * longest_piece);
            areas[piece.triangle] += area_of(a, b, c);
        }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const double area =
            0.5 * glm::length(glm::cross(positions[b] - positions[a], positions[c] - positions[a]));
        EXPECT_NEAR(areas[t], area, 1e-4 * area + 1e-6) << t;
    }
}

TEST(Pieces, HoldEveryTriangleOnce) {
    for (const double voxels : {1.0, 30.0, 3000.0}) {
        const Mesh mesh = test::sphere_mesh(3);
        std::vector<Vec3d> positions;
        for (const Vec3d& p : mesh.positions)
            positions.push_back(voxels * (p - mesh.box().min) / mesh.box().diagonal());
        expect_whole(positions, triangulate(mesh).triangles);
    }
}

TEST(Pieces, OfOneCellAreGroupedToo) {
    const std::vector<Vec3d> positions{{0.1, 0.1, 0.1}, {0.2, 0.1, 0.1}, {0.1, 0.2, 0.1}};
    expect_whole(positions, std::vector<Triangle>(1000, Triangle{0, 1, 2}));
}

/// A group spans as little as it can: floats hold it from its first voxel on.
TEST(Pieces, FarApartAreInGroupsOfTheirOwn) {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    for (std::uint32_t speck = 0; speck < 16; ++speck) {
        const Vec3d at(60'000.0 * (speck & 1), 60'000.0 * (speck >> 1 & 1), 10.0 * speck);
        for (std::uint32_t k = 0; k < 8; ++k) {
            const auto first = static_cast<std::uint32_t>(positions.size());
            for (const Vec3d corner : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)})
                positions.push_back(at + corner + Vec3d(0, 0, 0.1 * k));
            triangles.push_back({first, first + 1, first + 2});
        }
    }
    const GroupedPieces pieces(positions, triangles);
    for (std::size_t g = 0; g < pieces.count(); ++g)
        for (std::size_t i = pieces.begin(g); i < pieces.begin(g + 1); ++i) {
            const Index3 way = glm::abs(pieces.piece(i).origin - pieces.piece(pieces.begin(g)).origin);
            EXPECT_LT(std::max(way.x, way.y), 60'000);
        }
}

}
}
