#include "alcove/vdb/vdb_file.h"

#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "scratch_folder.h"
#include "shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

namespace alcove {
namespace {

namespace io = openvdb::io;
using openvdb::FloatGrid;
using Leaf = openvdb::FloatTree::LeafNodeType;

struct Compression {
    const char* name;
    std::uint32_t flags;
};
constexpr Compression compressions[] = {
    {"none", 0},
    {"none, active", io::COMPRESS_ACTIVE_MASK},
    {"zip", io::COMPRESS_ZIP},
    {"zip, active", io::COMPRESS_ZIP | io::COMPRESS_ACTIVE_MASK},
    {"blosc", io::COMPRESS_BLOSC},
    {"blosc, active", io::COMPRESS_BLOSC | io::COMPRESS_ACTIVE_MASK},
};

bool same_values(const FloatGrid& a, const FloatGrid& b) {
    if (a.background() != b.background() || !a.tree().hasSameTopology(b.tree()))
        return false;
    auto x = a.tree().cbeginLeaf(), y = b.tree().cbeginLeaf();
    for (; x && y; ++x, ++y)
        if (std::memcmp(x->buffer().data(), y->buffer().data(), Leaf::SIZE * sizeof(float)) != 0)
            return false;
    auto v = a.cbeginValueAll(), w = b.cbeginValueAll();
    v.setMaxDepth(2);
    w.setMaxDepth(2);
    for (; v && w; ++v, ++w)
        if (*v != *w)
            return false;
    return !v && !w;
}

bool same_stack(const GridStack& a, const GridStack& b) {
    return a.frame.center == b.frame.center && a.frame.diagonal == b.frame.diagonal && a.sign == b.sign &&
           std::equal(a.levels.begin(), a.levels.end(), b.levels.begin(), b.levels.end(),
                      [](const LevelSet& p, const LevelSet& q) {
                          return p.voxel == q.voxel && p.origin == q.origin && p.outer_band == q.outer_band &&
                                 p.inner_band == q.inner_band && p.active_voxels == q.active_voxels &&
                                 same_values(*p.grid->grid, *q.grid->grid);
                      });
}

/// The largest difference of values and of positions, in voxels of the first stack.
double distance_between(const GridStack& a, const GridStack& b) {
    const LevelSet &p = a.levels.front(), &q = b.levels.front();
    const double voxel = p.voxel * a.frame.diagonal;
    const Vec3d low = a.frame.to_scene(p.origin), other_low = b.frame.to_scene(q.origin);
    double difference = glm::length(low - other_low) / voxel;
    // The difference of voxel sizes adds up toward the far end of the grid.
    difference = std::max(difference, std::fabs(q.voxel * b.frame.diagonal / voxel - 1.0) * 64.0);
    for (const auto& [from, to] : {std::pair(&p, &q), std::pair(&q, &p)}) {
        const double from_unit = from == &p ? a.value_unit : b.value_unit,
                     to_unit = from == &p ? b.value_unit : a.value_unit;
        const auto reader = to->grid->grid->getConstAccessor();
        for (auto value = from->grid->grid->cbeginValueAll(); value; ++value)
            difference = std::max(difference,
                                  std::fabs(*value * from_unit - reader.getValue(value.getCoord()) * to_unit) / voxel);
    }
    return difference;
}

struct Outcomes {
    int refused = 0, warned = 0, correct = 0, near = 0, moved = 0, wrong = 0;
    double farthest = 0.0; ///< largest difference counted as near, voxels

    std::string text() const {
        return fmt::format("{:3} refused, {:3} with a warning, {:3} correct, {:3} near (up to {:.2f} "
                           "voxels), {} moved, {} wrong",
                           refused, warned, correct, near, farthest, moved, wrong);
    }
};

class DamagedGrids : public testing::TestWithParam<Compression> {
  protected:
    DamagedGrids() { openvdb::initialize(); }

    std::filesystem::path whole() const { return folder_ / "whole.vdb"; }
    std::filesystem::path damaged() const { return folder_ / "damaged.vdb"; }

    void write(const openvdb::GridPtrVec& grids) const {
        io::File file(whole().string());
        file.setCompression(GetParam().flags);
        file.write(grids);
    }

