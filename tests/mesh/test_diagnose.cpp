#include "alcove/mesh/diagnose.h"

#include "alcove/mesh/weld.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace alcove {
namespace {

using Face = std::vector<std::uint32_t>;

/// A cube of quads, faces outward, its corners at `low` + {0, size}.
Mesh cube(const Vec3d& low = Vec3d(0.0), double size = 1.0) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 8; ++i)
        mesh.positions.push_back(low + size * Vec3d(i & 1, (i >> 1) & 1, i >> 2));
    for (const Face& face : {Face{0, 2, 3, 1}, Face{4, 5, 7, 6}, Face{0, 1, 5, 4}, Face{2, 6, 7, 3},
                             Face{0, 4, 6, 2}, Face{1, 3, 7, 5}})
        mesh.add_face(face);
    return mesh;
}

Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Face& face : {Face{0, 2, 1}, Face{0, 1, 3}, Face{0, 3, 2}, Face{1, 2, 3}})
        mesh.add_face(face);
    return mesh;
}

std::vector<Face> faces_of(const Mesh& mesh) {
    std::vector<Face> faces;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
    return faces;
}

Mesh with_faces(const Mesh& mesh, const std::vector<Face>& faces) {
    Mesh result;
    result.positions = mesh.positions;
    for (const Face& face : faces)
        result.add_face(face);
    return result;
}

Mesh inverted(const Mesh& mesh) {
    std::vector<Face> faces = faces_of(mesh);
    for (Face& face : faces)
        std::reverse(face.begin(), face.end());
    return with_faces(mesh, faces);
}

Mesh together(const Mesh& a, const Mesh& b) {
    std::vector<Face> faces = faces_of(a);
    for (Face face : faces_of(b)) {
        for (std::uint32_t& v : face)
            v += static_cast<std::uint32_t>(a.vertex_count());
        faces.push_back(face);
    }
    Mesh both = with_faces(a, {});
    both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
    return with_faces(both, faces);
}

/// Every face with vertices of its own.
Mesh split(const Mesh& mesh) {
    Mesh result;
    for (Face face : faces_of(mesh)) {
        for (std::uint32_t& v : face) {
            result.positions.push_back(mesh.positions[v]);
            v = static_cast<std::uint32_t>(result.positions.size() - 1);
        }
        result.add_face(face);
    }
    return result;
}

/// Quads around a torus of m × n vertices.
Mesh torus(std::uint32_t m, std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < m; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n;
            const double r = 3 + std::cos(v);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), std::sin(v));
            const std::uint32_t k = (i + 1) % m, l = (j + 1) % n;
            mesh.add_face(Face{i * n + j, k * n + j, k * n + l, i * n + l});
        }
    return mesh;
}

std::ptrdiff_t euler(const Diagnosis& d) {
    return static_cast<std::ptrdiff_t>(d.vertices - d.coincident_vertices - d.unreferenced_vertices) -
           static_cast<std::ptrdiff_t>(d.edges) + static_cast<std::ptrdiff_t>(d.faces);
}

TEST(Diagnose, CubeIsClosedAndOriented) {
    const Diagnosis d = diagnose(cube({5, 6, 7}, 2.0));
    EXPECT_TRUE(d.closed());
    EXPECT_TRUE(d.oriented());
    EXPECT_EQ(d.vertices, 8u);
    EXPECT_EQ(d.faces, 6u);
    EXPECT_EQ(d.quads, 6u);
    EXPECT_EQ(d.triangles + d.larger_polygons, 0u);
    EXPECT_EQ(d.edges, 12u);
    EXPECT_EQ(d.components, 1u);
    EXPECT_EQ(d.closed_components, 1u);
    EXPECT_EQ(d.boundary_edges + d.open_edges + d.boundary_loops + d.non_manifold_edges, 0u);
    EXPECT_EQ(d.non_manifold_vertices + d.flipped_edges + d.inverted_components, 0u);
    EXPECT_EQ(d.degenerate_faces + d.duplicate_faces + d.unreferenced_vertices, 0u);
    EXPECT_EQ(d.non_finite_vertices + d.coincident_vertices, 0u);
    EXPECT_NEAR(d.signed_volume, 8.0, 1e-12);
    EXPECT_EQ(euler(d), 2);
    EXPECT_EQ(describe(d).size(), 1u);
}

