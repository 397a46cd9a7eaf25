#include "alcove/grid/detail/band.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace alcove {
namespace {

/// A tall stack of small plates: nodes of the tree are thousands of voxels tall and less than one wide.
TEST(Band, TallThinNodesLoseNothing) {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    constexpr int apart = 32; // a multiple of brick_size, so that all plates have equal bricks
    for (std::uint32_t k = 0; k < 4096; ++k) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const Vec3d& corner : {Vec3d(0.25, 0, 0), Vec3d(-0.15, 0.2, 0), Vec3d(-0.15, -0.2, 0)})
            positions.push_back(Vec3d(20.3, 17.7, 10.37 + apart * k) + corner);
        triangles.push_back({first, first + 1, first + 2});
    }
    const FragmentLeaves fragments(positions, triangles);
    const TriangleTree tree(fragments);
    const Pseudonormals normals(positions, triangles);
    const Band band(tree, normals, 5.0f);
    std::array<float, brick_volume> unknown;
    unknown.fill(std::numeric_limits<float>::infinity());
    std::map<std::array<int, 3>, BandBrick> first_of;
    float worst = 0.0f;
    std::size_t compared = 0;
    for (const BandBlock& block : band.blocks(1)) {
        const BandBrick brick = band.brick(block, 1, unknown);
        if (brick.count == 0)
            continue;
        const BandBrick& like =
            first_of.try_emplace({block.low.x, block.low.y, block.low.z % apart}, brick).first->second;
        for (int v = 0; v < brick_volume; ++v)
            worst = std::max(worst, std::fabs(std::fabs(brick.values[v]) - std::fabs(like.values[v])));
        ++compared;
    }
    EXPECT_GT(compared, 4096u);
    EXPECT_LT(worst, 1e-3f);
}

}
}
