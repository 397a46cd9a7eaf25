#include "alcove/nearest/detail/fragments.h"

#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace alcove {
namespace {

double area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    return 0.5 * glm::length(glm::cross(Vec3d(b - a), Vec3d(c - a)));
}

/// The leaves contain each part of every triangle exactly once, and no fragment is too long.
void expect_whole(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
    const FragmentLeaves fragments(positions, triangles);
    std::vector<double> areas(triangles.size());
    for (std::size_t g = 0; g < fragments.count(); ++g) {
        ASSERT_LT(fragments.begin(g), fragments.begin(g + 1));
        ASSERT_LE(fragments.begin(g + 1) - fragments.begin(g), largest_leaf);
        for (std::size_t i = fragments.begin(g); i < fragments.begin(g + 1); ++i) {
            const Fragment fragment = fragments.fragment(i);
            const auto& [a, b, c] = fragment.corners;
            EXPECT_LE(std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)}),
                      1.0001 * longest_fragment);
            areas[fragment.triangle] += area_of(a, b, c);
        }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const double area = 0.5 * glm::length(glm::cross(positions[b] - positions[a], positions[c] - positions[a]));
        EXPECT_NEAR(areas[t], area, 1e-4 * area + 1e-6) << t;
    }
}

TEST(Fragments, HoldEveryTriangleOnce) {
    for (const double voxels : {1.0, 30.0, 3000.0}) {
        const Mesh mesh = test::sphere_mesh(3);
        std::vector<Vec3d> positions;
        for (const Vec3d& p : mesh.positions)
            positions.push_back(voxels * (p - mesh.box().min) / mesh.box().diagonal());
        expect_whole(positions, triangulate(mesh).triangles);
    }
}

/// Repeated halving would cut each needle into a thousand fragments.
TEST(Fragments, OfNeedlesGrowWithTheirLengthAlone) {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    for (const double width : {1e-3, 0.1, 1.0, 2.5})
        for (const double foot : {0.0, 1e-9, 0.3, 0.5, 1.0}) {
            const auto first = static_cast<std::uint32_t>(positions.size());
            const Vec3d at(3.0, 2.0, 1.0), along(300.0, 100.0, 50.0);
            positions.insert(positions.end(),
                             {at, at + along, at + foot * along + width * glm::normalize(Vec3d(1.0, -3.0, 0.0))});
            triangles.push_back({first, first + 1, first + 2});
        }
    expect_whole(positions, triangles);
    const FragmentLeaves fragments(positions, triangles);
    const double length = glm::length(Vec3d(300.0, 100.0, 50.0));
    EXPECT_LE(static_cast<double>(fragments.begin(fragments.count())),
              static_cast<double>(triangles.size()) * (2.0 * length / 2.8 + 4.0));
}

TEST(Fragments, OfOneCellAreGroupedToo) {
    const std::vector<Vec3d> positions{{0.1, 0.1, 0.1}, {0.2, 0.1, 0.1}, {0.1, 0.2, 0.1}};
    expect_whole(positions, std::vector<Triangle>(1000, Triangle{0, 1, 2}));
}

TEST(Fragments, OfOneCellInAHugeGridAreGroupedToo) {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    const auto add = [&](const Vec3d& at, double size) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {at, at + Vec3d(size, 0, 0), at + Vec3d(0, size, 0)});
        triangles.push_back({first, first + 1, first + 2});
    };
    for (int i = 0; i < 10'000; ++i)
        add(0.01 * Vec3d(i % 20, i / 20 % 20, i / 400), 0.01);
    add(Vec3d(1e6), 1.0);
    expect_whole(positions, triangles);
}

/// In a regular sheet, the most compact leaf of eight triangles is two by two squares.
TEST(Fragments, AreInFullAndCompactGroups) {
    constexpr std::uint32_t side = 100;
    constexpr double size = 0.9; // voxels
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    for (std::uint32_t x = 0; x <= side; ++x)
        for (std::uint32_t y = 0; y <= side; ++y) {
            positions.emplace_back(size * x + 0.3, size * y + 0.3, 20.0 + 0.2 * size * x);
            const std::uint32_t here = x * (side + 1) + y, beyond = here + side + 1;
            if (x < side && y < side) {
                triangles.push_back({here, beyond, here + 1});
                triangles.push_back({beyond, beyond + 1, here + 1});
            }
        }
    const FragmentLeaves fragments(positions, triangles);
    double perimeters = 0.0;
    for (std::size_t g = 0; g < fragments.count(); ++g) {
        Vec3d low(1e9), high(-1e9);
        for (std::size_t i = fragments.begin(g); i < fragments.begin(g + 1); ++i)
            for (const std::uint32_t v : triangles[fragments.fragment(i).triangle]) {
                low = glm::min(low, positions[v]);
                high = glm::max(high, positions[v]);
            }
        perimeters += 2.0 * (high.x - low.x + high.y - low.y);
    }
    const auto leaves = static_cast<double>(fragments.count());
    EXPECT_GT(static_cast<double>(triangles.size()) / leaves, 7.4);
    EXPECT_LT(perimeters / leaves, 1.3 * 8.0 * size);
}

/// A leaf must be small, as floats store it relative to its first voxel.
TEST(Fragments, FarApartAreInGroupsOfTheirOwn) {
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
    const FragmentLeaves fragments(positions, triangles);
    for (std::size_t g = 0; g < fragments.count(); ++g)
        for (std::size_t i = fragments.begin(g); i < fragments.begin(g + 1); ++i) {
            const Index3 distance =
                glm::abs(fragments.fragment(i).origin - fragments.fragment(fragments.begin(g)).origin);
            EXPECT_LT(std::max(distance.x, distance.y), 60'000);
        }
}

}
}