TEST(Diagnose, MissingFaceIsOneHole) {
    std::vector<Face> faces = faces_of(cube());
    faces.pop_back();
    const Diagnosis d = diagnose(with_faces(cube(), faces));
    EXPECT_FALSE(d.closed());
    EXPECT_TRUE(d.oriented());
    EXPECT_EQ(d.open_edges, 4u);
    EXPECT_EQ(d.boundary_edges, 4u);
    EXPECT_EQ(d.boundary_loops, 1u);
    EXPECT_EQ(d.closed_components, 0u);
    EXPECT_EQ(d.signed_volume, 0.0);
    faces.erase(faces.begin() + 4); // the opposite one: a tube has two rims
    EXPECT_EQ(diagnose(with_faces(cube(), faces)).boundary_loops, 2u);
    EXPECT_EQ(euler(diagnose(with_faces(cube(), faces))), 0);
}

TEST(Diagnose, CubesThatShareAnEdgeAreNonManifoldThereYetBoundASolid) {
    const Diagnosis d = diagnose(together(cube(), cube({1, 1, 0})));
    EXPECT_EQ(d.non_manifold_edges, 1u);
    EXPECT_EQ(d.coincident_vertices, 2u);
    EXPECT_EQ(d.edges, 23u);
    EXPECT_EQ(d.non_manifold_vertices, 0u);
    EXPECT_EQ(d.components, 1u);
    EXPECT_TRUE(d.closed());
    EXPECT_NEAR(d.signed_volume, 2.0, 1e-12);
}

TEST(Diagnose, CubesThatShareAVertexTouchInAPoint) {
    const Diagnosis d = diagnose(together(cube(), cube({1, 1, 1})));
    EXPECT_EQ(d.non_manifold_vertices, 1u);
    EXPECT_EQ(d.non_manifold_edges, 0u);
    EXPECT_EQ(d.components, 2u);
    EXPECT_TRUE(d.closed());
}

TEST(Diagnose, AWallBetweenTwoCubesLeavesNoConsistentSide) {
    // Two cubes with one common face: three faces meet along its four edges.
    Mesh mesh = together(cube(), cube({1, 0, 0}));
    std::vector<Face> faces = faces_of(mesh);
    faces.erase(faces.begin() + 10);
    const Diagnosis d = diagnose(with_faces(mesh, faces));
    EXPECT_EQ(d.non_manifold_edges, 4u);
    EXPECT_EQ(d.unbalanced_edges, 4u);
    EXPECT_EQ(d.open_edges + d.flipped_edges, 0u);
    EXPECT_FALSE(d.closed());
}

TEST(Diagnose, PartsAreCountedAndTheirVolumesAdded) {
    const Diagnosis d = diagnose(together(tetrahedron(), cube({3, 3, 3}, 2.0)));
    EXPECT_EQ(d.components, 2u);
    EXPECT_EQ(d.closed_components, 2u);
    EXPECT_EQ(d.triangles, 4u);
    EXPECT_EQ(d.quads, 6u);
    EXPECT_NEAR(d.signed_volume, 8.0 + 1.0 / 6.0, 1e-12);
    EXPECT_EQ(euler(d), 4);
}

TEST(Diagnose, InsideOutPartsHaveNegativeVolume) {
    const Diagnosis alone = diagnose(inverted(cube()));
    EXPECT_TRUE(alone.closed());
    EXPECT_TRUE(alone.oriented());
    EXPECT_EQ(alone.inverted_components, 1u);
    EXPECT_NEAR(alone.signed_volume, -1.0, 1e-12);
    EXPECT_EQ(describe(alone).size(), 2u);

    const Diagnosis cavity = diagnose(together(cube({0, 0, 0}, 3.0), inverted(cube({1, 1, 1}, 1.0))));
    EXPECT_EQ(cavity.inverted_components, 1u);
    EXPECT_NEAR(cavity.signed_volume, 26.0, 1e-12);
    EXPECT_EQ(diagnose(together(cube({0, 0, 0}, 3.0), cube({1, 1, 1}, 1.0))).inverted_components, 0u);
}

TEST(Diagnose, TheSenseOfASmallFarPartIsStillSeen) {
    const Mesh far = together(cube({-1e6, 0, 0}), together(cube({1e6, 3e5, 7e5}, 1e-3), cube()));
    EXPECT_EQ(diagnose(far).inverted_components, 0u);
    EXPECT_EQ(diagnose(inverted(far)).inverted_components, 3u);
}

