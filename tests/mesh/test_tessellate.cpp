#include "alcove/mesh/detail/tessellate.h"

#include "solids.h"

#include "alcove/base/types.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/triangulate.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LongestEdgeT.hh>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace alcove {
namespace {

Mesh unit_quad() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_face(Face{0, 1, 2, 3});
    return mesh;
}

/// The number of faces at each edge.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges_of(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Face& face : faces_of(mesh))
        for (std::size_t i = 0; i < face.size(); ++i)
            ++edges[std::minmax(face[i], face[(i + 1) % face.size()])];
    return edges;
}

double longest_edge(const Mesh& mesh) {
    double longest = 0.0;
    for (const auto& [edge, uses] : edges_of(mesh))
        longest = std::fmax(longest, glm::distance(mesh.positions[edge.first], mesh.positions[edge.second]));
    return longest;
}

/// The vector sum of the areas, which also detects a face with reversed orientation.
Vec3d area_of(const Mesh& mesh) {
    Vec3d area(0.0);
    for (const auto& [a, b, c] : triangulate(mesh).triangles)
        area += 0.5 * glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    return area;
}

void expect_first_vertices(const Mesh& mesh, const Mesh& first) {
    ASSERT_GE(mesh.vertex_count(), first.vertex_count());
    for (std::size_t v = 0; v < first.vertex_count(); ++v)
        EXPECT_EQ(mesh.positions[v], first.positions[v]) << v;
}

using Corners = std::set<std::array<double, 3>>;

std::multiset<Corners> triangle_places(const Mesh& mesh) {
    std::multiset<Corners> places;
    for (const Face& face : faces_of(mesh)) {
        Corners corners;
        for (const std::uint32_t v : face)
            corners.insert({mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z});
        places.insert(corners);
    }
    return places;
}

Mesh rough_tetrahedron(std::mt19937& random) {
    std::uniform_real_distribution<double> offset(-0.2, 0.2);
    Mesh mesh = tetrahedron();
    for (Vec3d& p : mesh.positions)
        p += Vec3d(offset(random), offset(random), offset(random));
    return mesh;
}

TEST(Tessellate, SplitsAQuadUntilNoEdgeIsLonger) {
    const Mesh quad = unit_quad();
    const Mesh mesh = tessellate(quad, {.longest = 0.1});
    EXPECT_LE(longest_edge(mesh), 0.1);
    EXPECT_EQ(area_of(mesh), Vec3d(0, 0, 1));
    EXPECT_TRUE(mesh.warnings.empty());
    expect_first_vertices(mesh, quad);
    for (const auto& [edge, uses] : edges_of(mesh)) {
        const Vec3d middle = 0.5 * (mesh.positions[edge.first] + mesh.positions[edge.second]);
        const bool on_rim = middle.x == 0.0 || middle.x == 1.0 || middle.y == 0.0 || middle.y == 1.0;
        EXPECT_EQ(uses, on_rim ? 1 : 2);
    }
}

TEST(Tessellate, GivesTheTrianglesOfOpenMesh) {
    struct Traits : OpenMesh::DefaultTraits {
        using Point = OpenMesh::Vec3d;
    };
    using OpenMeshType = OpenMesh::TriMesh_ArrayKernelT<Traits>;
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Mesh solid = rough_tetrahedron(random);

    OpenMeshType other;
    for (const Vec3d& p : solid.positions)
        other.add_vertex({p.x, p.y, p.z});
    for (const Face& f : faces_of(solid))
        other.add_face(OpenMesh::VertexHandle(int(f[0])), OpenMesh::VertexHandle(int(f[1])),
                       OpenMesh::VertexHandle(int(f[2])));
    OpenMesh::Subdivider::Uniform::LongestEdgeT<OpenMeshType, double> subdivider;
    subdivider.attach(other);
    subdivider.set_max_edge_length(0.1);
    subdivider(1);
    subdivider.detach();
    std::multiset<Corners> expected;
    for (const auto face : other.faces()) {
        Corners corners;
        for (const auto v : face.vertices())
            corners.insert({other.point(v)[0], other.point(v)[1], other.point(v)[2]});
        expected.insert(corners);
    }
    EXPECT_EQ(triangle_places(tessellate(solid, {.longest = 0.1})), expected);
}

TEST(Tessellate, AClosedSolidStaysClosed) {
    for (const double longest : {1.5, 0.9, 0.3, 0.05}) {
        const Mesh mesh = tessellate(cube(), {.longest = longest});
        const Diagnosis found = diagnose(mesh);
        EXPECT_TRUE(found.closed()) << longest;
        EXPECT_EQ(found.non_manifold_edges + found.seam_edges() + found.coincident_vertices, 0u) << longest;
        EXPECT_NEAR(found.signed_volume, 1.0, 1e-12) << longest;
        EXPECT_LE(longest_edge(mesh), longest);
    }
}