    /// Reads a damaged file and counts the outcome. Taking more than five seconds ends the program.
    void try_to_read(const std::string& bytes, const GridStack& expected, double bound, bool in_translation,
                     Outcomes& outcomes) const {
        std::ofstream(damaged(), std::ios::binary) << bytes;
        alarm(5);
        try {
            const GridStack stack = read_grids(damaged());
            if (same_stack(stack, expected)) {
                ++outcomes.correct;
            } else if (!stack.warnings.empty()) {
                ++outcomes.warned;
            } else if (const double difference = distance_between(expected, stack); difference <= bound) {
                ++outcomes.near;
                outcomes.farthest = std::max(outcomes.farthest, difference);
            } else {
                ++(in_translation ? outcomes.moved : outcomes.wrong);
            }
        } catch (const InputError&) {
            ++outcomes.refused;
        }
        alarm(0);
    }

    /// Flips 300 bits anywhere and 150 in the header, and truncates the file 75 times. Flips in the translation, if
    /// given, are counted separately.
    void damage(const char* whose, const GridStack& expected, double bound, const openvdb::Vec3d* translation) {
        const std::string bytes = bytes_of(whole());
        std::string translation_bytes;
        if (translation)
            translation_bytes.assign(reinterpret_cast<const char*>(translation), sizeof *translation);
        const std::size_t translation_begin = bytes.find(translation_bytes);
        ASSERT_NE(translation_begin, std::string::npos);
        constexpr unsigned seed = 20240501;
        std::mt19937 random(seed);
        const auto flip = [&](int count, std::size_t within) {
            Outcomes outcomes;
            for (int i = 0; i < count; ++i) {
                std::string flipped = bytes;
                const auto bit = std::uniform_int_distribution<std::size_t>(0, 8 * within - 1)(random);
                flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
                try_to_read(flipped, expected, bound, bit / 8 - translation_begin < translation_bytes.size(), outcomes);
            }
            return outcomes;
        };
        const Outcomes anywhere = flip(300, bytes.size()), header = flip(150, 2000);
        Outcomes cuts;
        for (int i = 0; i < 75; ++i)
            try_to_read(bytes.substr(0, std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random)),
                        expected, 0.0, false, cuts);
        fmt::print("{}, {}: {} bytes, seed {}\n  bits  {}\n  first {}\n  cuts  {}\n", whose, GetParam().name,
                   bytes.size(), seed, anywhere.text(), header.text(), cuts.text());
        EXPECT_EQ(anywhere.wrong, 0);
        EXPECT_EQ(header.wrong, 0);
        EXPECT_EQ(cuts.refused, 75);
    }

  private:
    ScratchFolder folder_;
};

TEST_P(DamagedGrids, OfOursAreRefusedOrRight) {
    VoxelizeOptions options;
    options.grid.voxel = 1.0f / 40.0f;
    options.grid.radius = 0.2f;
    Mesh mesh;
    test::add_part(mesh, test::sphere_mesh(4), 1.0, Vec3d(5, 6, 7));
    const GridStack stack = voxelize(mesh, triangulate(mesh).triangles, options);
    write_grids(stack, whole());
    // Rewrite it with another compression, as another program might.
    io::File file(whole().string());
    file.open(/*delayLoad=*/false);
    const openvdb::GridPtrVec grids = *file.getGrids();
    file.close();
    write(grids);
    ASSERT_TRUE(same_stack(read_grids(whole()), stack));
    damage("ours", stack, 0.0, nullptr);
}

/// Errors that are too small to show against the neighbours cannot be detected, nor can a wrong translation.
TEST_P(DamagedGrids, OfOtherProgramsAreRefusedWarnedOfOrNear) {
    const auto sphere = openvdb::tools::createLevelSetSphere<FloatGrid>(1.0f, {2, 2, 2}, 0.1f);
    const openvdb::Vec3d translation(5, 6, 7);
    sphere->transform().postTranslate(translation);
    if ((GetParam().flags & io::COMPRESS_ZIP) != 0)
        sphere->setGridClass(openvdb::GRID_UNKNOWN); // level sets are not zipped
    write({sphere});
    const GridStack stack = read_grids(whole());
    ASSERT_TRUE(stack.warnings.empty());
    damage("foreign", stack, 1.15, &translation);
}

INSTANTIATE_TEST_SUITE_P(Compressions, DamagedGrids, testing::ValuesIn(compressions));

}
}