TEST(Diagnose, TwoSidedSheetIsClosedAndEnclosesNothing) {
    Mesh mesh;
    mesh.positions = {{0.1, 0.2, 0.3}, {1.3, 0.7, 0.9}, {0.2, 2.1, 0.4}, {30, 40, 50}};
    mesh.add_face(Face{0, 1, 2});
    mesh.add_face(Face{2, 1, 0});
    const Diagnosis d = diagnose(mesh);
    EXPECT_TRUE(d.closed());
    EXPECT_EQ(d.inverted_components, 0u);
    EXPECT_EQ(d.duplicate_faces, 1u);
}

TEST(Diagnose, OneFlippedFaceFlipsItsEdges) {
    std::vector<Face> faces = faces_of(cube());
    std::reverse(faces[2].begin(), faces[2].end());
    const Diagnosis d = diagnose(with_faces(cube(), faces));
    EXPECT_EQ(d.flipped_edges, 4u);
    EXPECT_EQ(d.open_edges, 0u);
    EXPECT_FALSE(d.oriented());
    EXPECT_FALSE(d.closed());
}

TEST(Diagnose, MoebiusStripCannotBeOriented) {
    constexpr std::uint32_t steps = 12;
    Mesh mesh;
    for (std::uint32_t i = 0; i < steps; ++i)
        for (const double side : {-0.3, 0.3}) {
            const double u = 2 * std::numbers::pi * i / steps;
            const double r = 1 + side * std::cos(u / 2);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), side * std::sin(u / 2));
        }
    for (std::uint32_t i = 0; i + 1 < steps; ++i)
        mesh.add_face(Face{2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
    mesh.add_face(Face{2 * steps - 2, 1, 0, 2 * steps - 1});
    const Diagnosis d = diagnose(mesh);
    EXPECT_EQ(d.flipped_edges, 1u);
    EXPECT_EQ(d.open_edges, 2 * steps);
    EXPECT_EQ(d.boundary_loops, 1u);
    EXPECT_EQ(euler(d), 0);
}

TEST(Diagnose, BrokenFacesAreCounted) {
    Mesh mesh = cube();
    mesh.positions.insert(mesh.positions.end(), {{9, 9, 9}, {NAN, 0, 0}, {0, -INFINITY, 0}, {0.5, 0, 0}});
    for (const Face& face : {Face{2, 3, 1, 0},          // the first face again
                             Face{1, 3, 2, 0},          // and from behind
                             Face{0, 1}, Face{0, 1, 1}, // no three corners
                             Face{0, 11, 1},            // on a line
                             Face{0, 1, 9}, Face{0, 1, 2, 10}})
        mesh.add_face(face);
    const Diagnosis d = diagnose(mesh);
    EXPECT_EQ(d.duplicate_faces, 2u);
    EXPECT_EQ(d.degenerate_faces, 3u);
    EXPECT_EQ(d.non_finite_vertices, 2u);
    EXPECT_EQ(d.unreferenced_vertices, 1u);
    EXPECT_EQ(d.coincident_vertices, 0u);
    EXPECT_EQ(d.non_manifold_edges, 4u); // around the face that is there three times
    EXPECT_EQ(d.open_edges, 2u);         // from 0 to 11 and from 11 to 1
}

TEST(Diagnose, ThinFacesAreNotDegenerateAtAnyScale) {
    for (const double scale : {1e-200, 1.0, 1e200}) {
        Mesh mesh;
        mesh.positions = {scale * Vec3d(0, 0, 0), scale * Vec3d(1, 0, 0), scale * Vec3d(0.5, 1e-9, 0),
                          scale * Vec3d(0.25, 0, 0)};
        mesh.add_face(Face{0, 1, 2});
        EXPECT_EQ(diagnose(mesh).degenerate_faces, 0u);
        mesh.add_face(Face{0, 1, 3});
        EXPECT_EQ(diagnose(mesh).degenerate_faces, 1u);
    }
}

TEST(Diagnose, SeamsCloseWhenCoincidentVerticesAreJoined) {
    const Diagnosis d = diagnose(split(cube()));
    EXPECT_TRUE(d.closed());
    EXPECT_EQ(d.vertices, 24u);
    EXPECT_EQ(d.coincident_vertices, 16u);
    EXPECT_EQ(d.boundary_edges, 24u);
    EXPECT_EQ(d.seam_edges(), 24u);
    EXPECT_EQ(d.edges, 12u);
    EXPECT_EQ(d.components, 1u);
    EXPECT_NEAR(d.signed_volume, 1.0, 1e-12);
    EXPECT_EQ(euler(d), 2);
}

TEST(Diagnose, TorusHasTheCharacteristicAndVolumeOfATorus) {
    const Diagnosis d = diagnose(torus(200, 100));
    EXPECT_TRUE(d.closed());
    EXPECT_EQ(euler(d), 0);
    EXPECT_NEAR(d.signed_volume, 6 * std::numbers::pi * std::numbers::pi, 0.1);
}

TEST(Diagnose, NothingIsNotClosed) {
    EXPECT_FALSE(diagnose(Mesh{}).closed());
    EXPECT_EQ(diagnose(Mesh{}).components, 0u);
}

TEST(Diagnose, WordsNameTheCountsAndTheMend) {
    std::vector<Face> faces = faces_of(cube());
    faces.pop_back();
    const auto lines = describe(diagnose(with_faces(cube(), faces)));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].find("4 open edges in 1 hole"), 0u);
    EXPECT_NE(lines[0].find("fill"), std::string::npos);
}

