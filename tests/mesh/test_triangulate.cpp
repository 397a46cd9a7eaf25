#include "alcove/mesh/triangulate.h"

#include "alcove/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace alcove {
namespace {

using Vec2d = glm::dvec2;

struct Plane {
    Vec3d origin, u, v; // u and v of length 1
    double scale = 1.0;

    Vec3d at(const Vec2d& p) const { return scale * (origin + p.x * u + p.y * v); }
    Vec3d normal() const { return glm::normalize(glm::cross(u, v)); }
};

Plane random_plane(std::mt19937& random, double scale, double offset) {
    std::normal_distribution<double> normal;
    const Vec3d u = glm::normalize(Vec3d(normal(random), normal(random), normal(random)));
    const Vec3d w = glm::normalize(Vec3d(normal(random), normal(random), normal(random)));
    const Vec3d v = glm::normalize(glm::cross(w, u));
    return {offset * Vec3d(normal(random), normal(random), normal(random)), u, v, scale};
}

double shoelace(const std::vector<Vec2d>& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * twice;
}

Mesh polygon_mesh(const std::vector<Vec2d>& outline, const Plane& plane) {
    Mesh mesh;
    for (const Vec2d& p : outline)
        mesh.positions.push_back(plane.at(p));
    std::vector<std::uint32_t> face(outline.size());
    std::iota(face.begin(), face.end(), 0u);
    mesh.add_face(face);
    return mesh;
}

/// Checks that the triangles cover the polygon exactly: their signed areas, in units of `scale` squared, have the
/// same sign and add up to that of the polygon.
void expect_cover(const std::vector<Vec2d>& outline, const Plane& plane, double tolerance) {
    const Mesh mesh = polygon_mesh(outline, plane);
    const Triangulation cut = triangulate(mesh);
    ASSERT_EQ(cut.triangles.size(), outline.size() - 2);
    EXPECT_EQ(cut.faces_left_out, 0u);
    const double whole = shoelace(outline);
    const Vec3d normal = (whole > 0 ? 1.0 : -1.0) * plane.normal();
    double sum = 0.0;
    for (const Triangle& t : cut.triangles) {
        const Vec3d a = (mesh.positions[t[1]] - mesh.positions[t[0]]) / plane.scale;
        const Vec3d b = (mesh.positions[t[2]] - mesh.positions[t[0]]) / plane.scale;
        const double area = 0.5 * glm::dot(glm::cross(a, b), normal);
        EXPECT_GE(area, -tolerance);
        sum += area;
    }
    EXPECT_NEAR(sum, std::abs(whole), tolerance * static_cast<double>(outline.size()));
}

std::vector<Vec2d> random_star(std::mt19937& random, std::size_t corners) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Vec2d> outline;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle =
            2 * std::numbers::pi * (static_cast<double>(i) + 0.8 * unit(random)) / static_cast<double>(corners);
        outline.push_back((0.1 + unit(random)) * Vec2d(std::cos(angle), std::sin(angle)));
    }
    return outline;
}

/// A comb with teeth of unit width, on a bar of height 1.
std::vector<Vec2d> comb_of(std::size_t teeth, double height) {
    std::vector<Vec2d> comb;
    for (std::size_t i = 0; i < teeth; ++i) {
        comb.emplace_back(i, 0.0);
        comb.emplace_back(static_cast<double>(i) + 0.5, height);
    }
    const auto width = static_cast<double>(teeth);
    comb.insert(comb.end(), {{width, 0.0}, {width, -1.0}, {0.0, -1.0}});
    return comb;
}

/// A strip that winds around the origin, with `steps` edges on each side.
std::vector<Vec2d> spiral_of(std::size_t steps, double angle_per_step) {
    std::vector<Vec2d> spiral;
    for (const bool inner : {false, true})
        for (std::size_t i = 0; i <= steps; ++i) {
            const double angle = angle_per_step * static_cast<double>(inner ? steps - i : i);
            const double radius = 1.0 + 0.2 * angle - (inner ? 0.3 : 0.0);
            spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        }
    return spiral;
}

/// A side of Koch's snowflake, to the right of the path from `a` to `b`, without its end.
void add_koch(std::vector<Vec2d>& outline, const Vec2d& a, const Vec2d& b, int depth) {
    if (depth == 0) {
        outline.push_back(a);
        return;
    }
    const Vec2d third = (b - a) / 3.0;
    const Vec2d tip = a + 1.5 * third + std::sqrt(0.75) * Vec2d(third.y, -third.x);
    add_koch(outline, a, a + third, depth - 1);
    add_koch(outline, a + third, tip, depth - 1);
    add_koch(outline, tip, b - third, depth - 1);
    add_koch(outline, b - third, b, depth - 1);
}

