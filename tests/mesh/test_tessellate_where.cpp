#include "alcove/mesh/detail/tessellate.h"

#include "solids.h"

#include "alcove/mesh/diagnose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace alcove {
namespace {

Mesh floor_of(double size, int quads) {
    Mesh mesh;
    for (int y = 0; y <= quads; ++y)
        for (int x = 0; x <= quads; ++x)
            mesh.positions.emplace_back(size * x / quads, size * y / quads, 0.0);
    const auto row = static_cast<std::uint32_t>(quads + 1);
    for (std::uint32_t y = 0; y + 1 < row; ++y)
        for (std::uint32_t x = 0; x + 1 < row; ++x)
            mesh.add_face(Face{y * row + x, y * row + x + 1, (y + 1) * row + x + 1, (y + 1) * row + x});
    return mesh;
}

/// A predicate that returns true where a function differs from its interpolation. Also checks the weights.
class Differs {
  public:
    using Function = std::function<double(const Vec3d&)>;
    Differs(const Mesh& mesh, Function function, double error) : function_(std::move(function)), error_(error) {
        for (const Vec3d& p : mesh.positions)
            places_.push_back(p);
    }

    std::vector<bool> operator()(std::span<const PointBetween> points) {
        std::vector<bool> answers;
        for (const PointBetween& point : points)
            places_.push_back(point.position);
        for (const PointBetween& point : points) {
            Vec3d place(0.0);
            double value = 0.0;
            for (int i = 0; i < 3; ++i) {
                const Vec3d& end = places_.at(point.ends[std::size_t(i)]);
                place += point.weights[i] * end;
                value += point.weights[i] * function_(end);
            }
            EXPECT_NEAR(glm::distance(place, point.position), 0.0, 1e-12);
            EXPECT_NEAR(point.weights.x + point.weights.y + point.weights.z, 1.0, 1e-12);
            answers.push_back(std::abs(value - function_(point.position)) > error_);
        }
        return answers;
    }
    std::size_t tested() const { return places_.size(); }

