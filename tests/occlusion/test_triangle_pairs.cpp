#include "alcove/occlusion/detail/triangle_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace alcove {
namespace {

Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
}

std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
    for (Triangle& t : triangles)
        t = sorted(t);
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

std::vector<Triangle> halves(const std::vector<TrianglePair>& pairs) {
    std::vector<Triangle> triangles;
    for (const TrianglePair& p : pairs) {
        triangles.push_back({p[0], p[1], p[3]});
        if (p[2] != p[3])
            triangles.push_back({p[2], p[3], p[1]});
    }
    return triangles;
}

/// A strip of quads, with duplicate triangles and a third triangle on one edge.
TEST(TrianglePairs, HoldEveryTriangleOnce) {
    std::vector<Vec3> positions(40, Vec3(0.0f));
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 30; i += 2) {
        triangles.push_back({i, i + 1, i + 2});
        triangles.push_back({i + 3, i + 2, i + 1});
    }
    const std::size_t plain = triangles.size();
    EXPECT_EQ(pair_triangles(positions, triangles).size(), plain / 2);
    triangles.insert(triangles.end(), {{4, 5, 6}, {6, 5, 4}, {5, 6, 39}, {38, 37, 36}});
    EXPECT_EQ(sorted(halves(pair_triangles(positions, triangles))), sorted(triangles));
}

TEST(TrianglePairs, LeaveOutWhatNoRayMeets) {
    std::vector<Vec3> positions(5, Vec3(0.0f));
    positions[4].y = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Triangle> triangles{{0, 1, 1}, {1, 2, 4}, {0, 1, 2}, {2, 1, 2}, {3, 2, 1}};
    EXPECT_EQ(sorted(halves(pair_triangles(positions, triangles))), sorted({{0, 1, 2}, {3, 2, 1}}));
}

}
}