// --- against slower ways to the same numbers

/// Components of `count` things, where `linked` says which two belong together.
std::size_t count_groups(std::size_t count, const std::function<bool(std::size_t, std::size_t)>& linked) {
    std::vector<bool> seen(count, false);
    std::size_t groups = 0;
    for (std::size_t start = 0; start < count; ++start) {
        if (seen[start])
            continue;
        ++groups;
        std::vector<std::size_t> todo{start};
        seen[start] = true;
        while (!todo.empty()) {
            const std::size_t at = todo.back();
            todo.pop_back();
            for (std::size_t other = 0; other < count; ++other)
                if (!seen[other] && linked(at, other)) {
                    seen[other] = true;
                    todo.push_back(other);
                }
        }
    }
    return groups;
}

/// The counts of edges, vertices and faces, from their definitions by comparing all with all.
struct SlowDiagnosis {
    std::size_t edges = 0, open = 0, non_manifold = 0, flipped = 0, unbalanced = 0, components = 0;
    std::size_t non_manifold_vertices = 0, duplicates = 0, collapsed = 0;

    explicit SlowDiagnosis(const Mesh& mesh, bool join = true) {
        std::vector<Face> faces;
        for (Face face : faces_of(mesh)) {
            if (std::any_of(face.begin(), face.end(), [&](auto v) { return !is_finite(mesh.positions[v]); }))
                continue;
            for (std::uint32_t& v : face)
                for (std::uint32_t u = 0; join && u < v; ++u)
                    if (mesh.positions[u] == mesh.positions[v])
                        v = u;
            for (std::size_t i = 0; i < face.size() && face.size() > 1;)
                if (face[i] == face[(i + 1) % face.size()])
                    face.erase(face.begin() + static_cast<std::ptrdiff_t>(i)), i = 0;
                else
                    ++i;
            if (face.size() >= 3)
                faces.push_back(face);
            else
                ++collapsed;
        }
        using Edge = std::pair<std::uint32_t, std::uint32_t>;
        const auto sides = [&](std::size_t f) {
            std::vector<Edge> result;
            for (std::size_t i = 0; i < faces[f].size(); ++i)
                result.emplace_back(faces[f][i], faces[f][(i + 1) % faces[f].size()]);
            return result;
        };
        const auto uses = [&](std::size_t f, const Edge& e) {
            const auto all = sides(f);
            return std::count(all.begin(), all.end(), e);
        };
        std::set<Edge> distinct;
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (const auto& [a, b] : sides(f))
                distinct.insert({std::min(a, b), std::max(a, b)});
        edges = distinct.size();
        for (const Edge& e : distinct) {
            std::ptrdiff_t forward = 0, backward = 0;
            for (std::size_t f = 0; f < faces.size(); ++f) {
                forward += uses(f, e);
                backward += uses(f, {e.second, e.first});
            }
            open += forward + backward == 1;
            non_manifold += forward + backward >= 3;
            flipped += forward + backward == 2 && forward != backward;
            unbalanced += forward != backward;
        }
        const auto shares = [&](std::size_t f, std::size_t g, const std::function<bool(Edge)>& wanted) {
            for (const Edge& e : sides(f))
                if (wanted(e) && (uses(g, e) > 0 || uses(g, {e.second, e.first}) > 0))
                    return true;
            return false;
        };
        components = count_groups(faces.size(), [&](std::size_t f, std::size_t g) {
            return shares(f, g, [](Edge) { return true; });
        });
        // Corners of a vertex are in one fan when they share an edge at it.
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            std::vector<std::pair<std::uint32_t, std::uint32_t>> ends; // the neighbours of each corner at v
            for (const Face& face : faces)
                for (std::size_t i = 0; i < face.size(); ++i)
                    if (face[i] == v)
                        ends.emplace_back(face[(i + face.size() - 1) % face.size()],
                                          face[(i + 1) % face.size()]);
            non_manifold_vertices +=
                count_groups(ends.size(), [&](std::size_t i, std::size_t j) {
                    return ends[i].first == ends[j].first || ends[i].first == ends[j].second ||
                           ends[i].second == ends[j].first || ends[i].second == ends[j].second;
                }) > 1;
        }
        std::map<std::multiset<std::uint32_t>, std::size_t> sets;
        for (const Face& face : faces)
            duplicates += sets[{face.begin(), face.end()}]++ > 0;
    }
};