  private:
    Function function_;
    double error_;
    std::vector<Vec3d> places_;
};

/// The largest difference between a function and its interpolation at the middles of edges and faces.
double largest_difference(const Mesh& mesh, const Differs::Function& function) {
    double largest = 0.0;
    for (const Face& face : faces_of(mesh)) {
        Vec3d centre(0.0);
        double mean = 0.0;
        for (std::size_t i = 0; i < face.size(); ++i) {
            const Vec3d &a = mesh.positions[face[i]], &b = mesh.positions[face[(i + 1) % face.size()]];
            largest = std::fmax(largest, std::abs(function(0.5 * (a + b)) - 0.5 * (function(a) + function(b))));
            centre += a / double(face.size());
            mean += function(a) / double(face.size());
        }
        largest = std::fmax(largest, std::abs(function(centre) - mean));
    }
    return largest;
}

/// In degrees.
double smallest_angle(const Mesh& mesh) {
    double smallest = 180.0;
    for (const Face& face : faces_of(mesh))
        for (std::size_t i = 0; i < face.size(); ++i) {
            const Vec3d& at = mesh.positions[face[i]];
            const Vec3d a = mesh.positions[face[(i + 1) % face.size()]] - at;
            const Vec3d b = mesh.positions[face[(i + face.size() - 1) % face.size()]] - at;
            smallest = std::fmin(smallest,
                                 std::acos(glm::dot(glm::normalize(a), glm::normalize(b))) * 180.0 / std::numbers::pi);
        }
    return smallest;
}

/// A function that is 0 at a point, increases around it and is 1 beyond the radius.
Differs::Function spot(const Vec3d& centre, double radius) {
    return [=](const Vec3d& p) { return std::fmin(1.0, std::pow(glm::distance(p, centre) / radius, 2.0)); };
}

TEST(TessellateWhere, AFunctionVariesUntilItIsMet) {
    const Mesh floor = floor_of(1.0, 1);
    const auto dark = spot({0.5, 0.5, 0}, 0.4);
    Differs differs(floor, dark, 0.02);
    const Mesh mesh = tessellate(floor, std::ref(differs), {});
    EXPECT_LE(largest_difference(mesh, dark), 0.02);
    EXPECT_GT(mesh.face_count(), 50u);
    EXPECT_LT(mesh.face_count(), 2000u);
    EXPECT_TRUE(mesh.warnings.empty());
    const Closedness found = closedness(mesh);
    EXPECT_EQ(found.components, 1u);
    EXPECT_EQ(found.non_manifold_edges + found.flipped_edges, 0u);
    std::size_t rim = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        rim += std::fmin(std::fmin(mesh.positions[v].x, mesh.positions[v].y),
                         std::fmin(1 - mesh.positions[v].x, 1 - mesh.positions[v].y)) == 0.0;
    EXPECT_EQ(found.open_edges, rim); // no vertex lies inside an edge of the rim
}

TEST(TessellateWhere, OnlyTheFacesThereAreSplit) {
    const Mesh floor = floor_of(10.0, 10);
    const auto dark = spot({2.5, 2.5, 0}, 0.4);
    Differs differs(floor, dark, 0.05);
    const Mesh mesh = tessellate(floor, std::ref(differs), {});
    EXPECT_GT(mesh.face_count(), 120u);
    for (std::size_t v = floor.vertex_count(); v < mesh.vertex_count(); ++v)
        EXPECT_LE(glm::distance(mesh.positions[v], Vec3d(2.5, 2.5, 0)), 1.6);
    const auto faces = faces_of(mesh);
    const auto quads = std::count_if(faces.begin(), faces.end(), [](const Face& f) { return f.size() == 4; });
    EXPECT_GE(quads, 90);
}

TEST(TessellateWhere, NothingVariesNothingChanges) {
    const Mesh solid = cube();
    Differs differs(
        solid, [](const Vec3d& p) { return 1.0 + p.x - 2.0 * p.y; }, 1e-9);
    EXPECT_EQ(faces_of(tessellate(solid, std::ref(differs), {})), faces_of(solid));
    EXPECT_EQ(differs.tested(), 8u + 18u + 12u); // midpoints of edges and diagonals, and centres of triangles
}

TEST(TessellateWhere, PointsAtASpacingFindWhatTheMiddlesMiss) {
    const Mesh floor = floor_of(10.0, 1);
    const auto dark = spot({7.3, 2.1, 0}, 0.5);
    Differs coarse(floor, dark, 0.05), fine(floor, dark, 0.05);
    EXPECT_EQ(tessellate(floor, std::ref(coarse), {}).face_count(), 1u);
    const Mesh mesh = tessellate(floor, std::ref(fine), {.spacing = 0.4});
    EXPECT_LE(largest_difference(mesh, dark), 0.05);
    EXPECT_GT(mesh.face_count(), 20u);
    EXPECT_LT(mesh.face_count(), 2000u);
    EXPECT_GE(smallest_angle(mesh), 20.0); // half of the 45 degrees of the triangles of the quad, at worst
    EXPECT_LT(fine.tested(), 30000u);
}

TEST(TessellateWhere, EdgesThatAreShortEnoughStay) {
    const Mesh solid = cube();
    std::size_t tested = 0;
    const auto always = [&](std::span<const PointBetween> points) {
        tested += points.size();
        return std::vector<bool>(points.size(), true);
    };
    const Mesh mesh = tessellate(solid, always, {.shortest = 0.3});
    EXPECT_TRUE(closedness(mesh).closed());
    for (const Face& face : faces_of(mesh))
        for (std::size_t i = 0; i < face.size(); ++i)
            EXPECT_LE(glm::distance(mesh.positions[face[i]], mesh.positions[face[(i + 1) % face.size()]]), 0.3);
    EXPECT_GT(tested, 0u);
    EXPECT_EQ(tessellate(solid, always, {.shortest = 1.5}).face_count(), 6u);
}

TEST(TessellateWhere, TheLimitOnFacesEndsItAndSaysSo) {
    const auto always = [](std::span<const PointBetween> points) { return std::vector<bool>(points.size(), true); };
    for (const std::size_t most : {5u, 6u, 11u, 12u, 40u, 1000u}) {
        const Mesh mesh = tessellate(cube(), always, {.most_faces = most});
        EXPECT_LE(mesh.face_count(), std::max<std::size_t>(most, 6));
        EXPECT_GE(mesh.face_count(), std::min<std::size_t>(most, most < 40 ? 6 : most / 2));
        EXPECT_TRUE(closedness(mesh).closed());
        ASSERT_EQ(mesh.warnings.size(), 1u);
        EXPECT_NE(mesh.warnings[0].find("faces"), std::string::npos);
    }
}

TEST(TessellateWhere, NormalsAreThoseOfTheFacesOrInterpolated) {
    Mesh solid = cube();
    const auto check = [&](std::span<const PointBetween> points) {
        for (const PointBetween& point : points) {
            EXPECT_NEAR(glm::length(point.normal), 1.0, 1e-6);
            // The normal is the mean of the normals of the cube faces that contain the point.
            const Vec3d q = glm::abs(2.0 * point.position - 1.0);
            const Vec3d way = glm::sign(2.0 * point.position - 1.0) * Vec3d(q.x == 1, q.y == 1, q.z == 1);
            EXPECT_LE(glm::distance(Vec3d(point.normal), glm::normalize(way)), 1e-6);
            EXPECT_LT(point.face, 6u);
        }
        return std::vector<bool>(points.size(), false);
    };
    tessellate(solid, check, {.spacing = 0.2});
    solid.normals.assign(8, Vec3(0, 0, 1));
    const auto same = [&](std::span<const PointBetween> points) {
        for (const PointBetween& point : points)
            EXPECT_EQ(point.normal, Vec3(0, 0, 1));
        return std::vector<bool>(points.size(), points.size() == 30);
    };
    tessellate(solid, same, {});
}

TEST(TessellateWhere, ThreeFacesAtAnEdgeStayJoined) {
    Mesh fan;
    fan.positions = {{0, 0, 0}, {0, 0, 2}, {1, 0, 0.5}, {-1, 1, 0.5}, {-1, -1, 1.5}, {NAN, 0, 0}};
    for (const Face& face : {Face{0, 1, 2}, Face{0, 1, 3}, Face{1, 0, 4}, Face{0, 5, 1}})
        fan.add_face(face);
    const auto dark = spot({0, 0, 1}, 0.5);
    Differs differs(fan, dark, 0.05);
    const Mesh mesh = tessellate(fan, std::ref(differs), {});
    const Diagnosis found = diagnose(mesh);
    EXPECT_EQ(found.coincident_vertices, 0u);
    std::size_t on_axis = 0;
    for (const Vec3d& p : mesh.positions)
        on_axis += p.x == 0 && p.y == 0;
    EXPECT_GT(on_axis, 5u);
    EXPECT_EQ(found.non_manifold_edges, on_axis - 1);
}

TEST(TessellateWhere, AnswersOfAnotherCountAreRefused) {
    const auto none = [](std::span<const PointBetween>) { return std::vector<bool>(); };
    EXPECT_THROW(tessellate(cube(), none, {}), std::invalid_argument);
}

}
}
