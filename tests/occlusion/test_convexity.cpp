/// The convexity of Classic on planes, edges and corners, and against dihedral angles of scans.
#include "alcove/occlusion/methods/reference/classic.h"

#include "alcove/field/primitives.h"
#include "alcove/mesh/files.h"
#include "alcove/occlusion/estimator.h"
#include "shapes.h"
#include "voxelized.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

namespace alcove {
namespace {

template <class F>
std::vector<float> convexity(const std::vector<Surfel>& surfels, const F& field, float radius) {
    return evaluate(surfels, field, Classic{.radius = radius}, Channel::convexity)[Channel::convexity];
}

/// A flat box of 1 x 1 x 0.4 around the origin, for radii up to 0.2.
const test::Voxelized& voxelized_box() {
    static const test::Voxelized box(test::box_mesh({0.5, 0.5, 0.2}, 1), 0.2f, 1.0f / 128);
    return box;
}

/// Surfels on the top of the box, from the middle to an edge, in mesh units.
std::vector<Surfel> toward_the_edge() {
    std::vector<Surfel> surfels;
    for (int i = 0; i <= 98; ++i)
        surfels.push_back({{0.005f * static_cast<float>(i), 0.03f, 0.2f}, {0, 0, 1}});
    return surfels;
}

std::vector<Surfel> to_unit(std::vector<Surfel> surfels, const Frame& frame) {
    for (Surfel& s : surfels)
        s.position = frame.to_unit(Vec3d(s.position));
    return surfels;
}

TEST(Convexity, OfAPlaneIsAHalf) {
    for (const Vec3 n : {Vec3(0, 1, 0), glm::normalize(Vec3(1, 2, 3)), glm::normalize(Vec3(-3, 1, -1))}) {
        const std::vector<Surfel> surfels(3, Surfel{{0, 0, 0}, n});
        for (const float value : convexity(surfels, Plane{n, 0.0f}, 0.3f))
            EXPECT_NEAR(value, 0.5f, 1e-5f);
    }
    const test::Voxelized& box = voxelized_box();
    std::vector<Surfel> middle;
    for (int x = -10; x <= 10; ++x)
        for (int y = -10; y <= 10; ++y)
            middle.push_back({{0.0213f * static_cast<float>(x), 0.0207f * static_cast<float>(y), 0.2f}, {0, 0, 1}});
    for (const float value : convexity(to_unit(middle, box.frame), box.field, 0.1f))
        EXPECT_NEAR(value, 0.5f, 0.001f);
}

TEST(Convexity, RisesTowardAnEdge) {
    const Cuboid exact{{0, 0, 0}, {0.5f, 0.5f, 0.2f}};
    const test::Voxelized& box = voxelized_box();
    const std::vector<float> ideal = convexity(toward_the_edge(), exact, 0.13f),
                             found = convexity(to_unit(toward_the_edge(), box.frame), box.field,
                                               0.13f / static_cast<float>(box.frame.diagonal));
    for (std::size_t i = 1; i < ideal.size(); ++i) {
        EXPECT_GE(ideal[i], ideal[i - 1] - 1e-6f);
        EXPECT_GE(found[i], found[i - 1] - 2e-3f) << i;
    }
    EXPECT_NEAR(ideal.front(), 0.5f, 1e-5f);
    EXPECT_GT(ideal.back(), 0.85f);
    EXPECT_GT(found.back(), 0.85f);
}

TEST(Convexity, FallsTowardAnInnerCorner) {
    const Union corner(Plane{}, Plane{{1, 0, 0}, 0.0f});
    std::vector<Surfel> surfels;
    for (int i = 1; i <= 40; ++i)
        surfels.push_back({{0.005f * static_cast<float>(i), 0, 0}, {0, 1, 0}});
    const std::vector<float> values = convexity(surfels, corner, 0.13f);
    for (std::size_t i = 1; i < values.size(); ++i)
        EXPECT_GE(values[i], values[i - 1] - 1e-6f);
    EXPECT_LT(values.front(), 0.1f);
    EXPECT_NEAR(values.back(), 0.5f, 1e-5f);
}

/// The mean dihedral angle of the edges at each vertex, weighted by edge length; positive for convex edges. NaN at
/// borders.
std::vector<double> mean_dihedrals(const test::Voxelized& scan) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3d> sides; // directed edge -> normal of its triangle
    const auto at = [&](std::uint32_t v) { return scan.mesh.positions[v]; };
    for (const auto& [a, b, c] : scan.triangles) {
        const Vec3d n = glm::normalize(glm::cross(at(b) - at(a), at(c) - at(a)));
        sides[{a, b}] = sides[{b, c}] = sides[{c, a}] = n;
    }
    std::vector<double> angles(scan.mesh.positions.size()), lengths(angles.size());
    for (const auto& [edge, n] : sides) {
        const auto [a, b] = edge;
        const auto other = sides.find({b, a});
        if (other == sides.end()) {
            angles[a] = angles[b] = std::nan("");
            continue;
        }
        const Vec3d along = at(b) - at(a);
        const double length = glm::length(along);
        const double angle =
            std::atan2(glm::dot(glm::cross(n, other->second), along) / length, glm::dot(n, other->second));
        for (const std::uint32_t v : {a, b}) {
            angles[v] += length * angle;
            lengths[v] += length;
        }
    }
    for (std::size_t v = 0; v < angles.size(); ++v)
        angles[v] /= lengths[v];
    return angles;
}

class ConvexityOfScans : public testing::TestWithParam<const char*> {};

TEST_P(ConvexityOfScans, AgreesWithTheMeanDihedral) {
    const float radius = 0.02f;
    const test::Voxelized scan(read_mesh(std::string(ALCOVE_REAL_MESHES) + "/" + GetParam()), radius, radius / 4);
    const std::vector<double> angles = mean_dihedrals(scan);
    // Strongly curved: the tenth of the vertices with the largest angles.
    std::vector<double> sorted;
    for (std::size_t v = 0; v < angles.size(); ++v)
        if (std::isfinite(angles[v]) && scan.surfels[v].has_normal())
            sorted.push_back(std::fabs(angles[v]));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 9 / 10),
                     sorted.end());
    const double strong = sorted[sorted.size() * 9 / 10];
    const std::vector<float> values = convexity(scan.surfels, scan.field, radius);
    int count = 0, agree = 0, edges = 0, wrong_edges = 0;
    for (std::size_t v = 0; v < angles.size(); ++v)
        if (std::fabs(angles[v]) >= strong && scan.surfels[v].has_normal()) {
            const bool same = (angles[v] > 0.0) == (values[v] > 0.5f);
            ++count;
            agree += same;
            edges += angles[v] > 0.0;
            wrong_edges += angles[v] > 0.0 && !same;
        }
    fmt::print("{}: {} vertices above {:.1f} degrees, {} of them convex; {:.2f} % agree ({} convex, {} "
               "concave do not)\n",
               GetParam(), count, strong * 57.29578, edges, 100.0 * agree / count, wrong_edges,
               count - agree - wrong_edges);
    EXPECT_GT(count - edges, count / 100) << "some must be concave";
    EXPECT_GE(agree, 0.95 * count);
}

INSTANTIATE_TEST_SUITE_P(Scans, ConvexityOfScans,
                         testing::Values("armadillo.off", "elephant.off", "bear.off", "bunny00.off",
                                         "refined_elephant.off"),
                         [](const auto& scan) {
                             const std::string name = scan.param;
                             return name.substr(0, name.find_first_of("-."));
                         });

}
}