/// A unit square with rows of square holes that take a quarter of its area. A bridge leads through the holes of each
/// row from the left side; the outline follows it there and back.
std::vector<Vec2d> sieve_of(int rows) {
    std::vector<Vec2d> outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const double cell = 1.0 / rows, half = 0.25 * cell;
    for (int row = rows - 1; row >= 0; --row) {
        const double y = (row + 0.5) * cell;
        outline.emplace_back(0.0, y);
        for (int column = 0; column < rows; ++column) {
            const double left = (column + 0.5) * cell - half, right = (column + 0.5) * cell + half;
            outline.insert(outline.end(), {{left, y}, {left, y + half}, {right, y + half}, {right, y}});
        }
        for (int column = rows - 1; column >= 0; --column) {
            const double left = (column + 0.5) * cell - half, right = (column + 0.5) * cell + half;
            if (column + 1 < rows)
                outline.emplace_back(right, y);
            outline.insert(outline.end(), {{right, y - half}, {left, y - half}, {left, y}});
        }
        outline.emplace_back(0.0, y);
    }
    return outline;
}

TEST(Triangulate, CoversRandomConcavePolygonsWithoutOverlap) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int round = 0; round < 300; ++round) {
        std::vector<Vec2d> outline = random_star(random, 3 + random() % 40);
        if (round % 2)
            std::reverse(outline.begin(), outline.end());
        std::rotate(outline.begin(), outline.begin() + random() % outline.size(), outline.end());
        expect_cover(outline, random_plane(random, 1.0, 0.0), 1e-12);
    }
}

TEST(Triangulate, ScaleAndPlaceDoNotMatter) {
    std::mt19937 random(7);
    for (const double scale : {1e-200, 1e-7, 1e7, 1e200, 1e307})
        expect_cover(random_star(random, 30), random_plane(random, scale, 0.0), 1e-12);
    for (const double offset : {1e3, 1e6})
        expect_cover(random_star(random, 30), random_plane(random, 1.0, offset), 1e-14 * offset);
}

TEST(Triangulate, CoversCombsAndSpirals) {
    std::mt19937 random(3);
    expect_cover(comb_of(100, 30.0), random_plane(random, 1.0, 0.0), 1e-9);
    expect_cover(spiral_of(500, 0.05), random_plane(random, 1.0, 0.0), 1e-9);
}

TEST(Triangulate, CoversPolygonsOfAnyNumberOfCorners) {
    std::mt19937 random(13);
    const Plane plane = random_plane(random, 1.0, 0.0);
    for (const std::size_t corners : {2047u, 2048u, 2049u, 2050u, 100000u})
        expect_cover(random_star(random, corners), plane, 1e-12);
    expect_cover(comb_of(50000, 30.0), plane, 1e-7);
    expect_cover(comb_of(50000, 50000.0), plane, 1e-5);
    expect_cover(spiral_of(50000, 0.001), plane, 1e-9);
    expect_cover(spiral_of(50000, 0.05), plane, 1e-6);
    std::vector<Vec2d> snowflake;
    const Vec2d a(0, 0), b(1, 0), c(0.5, std::sqrt(0.75));
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        add_koch(snowflake, from, to, 7);
    ASSERT_EQ(snowflake.size(), 3u << 14);
    const double triangle = std::sqrt(3.0) / 4.0; // the closed form of the area after n steps
    ASSERT_NEAR(shoelace(snowflake), triangle * (1.0 + 0.6 * (1.0 - std::pow(4.0 / 9.0, 7))), 1e-12);
    expect_cover(snowflake, plane, 1e-12);
}

TEST(Triangulate, CoversALargeCircleWithADent) {
    // The turns are 1e-5 and the edges 1e-5 long, so that the triangles at the corners have areas of 1e-15.
    std::vector<Vec2d> outline{{0, 0}};
    constexpr int corners = 600000;
    for (int i = 0; i <= corners; ++i) {
        const double angle = 0.25 + 5.5 * i / corners;
        outline.emplace_back(std::cos(angle), std::sin(angle));
    }
    std::mt19937 random(17);
    expect_cover(outline, random_plane(random, 1.0, 0.0), 1e-14);
}

TEST(Triangulate, CoversStaircasesAndOutlinesWithCollinearCorners) {
    std::vector<Vec2d> outline;
    for (int i = 0; i < 20; ++i) {
        outline.emplace_back(i, i);
        outline.emplace_back(i + 0.5, i);
        outline.emplace_back(i + 1, i);
        outline.emplace_back(i + 1, i + 0.5);
    }
    outline.emplace_back(20.0, 20.0);
    for (int i = 19; i > 0; --i)
        outline.emplace_back(0.0, i);
    std::mt19937 random(5);
    for (std::size_t turn = 0; turn < outline.size(); turn += 7) {
        std::rotate(outline.begin(), outline.begin() + 7, outline.end());
        expect_cover(outline, random_plane(random, 1.0, 0.0), 1e-10);
    }
}

