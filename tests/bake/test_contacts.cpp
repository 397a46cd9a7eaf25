/// Ambient occlusion where surfaces touch: closed forms at edges, corners and contacts.
#include "alcove/bake/bake.h"
#include "alcove/mesh/triangulate.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace alcove {
namespace {

using test::add_part;
using test::box_mesh;

/// The mesh with vertices of its own for each group of faces. A group is named by the axis and sign of the normal.
Mesh split_by_side(const Mesh& mesh) {
    Mesh split;
    std::map<std::pair<int, std::uint32_t>, std::uint32_t> known;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        const Vec3d n = glm::cross(mesh.positions[face[1]] - mesh.positions[face[0]],
                                   mesh.positions[face[2]] - mesh.positions[face[0]]);
        const Vec3d size = glm::abs(n);
        const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
        const int side = 2 * axis + (n[axis] > 0.0);
        std::vector<std::uint32_t> corners;
        for (const std::uint32_t v : face) {
            const auto [at, added] = known.try_emplace({side, v}, static_cast<std::uint32_t>(split.positions.size()));
            if (added)
                split.positions.push_back(mesh.positions[v]);
            corners.push_back(at->second);
        }
        split.add_face(corners);
    }
    return split;
}

Mesh turned_inside_out(Mesh mesh) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        std::reverse(mesh.corners.begin() + mesh.face_begin[f], mesh.corners.begin() + mesh.face_begin[f + 1]);
    return mesh;
}

Mesh moved(Mesh mesh, const Vec3d& by) {
    for (Vec3d& p : mesh.positions)
        p += by;
    return mesh;
}