/// Few vertices, so that edges are shared by many; some at one place, one not finite; faces of 0 to 5
/// corners.
Mesh random_soup(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Mesh mesh;
    const std::size_t vertices = 4 + random() % 9;
    for (std::size_t v = 0; v < vertices; ++v)
        mesh.positions.push_back(v > 0 && random() % 5 == 0
                                     ? mesh.positions[random() % v]
                                     : Vec3d(unit(random), unit(random), unit(random)));
    if (random() % 4 == 0)
        mesh.positions[random() % vertices].y = NAN;
    for (std::size_t f = random() % 14; f > 0; --f) {
        Face face(random() % 8 == 0 ? random() % 3 : 3 + random() % 3);
        for (std::uint32_t& v : face)
            v = static_cast<std::uint32_t>(random() % vertices);
        mesh.add_face(face);
    }
    return mesh;
}

TEST(Diagnose, AgreesWithTheDefinitionsOnRandomSoups) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int round = 0; round < 2000 && !testing::Test::HasFailure(); ++round) {
        const Mesh mesh = random_soup(random);
        const Diagnosis d = diagnose(mesh);
        const SlowDiagnosis slow(mesh);
        EXPECT_EQ(d.edges, slow.edges);
        EXPECT_EQ(d.open_edges, slow.open);
        EXPECT_EQ(d.boundary_edges, SlowDiagnosis(mesh, false).open);
        EXPECT_EQ(d.non_manifold_edges, slow.non_manifold);
        EXPECT_EQ(d.flipped_edges, slow.flipped);
        EXPECT_EQ(d.unbalanced_edges, slow.unbalanced);
        EXPECT_EQ(d.components, slow.components);
        EXPECT_EQ(d.non_manifold_vertices, slow.non_manifold_vertices);
        EXPECT_EQ(d.duplicate_faces, slow.duplicates);
        EXPECT_GE(d.degenerate_faces, slow.collapsed);
    }
}

TEST(Diagnose, OrderOfVerticesFacesAndCornersDoesNotMatter) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int round = 0; round < 300 && !testing::Test::HasFailure(); ++round) {
        const Mesh mesh = round % 3 ? random_soup(random) : together(split(cube()), torus(7, 5));
        std::vector<std::uint32_t> place(mesh.vertex_count());
        std::iota(place.begin(), place.end(), 0u);
        std::shuffle(place.begin(), place.end(), random);
        Mesh shuffled;
        shuffled.positions.resize(place.size());
        for (std::size_t v = 0; v < place.size(); ++v)
            shuffled.positions[place[v]] = mesh.positions[v];
        std::vector<Face> faces = faces_of(mesh);
        std::shuffle(faces.begin(), faces.end(), random);
        for (Face& face : faces) {
            for (std::uint32_t& v : face)
                v = place[v];
            if (!face.empty())
                std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()),
                            face.end());
        }
        shuffled = with_faces(shuffled, faces);
        const Diagnosis a = diagnose(mesh), b = diagnose(shuffled);
        EXPECT_EQ(describe(a), describe(b));
        EXPECT_EQ(a.boundary_edges, b.boundary_edges);
        EXPECT_EQ(a.unbalanced_edges, b.unbalanced_edges);
        EXPECT_EQ(a.components, b.components);
        EXPECT_EQ(a.closed_components, b.closed_components);
        EXPECT_EQ(a.coincident_vertices, b.coincident_vertices);
        EXPECT_NEAR(a.signed_volume, b.signed_volume, 1e-9);
    }
}