TEST(Triangulate, CoversAPlateWhoseHoleIsReachedByABridge) {
    // The bridge runs twice between (0,0) and (1,1), with duplicate corners, as exporters write it.
    const std::vector<Vec2d> outline{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    expect_cover(outline, Plane{Vec3d(0.0), {1, 0, 0}, {0, 1, 0}}, 1e-12);
}

TEST(Triangulate, CoversPlatesWithRowsOfHoles) {
    std::mt19937 random(19);
    for (const int rows : {1, 2, 3, 4, 5, 6, 7, 8, 20, 100}) {
        const std::vector<Vec2d> outline = sieve_of(rows);
        ASSERT_NEAR(shoelace(outline), 0.75, 1e-12);
        expect_cover(outline, Plane{Vec3d(0.0), {1, 0, 0}, {0, 1, 0}}, 1e-12);
        expect_cover(outline, random_plane(random, 1.0, 0.0), 1e-12);
    }
}

TEST(Triangulate, ConvexPolygonsAreFansFromTheirFirstCorner) {
    for (const std::uint32_t corners : {4u, 5u, 9u, 5000u}) {
        std::vector<Vec2d> outline;
        for (std::uint32_t i = 0; i < corners; ++i) {
            const double angle = 2 * std::numbers::pi * i / corners;
            outline.emplace_back(std::cos(angle), std::sin(angle));
        }
        const auto cut = triangulate(polygon_mesh(outline, Plane{{5, 6, 7}, {0, 0, 1}, {0, 1, 0}})).triangles;
        ASSERT_EQ(cut.size(), corners - 2);
        for (std::uint32_t i = 0; i < cut.size(); ++i)
            EXPECT_EQ(cut[i], (Triangle{0, i + 1, i + 2}));
    }
}

TEST(Triangulate, ConcaveQuadIsCutAtItsReflexCorner) {
    const Plane plane{Vec3d(0.0), {1, 0, 0}, {0, 1, 0}};
    std::vector<Vec2d> dart{{0, 0}, {2, -1}, {0.5, 0}, {2, 1}};
    std::swap(dart[0], dart[2]);
    std::rotate(dart.begin(), dart.begin() + 1, dart.end());
    for (int i = 0; i < 4; ++i) {
        expect_cover(dart, plane, 1e-15);
        std::rotate(dart.begin(), dart.begin() + 1, dart.end());
    }
}

TEST(Triangulate, BentPolygonKeepsItsBoundaryAndItsSense) {
    // A saddle, which is not planar. Each outline edge must be used once in its direction, each cut in both.
    Mesh mesh;
    std::vector<std::uint32_t> face;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const double angle = 2 * std::numbers::pi * i / 12.0;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.5 * std::sin(2 * angle));
        face.push_back(i);
    }
    mesh.add_face(face);
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> directed;
    for (const Triangle& t : triangulate(mesh).triangles)
        for (int k = 0; k < 3; ++k)
            directed.insert({t[k], t[(k + 1) % 3]});
    EXPECT_EQ(directed.size(), 30u);
    for (const auto& [a, b] : directed) {
        EXPECT_EQ(directed.count({a, b}), 1u);
        EXPECT_EQ(directed.count({b, a}), (a + 1) % 12 == b ? 0u : 1u);
    }
}

TEST(Triangulate, FacesWithoutGeometryAreLeftOutAndCounted) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {NAN, 0, 0}, {0, INFINITY, 0}};
    const std::vector<std::vector<std::uint32_t>> faces{
        {},        {0},          {0, 1},       {0, 1, 1},
        {0, 1, 0}, {0, 1, 4},    {0, 1, 2, 5}, {0, 0, 1, 1},  // left out
        {0, 1, 2}, {0, 1, 1, 2}, {2, 3, 0, 2}, {0, 1, 2, 3}}; // 1 + 1 + 1 + 2 triangles
    for (const auto& face : faces)
        mesh.add_face(face);
    const Triangulation cut = triangulate(mesh);
    EXPECT_EQ(cut.faces_left_out, 8u);
    const std::vector<Triangle> expected{{0, 1, 2}, {0, 1, 2}, {2, 3, 0}, {0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(cut.triangles, expected);
    EXPECT_TRUE(triangulate(Mesh{}).triangles.empty());
}

TEST(Triangulate, PolygonsOfOnePointOrOneLineEndWithoutHarm) {
    Mesh mesh;
    mesh.positions.assign(5, Vec3d(1, 2, 3));
    for (int i = 0; i < 6; ++i)
        mesh.positions.emplace_back(i, 2 * i, 3 * i);
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3, 4});
    mesh.add_face(std::vector<std::uint32_t>{5, 6, 7, 8, 9, 10});
    mesh.add_face(std::vector<std::uint32_t>{5, 8, 6, 9, 7, 10});
    EXPECT_EQ(triangulate(mesh).triangles.size(), 3u + 4u + 4u);
}

TEST(Triangulate, OrderIsThatOfTheFacesWhateverTheThreads) {
    std::mt19937 random(11);
    Mesh mesh;
    for (std::uint32_t f = 0; f < 50000; ++f) {
        std::vector<std::uint32_t> face;
        for (const Vec2d& p : random_star(random, 3 + f % 4)) {
            face.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.emplace_back(p.x, p.y, f);
        }
        mesh.add_face(face);
    }
    const auto many = triangulate(mesh).triangles;
    EXPECT_TRUE(std::is_sorted(many.begin(), many.end(), [&](const Triangle& a, const Triangle& b) {
        return mesh.positions[a[0]].z < mesh.positions[b[0]].z;
    }));
    const ThreadLimit one(1);
    EXPECT_EQ(triangulate(mesh).triangles, many);
}

}
}