/// A horizontal square of n × n quads around the origin that faces up.
Mesh floor_mesh(double half, int n) {
    Mesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            mesh.positions.emplace_back(half * (2.0 * i / n - 1.0), 0.0, half * (2.0 * j / n - 1.0));
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            mesh.add_face(std::array{at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    return mesh;
}

struct Way {
    std::string name;
    BakeOptions options;
    double tolerance = 0.03;
};

/// Every method that probes or traces, with little noise, and the planner.
std::vector<Way> runs() {
    const auto with_rays = [](const char* method, int rays) {
        return BakeOptions{.method = method, .parameters = {{"rays", rays}}};
    };
    return {{"exact", with_rays("exact", 1024)},
            {"guided", with_rays("guided", 256)},
            {"traced", with_rays("traced", 256)},
            {"calibrated", {.method = "calibrated"}, 0.05},
            {"default", {}},
            {"fine", {.quality = Quality::fine}}};
}

struct Expected {
    std::string where;
    double ao;
    std::function<bool(const Vec3d&)> at;
};

/// Expects the mean ao at each group of points, and no deviation from it by more than three times the tolerance.
void expect_ao(const Mesh& mesh, const Length& radius, const std::vector<Expected>& expected,
               const BakeOptions& scene = {}) {
    for (const Way& run : runs()) {
        BakeOptions options = run.options;
        options.radius = radius;
        options.ground = scene.ground;
        options.occluders = scene.occluders;
        const Baked baked = bake(mesh, options);
        for (const Expected& e : expected) {
            double sum = 0.0, lowest = 1.0, highest = 0.0;
            int count = 0;
            for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
                if (e.at(mesh.positions[v])) {
                    const double ao = baked.ao()[v];
                    sum += ao;
                    lowest = std::min(lowest, ao);
                    highest = std::max(highest, ao);
                    ++count;
                }
            ASSERT_GT(count, 0) << e.where;
            EXPECT_NEAR(sum / count, e.ao, run.tolerance) << run.name << ": " << e.where;
            EXPECT_GT(lowest, e.ao - 3.0 * run.tolerance) << run.name << ": " << e.where;
            EXPECT_LT(highest, e.ao + 3.0 * run.tolerance) << run.name << ": " << e.where;
        }
    }
}

bool is_near(double a, double b) {
    return std::fabs(a - b) < 1e-6;
}

/// Selects the points that lie on `walls` walls of the room [-1, 1]³ and are not near any other wall.
std::function<bool(const Vec3d&)> at_walls(int walls) {
    return [walls](const Vec3d& p) {
        int on = 0, clear = 0;
        for (int axis = 0; axis < 3; ++axis) {
            on += is_near(std::fabs(p[axis]), 1.0);
            clear += std::fabs(p[axis]) < 0.501;
        }
        return on == walls && on + clear == 3;
    };
}

// Half of the hemisphere is open at an edge, a quarter at a corner.
TEST(Contacts, EdgesAndCornersOfARoom) {
    const Mesh room = turned_inside_out(box_mesh({1, 1, 1}, 8));
    expect_ao(split_by_side(room), "0.5",
              {{"wall", 1.0, at_walls(1)}, {"edge", 0.5, at_walls(2)}, {"corner", 0.25, at_walls(3)}});
}

// The open share is that of a quadrant at an edge and of an octant at a corner, each cosine-weighted around its middle
// direction.
TEST(Contacts, EdgesAndCornersOfAWeldedRoom) {
    const Mesh room = turned_inside_out(box_mesh({1, 1, 1}, 8));
    expect_ao(room, "0.5",
              {{"wall", 1.0, at_walls(1)},
               {"edge", std::sqrt(0.5), at_walls(2)},
               {"corner", std::sqrt(3.0) / 4.0, at_walls(3)}});
}

const auto upper = [](const Vec3d& p) { return is_near(p.y, 2.0); };
const auto lower = [](const Vec3d& p) { return is_near(p.y, 0.0); };

// The share of the cosine hemisphere around (1, −1, 1)/√3 that is above the ground.
TEST(Contacts, WeldedCubeOnTheGround) {
    const Mesh cube = moved(box_mesh({1, 1, 1}, 1), {0, 1, 0});
    const double ao = 0.5 * (1.0 - 1.0 / std::sqrt(3.0));
    const std::vector<Expected> expected{{"upper", 1.0, upper}, {"lower", ao, lower}};
    expect_ao(cube, "1", expected, {.ground = true});
    expect_ao(cube, "1", expected, {.occluders = {floor_mesh(6.0, 1)}});
    expect_ao(cube, "1", expected, {.occluders = {floor_mesh(6.0, 12)}});
}

TEST(Contacts, CubeWithHardEdgesOnTheGround) {
    const Mesh cube = split_by_side(moved(box_mesh({1, 1, 1}, 1), {0, 1, 0}));
    for (const Way& run : runs()) {
        BakeOptions options = run.options;
        options.radius = "1";
        options.ground = true;
        const Baked baked = bake(cube, options);
        for (std::size_t f = 0; f < cube.face_count(); ++f)
            for (const std::uint32_t v : cube.face(f)) {
                const auto face = cube.face(f);
                const bool bottom =
                    std::all_of(face.begin(), face.end(), [&](std::uint32_t u) { return lower(cube.positions[u]); });
                const double ao = upper(cube.positions[v]) ? 1.0 : bottom ? 0.0 : 0.5;
                EXPECT_NEAR(baked.ao()[v], ao, 2.0 * run.tolerance) << run.name << ", face " << f;
            }
    }
}

// A floor whose vertices lie under the rim of a box: half of the hemisphere is open at the sides of the box, three
// quarters at its corners, and nothing beneath the box.
TEST(Contacts, FloorUnderABox) {
    Mesh mesh = floor_mesh(5.0, 20);
    const std::size_t floor_vertices = mesh.vertex_count();
    add_part(mesh, moved(box_mesh({1, 1, 1}, 1), {0, 1, 0}), 1.0, {0, 0, 0});
    const auto at_floor = [&](auto inside) {
        return [=, &mesh](const Vec3d& p) {
            const auto v = static_cast<std::size_t>(&p - mesh.positions.data());
            return v < floor_vertices && inside(std::fabs(p.x), std::fabs(p.z));
        };
    };
    expect_ao(mesh, "1.5",
              {{"side", 0.5,
                at_floor([](double x, double z) { return (is_near(x, 1) && z < 0.6) || (is_near(z, 1) && x < 0.6); })},
               {"corner", 0.75, at_floor([](double x, double z) { return is_near(x, 1) && is_near(z, 1); })},
               {"beneath", 0.0, at_floor([](double x, double z) { return x < 0.9 && z < 0.9; })},
               {"open", 1.0, at_floor([](double x, double z) { return x > 3.4 || z > 3.4; })}});
}

// Exact duplicates that face each other cover only where they belong to solids.
TEST(Contacts, StackedBoxesCoverTheFaceBetweenThemAndLeafCardsDoNot) {
    const Mesh box = split_by_side(box_mesh({1, 1, 1}, 2));
    Mesh stack = box;
    add_part(stack, box, 1.0, {0, 2, 0});
    Mesh card = floor_mesh(1.0, 2);
    add_part(card, turned_inside_out(floor_mesh(1.0, 2)), 1.0, {0, 0, 0});
    for (const char* method : {"exact", "guided", "traced", "calibrated"}) {
        const BakeOptions options{.radius = "0.5", .method = method};
        const Baked baked = bake(stack, options);
        int between = 0;
        for (std::size_t v = 0; v < stack.vertex_count(); ++v)
            if (glm::length(stack.positions[v] - Vec3d(0, 1, 0)) < 1e-9) {
                EXPECT_EQ(baked.ao()[v], 0.0f) << method;
                ++between;
            }
        EXPECT_EQ(between, 2) << "the middles of two faces";
        const Baked leaf = bake(card, options);
        for (std::size_t v = 0; v < card.vertex_count(); ++v)
            EXPECT_GT(leaf.ao()[v], 0.9f) << method << ", " << v;
    }
}

// Voxel art: a small cube on a cube of twice its size. The faces of the large cube have no vertices at the corners of
// the small one.
TEST(Contacts, TJunctions) {
    Mesh mesh = split_by_side(moved(box_mesh({2, 2, 2}, 1), {0, -2, 0}));
    const auto large = mesh.vertex_count();
    add_part(mesh, split_by_side(moved(box_mesh({1, 1, 1}, 2), {0, 1, 0})), 1.0, {0, 0, 0});
    const auto at_foot = [&, large](const Vec3d& p) {
        // Only the middles of the lower edges of the sides; vertices of the bottom at the same positions do not count.
        const auto v = static_cast<std::size_t>(&p - mesh.positions.data());
        if (v < large || !is_near(p.y, 0.0) || !(is_near(p.x, 0.0) != is_near(p.z, 0.0)))
            return false;
        for (std::size_t f = 0; f < mesh.face_count(); ++f)
            for (const std::uint32_t u : mesh.face(f))
                if (u == v)
                    for (const std::uint32_t w : mesh.face(f))
                        if (mesh.positions[w].y > 0.5)
                            return true;
        return false;
    };
    expect_ao(mesh, "0.9", {{"foot", 0.5, at_foot}});
}

// A seam of an unwrapped texture splits vertices, but the surface continues.
TEST(Contacts, SeamsOfSmoothSurfacesKeepTheirValues) {
    const Mesh sphere = test::sphere_mesh(4);
    Mesh split;
    std::vector<std::uint32_t> first;
    for (std::size_t f = 0; f < sphere.face_count(); ++f) {
        std::vector<std::uint32_t> corners;
        for (const std::uint32_t v : sphere.face(f)) {
            corners.push_back(static_cast<std::uint32_t>(split.positions.size()));
            split.positions.push_back(sphere.positions[v]);
            split.normals.push_back(Vec3(glm::normalize(sphere.positions[v])));
            first.push_back(v);
        }
        split.add_face(corners);
    }
    Mesh welded = sphere;
    for (const Vec3d& p : sphere.positions)
        welded.normals.push_back(Vec3(glm::normalize(p)));
    for (const Mesh* mesh : {&welded, &split}) {
        const Baked baked = bake(*mesh, {.radius = "10%", .method = "exact", .parameters = {{"rays", 256}}});
        for (const float ao : baked.ao())
            EXPECT_GT(ao, 0.98f);
        const Mesh inside = turned_inside_out(*mesh);
        Mesh flipped = inside;
        for (Vec3& n : flipped.normals)
            n = -n;
        // Inside a sphere of radius a: 1 − (R/2a)².
        const Baked cavity = bake(flipped, {.radius = "0.8", .method = "exact", .parameters = {{"rays", 1024}}});
        for (const float ao : cavity.ao())
            EXPECT_NEAR(ao, 1.0 - 0.4 * 0.4, 0.02);
    }
}

// Points on an edge get the same values as points near it. The quads are not flat, so faces that meet at an edge may each
// be in front of a part of the other.
TEST(Contacts, EdgesOfSmoothSurfacesAreNotDark) {
    Mesh mesh = floor_mesh(1.0, 12);
    for (Vec3d& p : mesh.positions)
        p.y = 0.12 * std::sin(5.0 * p.x + p.z) * std::sin(4.0 * p.z - 2.0 * p.x);
    const std::vector<Vec3> normals = angle_weighted_normals(mesh, triangulate(mesh).triangles);
    std::vector<SurfacePoint> at_edges, near_edges;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const std::span<const std::uint32_t> face = mesh.face(f);
        for (std::size_t k = 0; k < 4; ++k)
            for (const double along : {1e-5, 0.5}) {
                const auto point = [&](double inward) {
                    const double w[] = {(1.0 - along) * (1.0 - inward), along * (1.0 - inward), inward};
                    const std::uint32_t v[] = {face[k], face[(k + 1) % 4], face[(k + 2) % 4]};
                    Vec3d position(0.0), normal(0.0);
                    for (int i = 0; i < 3; ++i) {
                        position += w[i] * mesh.positions[v[i]];
                        normal += w[i] * Vec3d(normals[v[i]]);
                    }
                    return SurfacePoint{position, Vec3(glm::normalize(normal)), f};
                };
                at_edges.push_back(point(1e-5));
                near_edges.push_back(point(0.02));
            }
    }
    const BakeOptions options{.radius = "0.5", .method = "exact", .parameters = {{"rays", 256}}, .pilot = false};
    const Baked at = bake(mesh, at_edges, options), near = bake(mesh, near_edges, options);
    for (std::size_t i = 0; i < at_edges.size(); ++i)
        EXPECT_GT(at.ao()[i], near.ao()[i] - 0.2) << i;
}

// Each of two distant parts has the same occlusion as when it is baked alone, however large their joint bounding box
// is.
double rmse_between(std::span<const float> a, std::span<const float> b) {
    double squares = 0.0;
    for (std::size_t v = 0; v < b.size(); ++v)
        squares += std::pow(double{a[v]} - double{b[v]}, 2);
    return std::sqrt(squares / static_cast<double>(b.size()));
}

TEST(MeasuredRmse, IsRightForEightVertices) {
    const Mesh cube = moved(box_mesh({1, 1, 1}, 1), {0, 1, 0});
    const Baked truth = bake(
        cube,
        {.radius = "1", .method = "exact", .parameters = {{"rays", 4096}}, .seed = 99, .ground = true, .pilot = false});
    for (const Way& run : runs()) {
        BakeOptions options = run.options;
        options.radius = "1";
        options.ground = true;
        const Baked baked = bake(cube, options);
        const double rmse = rmse_between(baked.ao(), truth.ao());
        ASSERT_TRUE(baked.rmse);
        EXPECT_NEAR(*baked.rmse, rmse, std::max(0.3 * rmse, 0.004)) << run.name;
    }
}

// The rays start a tenth of the depth of the grooves above the surface.
TEST(MeasuredRmse, CountsTheHeightAtWhichRaysStart) {
    constexpr double radius = 0.3, ratio = 1e-5;
    Mesh grooves = floor_mesh(1.0, 64);
    for (Vec3d& p : grooves.positions)
        p.y = std::llround(32.0 * p.x) % 2 == 0 ? 0.0 : 0.04;
    Mesh both = grooves;
    add_part(both, grooves, 1.0, Vec3d(radius / ratio, 0, 0));
    const Baked alone =
        bake(grooves, {.radius = Length(radius), .method = "exact", .parameters = {{"rays", 512}}, .pilot = false});
    const Baked far = bake(both, {.radius = Length(radius), .method = "exact"});
    ASSERT_TRUE(far.rmse);
    EXPECT_GT(*far.rmse, 0.7 * rmse_between(far.ao(), alone.ao()));
}

// The usual height at which rays start is larger than the box. Its lower vertices see only what is above the floor, its
// upper vertices all but that.
TEST(Contacts, TinyPartsInLargeScenes) {
    Mesh mesh = moved(box_mesh({0.5, 0.5, 0.5}, 1), {0, 0.5, 0});
    const std::size_t vertices = mesh.vertex_count();
    add_part(mesh, floor_mesh(5000.0, 1), 1.0, {0, 0, 0});
    const double above = 0.5 * (1.0 - 1.0 / std::sqrt(3.0));
    for (const Way& run : runs()) {
        if (run.name == "traced" || run.name == "calibrated")
            continue; // the voxel is larger than the box
        BakeOptions options = run.options;
        options.radius = "1100";
        const Baked baked = bake(mesh, options);
        for (std::size_t v = 0; v < vertices; ++v)
            EXPECT_NEAR(baked.ao()[v], lower(mesh.positions[v]) ? above : 1.0 - above, run.tolerance)
                << run.name << ", vertex " << v;
    }
}

// With 32 rays, the ao of a corner would be off by up to 0.1 with some seeds.
TEST(Contacts, FewVerticesGetManyRays) {
    const Mesh room = turned_inside_out(box_mesh({1, 1, 1}, 1));
    for (const char* method : {"", "guided", "traced"})
        for (const std::uint32_t seed : {0u, 1u, 2u, 3u}) {
            const Baked baked = bake(room, {.radius = "0.5", .method = method, .seed = seed});
            for (const float ao : baked.ao())
                EXPECT_NEAR(ao, std::sqrt(3.0) / 4.0, 0.02) << baked.method << ", seed " << seed;
        }
}

TEST(Contacts, SmallRadiiInLargeScenes) {
    Mesh part = floor_mesh(1.0, 16);
    const auto wall_begin = part.vertex_count();
    Mesh wall = floor_mesh(0.5, 8);
    for (Vec3d& p : wall.positions)
        p = {0.0, p.x + 0.5, p.z}; // faces −x
    add_part(part, wall, 1.0, {0, 0, 0});
    ASSERT_GT(part.vertex_count(), wall_begin);
    constexpr double radius = 0.3;
    for (const double ratio : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        Mesh both = part;
        add_part(both, part, 1.0, Vec3d(radius / ratio, 0, 0));
        for (const Way& run : runs()) {
            if (run.name == "traced" || run.name == "calibrated")
                continue; // these methods warn of the voxel
            BakeOptions options = run.options;
            options.radius = Length(radius);
            const Baked alone = bake(part, options), far = bake(both, options);
            const double rmse = rmse_between(far.ao(), alone.ao());
            EXPECT_LT(rmse, 0.03) << run.name << ", R/D = " << ratio;
            ASSERT_TRUE(far.rmse);
            EXPECT_GT(*far.rmse, 0.7 * rmse - 0.01) << run.name << ", R/D = " << ratio;
        }
    }
    // Where the field does not help, and on meshes with few vertices, guided casts more than its default of 3 rays.
    Mesh both = part;
    add_part(both, part, 1.0, Vec3d(1e4 * radius, 0, 0));
    const Baked truth = bake(part, {.radius = Length(radius), .method = "exact", .parameters = {{"rays", 1024}}});
    const Baked guided = bake(both, {.radius = Length(radius), .method = "guided"});
    EXPECT_GE(guided.samples, 32);
    double squares = 0.0;
    for (std::size_t v = 0; v < part.vertex_count(); ++v)
        squares += std::pow(truth.ao()[v] - guided.ao()[v], 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(part.vertex_count())), 0.02);
    const Baked tiny = bake(part, {.radius = Length(1e-6), .method = "exact"});
    EXPECT_TRUE(std::any_of(tiny.warnings.begin(), tiny.warnings.end(), [](const std::string& warning) {
        return warning.find("rays have to start") != std::string::npos;
    }));
}

}
}
