#include "alcove/mesh/diagnose.h"

#include "solids.h"

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace alcove {
namespace {

/// The number of connected components of `count` items, where `linked` tests whether two are connected.
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

/// Counts edges, vertices and faces by their definitions, comparing all with all.
struct SlowDiagnosis {
    std::size_t edges = 0, open = 0, non_manifold = 0, flipped = 0, odd = 0, unbalanced = 0, components = 0;
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
            odd += (forward + backward) % 2 == 1;
            unbalanced += forward != backward;
        }
        const auto shares = [&](std::size_t f, std::size_t g, const std::function<bool(Edge)>& wanted) {
            for (const Edge& e : sides(f))
                if (wanted(e) && (uses(g, e) > 0 || uses(g, {e.second, e.first}) > 0))
                    return true;
            return false;
        };
        components = count_groups(
            faces.size(), [&](std::size_t f, std::size_t g) { return shares(f, g, [](Edge) { return true; }); });
        // Corners of a vertex are in the same fan if they share an edge at it.
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            std::vector<std::pair<std::uint32_t, std::uint32_t>> ends; // the neighbours of each corner at v
            for (const Face& face : faces)
                for (std::size_t i = 0; i < face.size(); ++i)
                    if (face[i] == v)
                        ends.emplace_back(face[(i + face.size() - 1) % face.size()], face[(i + 1) % face.size()]);
            non_manifold_vertices += count_groups(ends.size(), [&](std::size_t i, std::size_t j) {
                                         return ends[i].first == ends[j].first || ends[i].first == ends[j].second ||
                                                ends[i].second == ends[j].first || ends[i].second == ends[j].second;
                                     }) > 1;
        }
        std::map<std::multiset<std::uint32_t>, std::size_t> sets;
        for (const Face& face : faces)
            duplicates += sets[{face.begin(), face.end()}]++ > 0;
    }
};

/// A mesh of few vertices, so that many faces share an edge. Some vertices coincide, and one may not be finite. Faces
/// have 0 to 5 corners.
Mesh random_soup(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Mesh mesh;
    const std::size_t vertices = 4 + random() % 9;
    for (std::size_t v = 0; v < vertices; ++v)
        mesh.positions.push_back(v > 0 && random() % 5 == 0 ? mesh.positions[random() % v]
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

TEST(DiagnoseOracle, AgreesWithTheDefinitionsOnRandomSoups) {
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
        EXPECT_EQ(d.odd_edges, slow.odd);
        EXPECT_EQ(d.unbalanced_edges, slow.unbalanced);
        EXPECT_EQ(d.components, slow.components);
        EXPECT_EQ(d.non_manifold_vertices, slow.non_manifold_vertices);
        EXPECT_EQ(d.duplicate_faces, slow.duplicates);
        EXPECT_GE(d.degenerate_faces, slow.collapsed);
    }
}

TEST(DiagnoseOracle, OrderOfVerticesFacesAndCornersDoesNotMatter) {
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

TEST(DiagnoseOracle, CheapPartIsTheSame) {
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

TEST(DiagnoseOracle, HolesAndTouchingFansAgreeWithOpenMesh) {
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

        OpenMesh::PolyConnectivity other;
        std::vector<OpenMesh::VertexHandle> corners;
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
            other.add_vertex();
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
        // Where fans touch, the order of the boundary edges is a matter of convention.
        if (touching == 0) {
            EXPECT_EQ(d.boundary_loops, loops);
            ++compared;
        }
    }
    EXPECT_GT(compared, 20);
}

}
}