TEST(Diagnose, CheapPartIsTheSame) {
    std::mt19937 random(4);
    for (int round = 0; round < 50; ++round) {
        const Mesh mesh = random_soup(random);
        const Closedness cheap = closedness(mesh), whole = diagnose(mesh);
        EXPECT_EQ(cheap.unbalanced_edges, whole.unbalanced_edges);
        EXPECT_EQ(cheap.closed(), whole.closed());
        EXPECT_EQ(cheap.inverted_components, whole.inverted_components);
        EXPECT_EQ(cheap.signed_volume, whole.signed_volume);
    }
}

TEST(Diagnose, HolesAndTouchingFansAgreeWithOpenMesh) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    int compared = 0;
    for (int round = 0; round < 300; ++round) {
        const Mesh whole = torus(12, 10);
        std::vector<Face> faces = faces_of(whole);
        std::shuffle(faces.begin(), faces.end(), random);
        faces.resize(faces.size() - random() % 40);
        const Mesh mesh = with_faces(whole, faces);

        OpenMesh::PolyMesh_ArrayKernelT<> other;
        std::vector<OpenMesh::VertexHandle> corners;
        for (const Vec3d& p : mesh.positions)
            other.add_vertex(OpenMesh::Vec3f(OpenMesh::Vec3d(p.x, p.y, p.z)));
        for (const Face& face : faces) {
            corners.clear();
            for (const std::uint32_t v : face)
                corners.emplace_back(static_cast<int>(v));
            ASSERT_TRUE(other.add_face(corners).is_valid());
        }
        std::size_t touching = 0, isolated = 0, boundary = 0, loops = 0;
        for (const auto v : other.vertices()) {
            touching += !other.is_manifold(v);
            isolated += other.is_isolated(v);
        }
        std::set<int> seen;
        for (const auto h : other.halfedges()) {
            if (!other.is_boundary(h))
                continue;
            ++boundary;
            if (seen.contains(h.idx()))
                continue;
            ++loops;
            for (auto at = OpenMesh::HalfedgeHandle(h); seen.insert(at.idx()).second;)
                at = other.next_halfedge_handle(at);
        }
        const Diagnosis d = diagnose(mesh);
        EXPECT_EQ(d.edges, other.n_edges());
        EXPECT_EQ(d.open_edges, boundary);
        EXPECT_EQ(d.unreferenced_vertices, isolated);
        EXPECT_EQ(d.non_manifold_vertices, touching);
        // Where fans touch, which rim follows which is a matter of convention.
        if (touching == 0) {
            EXPECT_EQ(d.boundary_loops, loops);
            ++compared;
        }
    }
    EXPECT_GT(compared, 20);
}

TEST(Weld, NamesTheFirstVertexOfEachPlace) {
    std::mt19937 random(9);
    std::vector<Vec3d> positions{
        {0.0, -0.0, 0.0}, {-0.0, 0.0, 0.0}, {NAN, 0, 0}, {NAN, 0, 0}, {INFINITY, 1, 2}};
    for (int i = 0; i < 400; ++i)
        positions.push_back(1e-9 * Vec3d(random() % 5, random() % 5, random() % 5));
    const auto joined = weld(positions);
    ASSERT_EQ(joined.size(), positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        std::uint32_t first = 0;
        while (first < v && !(positions[first] == positions[v]))
            ++first;
        EXPECT_EQ(joined[v], first) << "vertex " << v;
    }
    EXPECT_TRUE(weld({}).empty());
}

TEST(Weld, ManyVerticesThatEqualNoneStayLinear) {
    const std::vector<Vec3d> positions(500000, Vec3d(NAN));
    const auto joined = weld(positions);
    EXPECT_TRUE(std::is_sorted(joined.begin(), joined.end()));
    EXPECT_EQ(joined.back(), positions.size() - 1);
}

}
}
