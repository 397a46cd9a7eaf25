/// A folder of .vdb files that OpenVDB writes.
#pragma once

#include "alcove/vdb/vdb_file.h"

#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"

#include "scratch_folder.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <filesystem>
#include <string>

namespace alcove::test {

class GridFile : public testing::Test {
  protected:
    GridFile() { openvdb::initialize(); }

    std::filesystem::path path(const std::string& name) const { return folder_ / name; }

    void write_foreign(const openvdb::GridBase::Ptr& grid, const std::string& name, std::uint32_t compression) const {
        openvdb::io::File file(path(name).string());
        file.setCompression(compression);
        file.write(openvdb::GridPtrVec{grid});
    }
    /// \return the path.
    std::filesystem::path write_grids_of(const openvdb::GridPtrVec& grids) const {
        openvdb::io::File(path("grids.vdb").string()).write(grids);
        return path("grids.vdb");
    }

    std::string refusal(const std::string& name, const GridSelection& selection = {}) const {
        try {
            read_grids(path(name), selection);
        } catch (const InputError& error) {
            return error.what();
        } catch (const LimitError& error) {
            return std::string("limit: ") + error.what();
        }
        return "read";
    }

    static openvdb::FloatGrid::Ptr ball(const std::string& name, float radius, const openvdb::Vec3f& center,
                                        float voxel = 0.1f, float band = 3.0f) {
        const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, center, voxel, band);
        grid->setName(name);
        return grid;
    }

  private:
    ScratchFolder folder_;
};

}