TEST(Tessellate, FacesThatNeedNoSplitStayPolygonsInTheirPlace) {
    // A long quad at an edge of the cube, in the middle of the face list.
    Mesh mesh = cube();
    mesh.positions.insert(mesh.positions.end(), {{1, -3, 0}, {0, -3, 0}});
    std::vector<Face> before = faces_of(mesh);
    before.insert(before.begin() + 2, Face{1, 0, 9, 8});
    mesh = with_faces(mesh, before);
    mesh.face_colors.assign(mesh.face_count(), Color{1, 2, 3, 255});
    mesh.face_colors[2] = {9, 8, 7, 6};
    const Mesh result = tessellate(mesh, {.longest = 1.0});
    const std::vector<Face> faces = faces_of(result);
    ASSERT_GT(faces.size(), 10u);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const bool of_cube = f < 2 || f + 4 >= faces.size();
        EXPECT_EQ(faces[f].size(), of_cube ? 4u : 3u) << f;
        EXPECT_EQ(result.face_colors[f], mesh.face_colors[of_cube ? 0 : 2]) << f;
        if (of_cube) {
            EXPECT_EQ(faces[f], before[f < 2 ? f : f + before.size() - faces.size()]);
        }
    }
    EXPECT_EQ(longest_edge(result), 1.0);
}

TEST(Tessellate, APolygonOfShortSidesIsSplitIfItIsWide) {
    Mesh disc;
    for (int i = 0; i < 100; ++i)
        disc.positions.emplace_back(std::cos(0.02 * std::numbers::pi * i), std::sin(0.02 * std::numbers::pi * i), 0);
    Face rim(100);
    std::iota(rim.begin(), rim.end(), 0u);
    disc.add_face(rim);
    EXPECT_EQ(tessellate(disc, {.longest = 1.01}).face_count(), 1u);
    const Mesh result = tessellate(disc, {.longest = 0.1});
    EXPECT_LE(longest_edge(result), 0.1);
    EXPECT_NEAR(area_of(result).z, area_of(disc).z, 1e-12);
}

TEST(Tessellate, NothingToSplitGivesTheSameMesh) {
    Mesh mesh = cube();
    mesh.warnings = {"as before"};
    for (const double longest : {0.0, 1.0, 1e300, HUGE_VAL}) {
        const Mesh result = tessellate(mesh, {.longest = longest});
        EXPECT_EQ(faces_of(result), faces_of(mesh));
        EXPECT_EQ(result.warnings, mesh.warnings);
    }
    EXPECT_EQ(tessellate(Mesh{}, {.longest = 1.0}).face_count(), 0u);
}

TEST(Tessellate, RefusesLengthsThatAreNone) {
    EXPECT_THROW(tessellate(cube(), {.longest = -1.0}), InputError);
    EXPECT_THROW(tessellate(cube(), {.longest = NAN}), InputError);
    EXPECT_THROW(tessellate(cube(), SplitPredicate(), {.shortest = NAN}), InputError);
    EXPECT_THROW(tessellate(cube(), SplitPredicate(), {.spacing = -1.0}), InputError);
}

TEST(Tessellate, TheLimitOnFacesSplitsTheLongestEdgesAndSaysSo) {
    const Mesh mesh = together(cube(Vec3d(0.0), 8.0), cube(Vec3d(20.0)));
    const std::vector<Face> faces = faces_of(mesh);
    const Mesh result = tessellate(mesh, {.longest = 1e-9, .most_faces = 500});
    EXPECT_LE(result.face_count(), 500u);
    EXPECT_GE(result.face_count(), 250u);
    EXPECT_TRUE(closedness(result).closed());
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("the limit is 500 faces"), std::string::npos) << result.warnings[0];
    // The longest edges are those of the large cube; the small one is not split.
    EXPECT_EQ(faces_of(result).back(), faces.back());
    EXPECT_LE(longest_edge(result), 2.0);

    const Mesh none = tessellate(mesh, {.longest = 0.5, .most_faces = 5});
    EXPECT_EQ(faces_of(none), faces);
    EXPECT_EQ(none.warnings.size(), 1u);
}

