#include "alcove/field/detail/bricks.h"
#include "alcove/grid/voxelize.h"

#include "alcove/field/level_stack.h"
#include "exact_distance.h"
#include "real_mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace alcove {
namespace {

struct Errors {
    double mean = 0.0, largest = 0.0;
    double wrong_sign = 0.0;    ///< share of the samples
    double deepest_wrong = 0.0; ///< voxels
    std::size_t samples = 0;
};

/// Compares the values at random voxel centres in the band of a level with exact ones, in voxels of the level.
Errors errors_at_centres(const Bricks& level, Sign sign, const test::ExactSurface& exact, int samples) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit;
    std::vector<double> errors;
    Errors result;
    std::size_t wrong = 0;
    const float outer = level.usable() / level.voxel();
    while (errors.size() < static_cast<std::size_t>(samples)) {
        const Vec3 on = exact.point(random() % exact.size(), unit(random), unit(random));
        const Vec3 away = 2.0f * Vec3(unit(random), unit(random), unit(random)) - 1.0f;
        const Vec3 centre =
            level.origin() + level.voxel() * glm::round((on - level.origin()) / level.voxel() + outer * away);
        const double voxels = exact.distance(centre) / level.voxel();
        const bool inside = exact.winding_number(centre) > 0.5;
        if (voxels > (inside ? sign == Sign::solid ? 1.9 : 0.5 : outer))
            continue;
        const double value = level.map(centre) / level.voxel();
        errors.push_back(std::fabs(std::fabs(value) - voxels));
        result.mean += errors.back();
        if ((value < 0.0) != inside) {
            ++wrong;
            result.deepest_wrong = std::max(result.deepest_wrong, voxels);
        }
    }
    result.mean /= static_cast<double>(errors.size());
    result.largest = *std::max_element(errors.begin(), errors.end());
    result.wrong_sign = static_cast<double>(wrong) / static_cast<double>(errors.size());
    result.samples = errors.size();
    return result;
}

void expect_exact_distances(const LevelStack& field, Sign sign, const test::RealMesh& real) {
    const test::ExactSurface exact(real.mesh, real.triangles, real.frame);
    // Computing a winding number visits all triangles, so large meshes get fewer samples.
    const int samples = static_cast<int>(std::min<std::size_t>(1000, 10'000'000 / real.triangles.size()));
    for (const Bricks& level : field.levels()) {
        const Errors e = errors_at_centres(level, sign, exact, samples);
        SCOPED_TRACE(fmt::format("1/{:.0f}: mean {:.6f} max {:.6f} wrong {:.2f} % up to {:.2f}", 1 / level.voxel(),
                                 e.mean, e.largest, 100 * e.wrong_sign, e.deepest_wrong));
        EXPECT_LE(e.mean, 1e-4);
        EXPECT_LE(e.largest, 1e-3);
        EXPECT_LE(e.wrong_sign, 0.01);
        if (sign == Sign::solid) {
            EXPECT_LE(e.deepest_wrong, 0.5);
        }
    }
}

GridStack voxelize_at_128(const test::RealMesh& real) {
    VoxelizeOptions options;
    options.grid.voxel = 1.0f / 128.0f;
    options.grid.radius = 0.2f;
    return voxelize(real.mesh, real.triangles, options);
}

class SolidMesh : public testing::TestWithParam<const char*> {};

TEST_P(SolidMesh, ValuesAtVoxelCentresAreSignedDistances) {
    const test::RealMesh real(GetParam());
    const GridStack stack = voxelize_at_128(real);
    ASSERT_EQ(stack.sign, Sign::solid);
    expect_exact_distances(LevelStack(stack), stack.sign, real);
}

INSTANTIATE_TEST_SUITE_P(Archive, SolidMesh,
                         testing::Values("armadillo.off", "elephant.off", "fandisk.off", "knot1.off", "rotor.off",
                                         "cube.off", "sphere.off", "anchor.off", "pinion.off", "bull.off",
                                         "eight.off"));

/// Closed meshes with overlapping parts: the inside of any part is inside.
INSTANTIATE_TEST_SUITE_P(Overlapping, SolidMesh,
                         testing::Values("cow.off", "camel.off", "elk.off", "bones.off", "diplodocus.off", "man.off"));

/// Distances of a sheet are just as exact; the sign of its inside is checked up to half a voxel from a face.
TEST(SheetMesh, DistancesAreExact) {
    const test::RealMesh real("ChineseDragon-10kv.off");
    expect_exact_distances(LevelStack(voxelize_at_128(real)), Sign::sheet, real);
}

}
}
