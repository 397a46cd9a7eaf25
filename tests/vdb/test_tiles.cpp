/// Small files that describe large grids by tiles: blocks of 8³ voxels and more with one value.
#include "grid_file.h"

#include "alcove/grid/voxelize.h"

#include <cmath>
#include <ctime>

namespace alcove {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using test::GridFile;

class Tiles : public GridFile {
  protected:
    static FloatGrid::Ptr level_set() {
        const auto grid = FloatGrid::create(3.0f);
        grid->setGridClass(openvdb::GRID_LEVEL_SET);
        return grid;
    }
    /// The message of read_grids(), which must take at most two seconds of CPU time.
    std::string quick_refusal(const FloatGrid::Ptr& grid) const {
        write_foreign(grid, "tiles.vdb", 0);
        const std::clock_t begin = std::clock();
        const std::string said = refusal("tiles.vdb");
        EXPECT_LT(std::clock() - begin, 2 * CLOCKS_PER_SEC);
        return said;
    }
};

TEST_F(Tiles, ASurfaceBetweenTilesIsRefused) {
    for (const openvdb::Index level : {1u, 2u, 3u}) {
        const auto grid = level_set();
        grid->tree().addTile(level, Coord(0), -3.0f, true);
        EXPECT_NE(quick_refusal(grid).find("has 1 active tile (a block of one value)"), std::string::npos) << level;
    }
    const auto checkered = level_set();
    for (int x = 0; x < 32; ++x)
        for (int y = 0; y < 32; ++y)
            for (int z = 0; z < 32; ++z)
                checkered->tree().addTile(2, Coord(128 * x, 128 * y, 128 * z), (x + y + z) % 2 ? -3.0f : 3.0f, true);
    EXPECT_NE(quick_refusal(checkered).find("active tiles"), std::string::npos);
}

TEST_F(Tiles, ManyTilesAtTheRootAreReadQuickly) {
    const auto tiles = level_set(), around = level_set();
    around->setTree(ball("ball", 10.0f, {0, 0, 0}, 1.0f)->treePtr());
    for (int i = 0; i < 20'000; ++i) {
        const Coord at(4096 * (i % 100 - 50), 4096 * (i / 100), 4096);
        tiles->tree().addTile(3, at, -3.0f, true);
        around->tree().addTile(3, at, 3.0f, false);
    }
    EXPECT_NE(quick_refusal(tiles).find("20000 tiles of 4096³ voxels"), std::string::npos);
    EXPECT_EQ(quick_refusal(around), "read");
    EXPECT_NEAR(mesh_zero_surface(read_grids(path("tiles.vdb"))).box().max.x, 10.0, 0.1);
}

/// Some programs activate the inside, which changes nothing.
TEST_F(Tiles, AnActiveInsideIsNoSurface) {
    const auto grid = ball("ball", 100.0f, {0, 0, 0}, 1.0f);
    write_foreign(grid, "plain.vdb", 0);
    for (auto value = grid->beginValueAll(); value; ++value)
        if (*value < 0.0f)
            value.setActiveState(true);
    EXPECT_EQ(quick_refusal(grid), "read");
    const GridStack stack = read_grids(path("tiles.vdb"));
    EXPECT_TRUE(stack.warnings.empty()) << stack.warnings.front();
    EXPECT_EQ(mesh_zero_surface(stack).positions, mesh_zero_surface(read_grids(path("plain.vdb"))).positions);
}

TEST_F(Tiles, TilesWithinTheBandAreSaid) {
    const auto grid = ball("ball", 20.0f, {0, 0, 0}, 1.0f);
    grid->tree().addTile(1, Coord(64, 0, 0), 1.0f, true);
    write_foreign(grid, "tiles.vdb", 0);
    const GridStack stack = read_grids(path("tiles.vdb"));
    ASSERT_EQ(stack.warnings.size(), 1u);
    EXPECT_NE(stack.warnings.front().find("512 active voxels in tiles"), std::string::npos) << stack.warnings.front();
}

TEST_F(Tiles, ABackgroundThatIsNoNumberIsRefused) {
    const auto grid = ball("ball", 10.0f, {0, 0, 0}, 1.0f);
    grid->tree().root().setBackground(NAN, false);
    EXPECT_NE(quick_refusal(grid).find("not finite"), std::string::npos);
}

}
}