TEST(Tessellate, ThreeFacesAtAnEdgeStayJoined) {
    Mesh fan;
    fan.positions = {{0, 0, 0}, {0, 0, 2}, {1, 0, 0.5}, {-1, 1, 0.5}, {-1, -1, 1.5}};
    for (const Face& face : {Face{0, 1, 2}, Face{0, 1, 3}, Face{1, 0, 4}})
        fan.add_face(face);
    const Mesh mesh = tessellate(fan, {.longest = 0.3});
    EXPECT_LE(longest_edge(mesh), 0.3);
    int shared = 0;
    for (const auto& [edge, uses] : edges_of(mesh)) {
        const Vec3d &a = mesh.positions[edge.first], &b = mesh.positions[edge.second];
        const bool on_axis = a.x == 0 && a.y == 0 && b.x == 0 && b.y == 0;
        EXPECT_EQ(uses == 3, on_axis);
        shared += on_axis;
    }
    EXPECT_EQ(shared, 8);
    EXPECT_EQ(diagnose(mesh).coincident_vertices, 0u);
    EXPECT_EQ(closedness(mesh).components, 1u);
}

/// Checks that no midpoint of an edge is a vertex.
void expect_no_vertex_within_an_edge(const Mesh& mesh) {
    std::set<std::array<double, 3>> places;
    for (const Vec3d& p : mesh.positions)
        places.insert({p.x, p.y, p.z});
    std::size_t within = 0;
    for (const auto& [edge, uses] : edges_of(mesh)) {
        const Vec3d p = 0.5 * mesh.positions[edge.first] + 0.5 * mesh.positions[edge.second];
        within += edge.first != edge.second && places.contains({p.x, p.y, p.z});
    }
    EXPECT_EQ(within, 0u);
}

TEST(Tessellate, AnySoupStaysJoined) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int round = 0; round < 50; ++round) {
        Mesh soup;
        for (int v = 0; v < 8; ++v)
            soup.positions.emplace_back(unit(random), unit(random), unit(random));
        for (int f = 0; f < 12; ++f) {
            Face face{0, 1, 2, 3, 4, 5, 6, 7};
            std::shuffle(face.begin(), face.end(), random);
            face.resize(3 + random() % 3);
            soup.add_face(face);
        }
        expect_no_vertex_within_an_edge(tessellate(soup, {.longest = 0.1 + unit(random)}));
        const auto some = [&](std::span<const PointBetween> points) {
            std::vector<bool> answers(points.size());
            for (std::size_t i = 0; i < answers.size(); ++i)
                answers[i] = unit(random) < 0.1;
            return answers;
        };
        expect_no_vertex_within_an_edge(tessellate(soup, some, {.shortest = 0.2, .most_faces = 300 + random() % 200}));
    }
}

TEST(Tessellate, BrokenFacesAndVerticesStay) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {NAN, 0, 0}, {0, INFINITY, 0}, {0, 1, 0}, {0, 0, 9}};
    const std::vector<Face> broken{{0, 1, 3}, {0, 4, 1}, {}, {0}, {0, 1}, {1, 1, 0}, {0, 0, 0}};
    for (const Face& face : broken)
        mesh.add_face(face);
    mesh.add_face(Face{0, 1, 2});    // no area
    mesh.add_face(Face{0, 1, 1, 5}); // a corner twice
    const Mesh result = tessellate(mesh, {.longest = 0.3});
    const auto faces = faces_of(result);
    ASSERT_GT(faces.size(), broken.size() + 4);
    EXPECT_EQ(std::vector<Face>(faces.begin(), faces.begin() + std::ptrdiff_t(broken.size())), broken);
    EXPECT_TRUE(std::isnan(result.positions[3].x));
    EXPECT_TRUE(std::isinf(result.positions[4].y));
    EXPECT_EQ(area_of(result).z, 0.5);
    // The triangle without area is split like its neighbour.
    EXPECT_EQ(diagnose(result).duplicate_faces, 0u);
    EXPECT_NO_THROW(tessellate(result, {.longest = 0.01}));
}

TEST(Tessellate, EndsWhereNumbersDo) {
    Mesh mesh = unit_quad();
    for (Vec3d& p : mesh.positions)
        p = p * 4e-16 + Vec3d(1.0, 1.0, 0.0);
    EXPECT_LT(tessellate(mesh, {.longest = 1e-300}).face_count(), 100u);
    const Mesh quad = unit_quad();
    for (const double scale : {1e-300, 1e-160, 1e160, 1e300}) {
        Mesh scaled = quad;
        for (Vec3d& p : scaled.positions)
            p *= scale;
        EXPECT_EQ(tessellate(scaled, {.longest = 0.1 * scale}).face_count(),
                  tessellate(quad, {.longest = 0.1}).face_count());
    }
}

}
}
