#include "alcove/vdb/detail/archive.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>

namespace alcove {
namespace {

using openvdb::DoubleGrid;
using openvdb::FloatGrid;
namespace io = openvdb::io;

class GridReader : public io::Archive {
  public:
    /// Returns the grids for which `wanted`, by position in the file, is true. Also reads the grids whose trees they
    /// share.
    std::vector<openvdb::GridBase::Ptr> read(std::istream& stream, const VdbStructure& structure,
                                             const std::vector<bool>& wanted) {
        readHeader(stream);
        auto state = std::make_shared<io::StreamMetadata>();
        io::setStreamMetadataPtr(stream, state, /*transfer=*/false);
        setFormatVersion(stream);
        setLibraryVersion(stream);
        openvdb::MetaMap().readMeta(stream);
        readGridCount(stream);
        std::set<std::string> parents;
        for (std::size_t i = 0; i < wanted.size(); ++i)
            if (wanted[i])
                parents.insert(structure.grids[i].parent);
        std::vector<openvdb::GridBase::Ptr> grids;
        NamedGridMap named;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const GridEntry& entry = structure.grids[i];
            if (structure.has_offsets && !wanted[i] && !parents.contains(entry.unique_name)) {
                stream.seekg(entry.end);
                continue;
            }
            io::GridDescriptor descriptor;
            const openvdb::GridBase::Ptr grid = descriptor.read(stream);
            readGrid(grid, descriptor, stream);
            named[descriptor.uniqueName()] = grid;
            connectInstance(descriptor, named);
            if (wanted[i])
                grids.push_back(grid);
        }
        return grids;
    }
};

std::vector<openvdb::GridBase::Ptr> read_bases(const std::filesystem::path& file, const VdbStructure& structure,
                                               const std::vector<bool>& wanted) {
    std::ifstream stream(file, std::ios::binary);
    try {
        openvdb::initialize();
        // Without exceptions, a damaged count would keep OpenVDB in a loop after the end of the file.
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        return GridReader().read(stream, structure, wanted);
    } catch (const std::ios_base::failure&) {
        refuse(file, "ends early: the file is truncated or damaged; write it again");
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        // OpenVDB's message may contain arbitrary bytes of the file: keep a readable beginning.
        std::string reason = error.what();
        reason.resize(std::min<std::size_t>(reason.size(), 100));
        std::replace_if(
            reason.begin(), reason.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
        refuse(file, fmt::format("is not a readable .vdb file ({}): write it again", reason));
    }
}

/// Refuses a grid whose root has far more tiles than the inside of any level set needs: OpenVDB's running time is
/// quadratic in their number.
void check_root(FloatGrid& grid, const std::filesystem::path& file) {
    constexpr openvdb::Index most = 1000;
    auto& root = grid.tree().root();
    if (root.getTableSize() > most)
        root.eraseBackgroundTiles();
    openvdb::Index tiles = 0;
    for (auto tile = root.cbeginValueAll(); tile; ++tile)
        ++tiles;
    if (tiles > most)
        refuse(file,
               fmt::format("grid '{}' has {} tiles of 4096³ voxels with one value, but few of them can be inside: "
                           "write a narrow-band level set, as OpenVDB's levelSetRebuild does",
                           grid.getName(), tiles));
}

/// Refuses values that are not finite, and a number of active voxels that differs from the metadata.
void check_values(const FloatGrid& grid, const std::filesystem::path& file) {
    const auto expected = grid.getMetadata<openvdb::Int64Metadata>("file_voxel_count");
    if (expected && static_cast<openvdb::Index64>(expected->value()) != grid.activeVoxelCount())
        refuse(file, fmt::format("grid '{}' has {} active voxels but declares {}: the file is damaged", grid.getName(),
                                 grid.activeVoxelCount(), expected->value()));
    std::vector<const openvdb::FloatTree::LeafNodeType*> leaves;
    grid.tree().getNodes(leaves);
    std::atomic<std::size_t> bad{std::isfinite(grid.background()) ? 0u : 1u};
    auto tile = grid.tree().cbeginValueAll();
    for (tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1); tile; ++tile)
        bad += std::isfinite(*tile) ? 0u : 1u;
    parallel_for(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t l = begin; l < end; ++l) {
            const float* const values = leaves[l]->buffer().data();
            bad += static_cast<std::size_t>(
                std::count_if(values, values + leaves[l]->SIZE, [](float value) { return !std::isfinite(value); }));
        }
    });
    if (bad > 0)
        refuse(file, fmt::format("grid '{}' has {} values that are not finite numbers: the file is damaged",
                                 grid.getName(), bad.load()));
}

}

void refuse(const std::filesystem::path& file, const std::string& what) {
    throw InputError(fmt::format("{}: {}", file.string(), in_one_line(what)));
}

std::vector<VdbGrid> read_trees(const std::filesystem::path& file, const VdbStructure& structure,
                                const std::vector<bool>& wanted) {
    std::vector<VdbGrid> grids;
    std::set<const openvdb::TreeBase*> trees;
    for (const openvdb::GridBase::Ptr& base : read_bases(file, structure, wanted)) {
        FloatGrid::Ptr grid = openvdb::gridPtrCast<FloatGrid>(base);
        if (!grid)
            grid = std::make_shared<FloatGrid>(*openvdb::gridConstPtrCast<DoubleGrid>(base));
        else if (!trees.insert(&base->constBaseTree()).second)
            grid = grid->deepCopy();
        check_root(*grid, file);
        check_values(*grid, file);
        grids.push_back({grid});
    }
    return grids;
}

}
