/// Compares tangent_frames() with the widely used implementation of MikkTSpace, and tests its properties.
#include "alcove/maps/detail/tangent_frames.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace alcove {
namespace {

using Corners = std::array<TangentCorner, 3>;

struct Expected {
    Vec3 tangent;
    float sign;
};

struct OracleMesh {
    std::vector<Corners> triangles;
    std::vector<Expected> corners;
};

/// The meshes of oracle/tangents.txt, see oracle/make_tangents.mjs.
std::vector<OracleMesh> oracle_meshes() {
    std::ifstream file(ALCOVE_TANGENTS);
    std::vector<OracleMesh> meshes(1);
    std::vector<TangentCorner> corners;
    for (std::string line; std::getline(file, line);) {
        if (line.empty()) {
            meshes.emplace_back();
            continue;
        }
        std::istringstream numbers(line);
        TangentCorner c;
        Expected e{};
        numbers >> c.position.x >> c.position.y >> c.position.z >> c.normal.x >> c.normal.y >> c.normal.z >> c.uv.x >>
            c.uv.y >> e.tangent.x >> e.tangent.y >> e.tangent.z >> e.sign;
        corners.push_back(c);
        meshes.back().corners.push_back(e);
        if (corners.size() == 3) {
            meshes.back().triangles.push_back({corners[0], corners[1], corners[2]});
            corners.clear();
        }
    }
    meshes.pop_back();
    return meshes;
}

TEST(TangentFrames, AreThoseOfMikkTSpace) {
    const std::vector<OracleMesh> meshes = oracle_meshes();
    ASSERT_EQ(meshes.size(), 3u);
    for (const OracleMesh& mesh : meshes) {
        const std::vector<TangentTriangle> frames = tangent_frames(mesh.triangles);
        std::size_t mirrored = 0;
        for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
            EXPECT_NEAR(glm::length(frames[i / 3].tangents[i % 3] - mesh.corners[i].tangent), 0.0f, 1e-3f) << i;
            EXPECT_EQ(frames[i / 3].sign, mesh.corners[i].sign) << i;
            mirrored += mesh.corners[i].sign < 0;
        }
        EXPECT_GT(mirrored, 0u);
    }
}

TEST(TangentFrames, FollowTheUvs) {
    Corners t;
    const std::array<Vec2, 3> at{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
    for (std::size_t k = 0; k < 3; ++k)
        t[k] = {Vec3d(at[k], 0.0), {0, 0, 1}, {0.5f - 0.3f * at[k].y, 0.3f * at[k].x}}; // u runs along −y
    const TangentTriangle frame = tangent_frames({&t, 1})[0];
    for (const Vec3& tangent : frame.tangents)
        EXPECT_NEAR(glm::length(tangent - Vec3(0, -1, 0)), 0.0f, 1e-6f);
    // v runs along x: sign · (z × −y) = x.
    EXPECT_EQ(frame.sign, 1.0f);
}

}
}
