#include "alcove/vdb/vdb_file.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/mesh/mesh.h"
#include "alcove/vdb/detail/checksum.h"
#include "alcove/vdb/detail/outliers.h"
#include "alcove/vdb/detail/structure.h"

#include <fmt/format.h>
#include <openvdb/io/File.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

namespace alcove {
namespace {

using openvdb::FloatGrid;
namespace io = openvdb::io;

constexpr const char* creator = "Alcove";
constexpr const char* checksum_name = "alcove:checksum";

std::string level_name(std::size_t level) {
    return level == 0 ? "surface" : fmt::format("surface_{}", level + 1);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw InputError(fmt::format("{}: {}", file.string(), in_one_line(what)));
}

/// Reads the float grids of a file and skips grids of other types.
class FloatGridReader : public io::Archive {
  public:
    std::vector<FloatGrid::Ptr> read(std::istream& stream) {
        readHeader(stream);
        auto state = std::make_shared<io::StreamMetadata>();
        io::setStreamMetadataPtr(stream, state, /*transfer=*/false);
        setFormatVersion(stream);
        setLibraryVersion(stream);
        openvdb::MetaMap().readMeta(stream);
        std::vector<FloatGrid::Ptr> grids;
        NamedGridMap named;
        for (std::int32_t left = readGridCount(stream); left > 0; --left) {
            io::GridDescriptor descriptor;
            const auto grid = openvdb::gridPtrCast<FloatGrid>(descriptor.read(stream));
            if (grid) {
                readGrid(grid, descriptor, stream);
                named[descriptor.uniqueName()] = grid;
                connectInstance(descriptor, named);
                grids.push_back(grid);
            } else {
                descriptor.seekToEnd(stream);
            }
        }
        return grids;
    }
};

/// Reads all float grids of a file. The stream's state reveals a truncated file, which OpenVDB does not report.
std::vector<FloatGrid::Ptr> read_all(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        refuse(file, fmt::format("cannot be opened: {}; check the name", std::strerror(errno)));
    if (std::filesystem::is_directory(file))
        refuse(file, "is a folder; name a .vdb file in it");
    check_vdb_structure(file);
    try {
        openvdb::initialize();
        // Without exceptions, OpenVDB would loop over a damaged count past the end of the file.
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        return FloatGridReader().read(stream);
    } catch (const std::ios_base::failure&) {
        refuse(file, "ends early: the file is truncated or damaged, write it again");
    } catch (const std::exception& error) {
        // OpenVDB's message may contain arbitrary bytes of the file: keep a readable prefix.
        std::string reason = error.what();
        reason.resize(std::min<std::size_t>(reason.size(), 100));
        std::replace_if(
            reason.begin(), reason.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
        refuse(file, fmt::format("is not a readable .vdb file ({}): write it again", reason));
    }
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

/// The width of the inner band in voxels: down to the value that fills the inside, or that of the outer band if nothing
/// is filled.
float inner_band_of(const FloatGrid& grid, double voxel, float outer_band) {
    float deepest = 0.0f;
    for (auto value = grid.cbeginValueOff(); value; ++value)
        deepest = std::min(deepest, *value);
    return deepest < 0.0f ? static_cast<float>(-deepest / voxel) : outer_band;
}

LevelSet level_of(const FloatGrid::Ptr& grid, const GridStack& stack, const std::filesystem::path& file) {
    const Frame& frame = stack.frame;
    const auto& transform = grid->transform();
    const auto map = transform.baseMap()->getAffineMap()->getMat4();
    const double size = map(0, 0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (std::fabs(map(row, column) - (row == column ? size : 0.0)) > 1e-6 * std::fabs(size) || !(size > 0.0))
                refuse(file, fmt::format("grid '{}' has voxels that are not axis-aligned cubes: resample it to a "
                                         "uniform, unrotated transform",
                                         grid->getName()));
    const double band = double(grid->background()) / size;
    if (!(band > 0.0 && band < double(std::numeric_limits<float>::max())))
        refuse(file,
               fmt::format("grid '{}' has a background of {:g}, which is not a distance outside its band: the file "
                           "is damaged, write it again",
                           grid->getName(), grid->background()));
    LevelSet level;
    level.voxel = static_cast<float>(size / frame.diagonal);
    const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0.0));
    level.origin = frame.to_unit({origin.x(), origin.y(), origin.z()});
    level.outer_band = static_cast<float>(band);
    level.inner_band = inner_band_of(*grid, size, level.outer_band);
    level.active_voxels = grid->activeVoxelCount();
    level.bytes = grid->memUsage();
    scale_values(*grid, 1.0 / stack.value_unit);
    level.grid = std::make_shared<VdbGrid>(VdbGrid{grid});
    return level;
}

double number(const FloatGrid& grid, const char* name) {
    const auto meta = grid.getMetadata<openvdb::DoubleMetadata>(name);
    return meta ? meta->value() : std::nan("");
}

/// Whether alcove wrote the grid, including versions that wrote no checksums.
bool is_ours(const FloatGrid& grid) {
    return grid[checksum_name] || (grid.getCreator() == creator && number(grid, "alcove:diagonal") > 0.0);
}

void verify(const FloatGrid::Ptr& grid, const std::filesystem::path& file) {
    const auto written = grid->getMetadata<openvdb::Int64Metadata>(checksum_name);
    if ((*grid)[checksum_name] && (!written || written->value() != checksum_of({grid})))
        refuse(file,
               fmt::format("grid '{}' does not match its checksum: the file is damaged or was changed after alcove "
                           "wrote it; write it again, or remove the metadata {} if the change is intended",
                           grid->getName(), checksum_name));
}

/// Warns of values that are not distances; refuses the file if one is larger than the grid is wide.
void check_outliers(const FloatGrid::Ptr& grid, const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const Outliers outliers = outliers_of({grid}, grid->voxelSize().x());
    if (outliers.far > 0)
        refuse(file,
               fmt::format("grid '{}' has {} values that are larger than the grid is wide, so they are not distances: "
                           "the file is damaged, write it again",
                           grid->getName(), outliers.far));
    if (outliers.count > 0)
        warnings.push_back(fmt::format("grid '{}' has {} of {} active voxels whose values are not distances, "
                                       "as they differ too much from their neighbours: "
                                       "the program that wrote them is wrong, or the file is damaged",
                                       in_one_line(grid->getName()), outliers.count, grid->activeVoxelCount()));
}

GridStack our_stack(const std::vector<FloatGrid::Ptr>& grids, const std::filesystem::path& file) {
    GridStack stack;
    const FloatGrid& finest = *grids.front();
    stack.creator = creator;
    stack.frame.center = {number(finest, "alcove:center_x"), number(finest, "alcove:center_y"),
                          number(finest, "alcove:center_z")};
    stack.frame.diagonal = number(finest, "alcove:diagonal");
    if (!is_finite(stack.frame.center) || !std::isfinite(stack.frame.diagonal))
        refuse(file, "lacks part of its alcove metadata: write it again");
    stack.value_unit = value_unit_of(stack.frame);
    if (const double levels = number(finest, "alcove:levels");
        levels > 0.0 && levels != static_cast<double>(grids.size()))
        refuse(file,
               fmt::format("contains {} of the {} levels that alcove wrote: write it again", grids.size(), levels));
    if (std::any_of(grids.begin(), grids.end(), [](const auto& grid) { return !(*grid)[checksum_name]; }))
        stack.warnings.push_back("the grids have no checksums: an earlier version wrote them, or the file is damaged");
    const auto sign = finest.getMetadata<openvdb::StringMetadata>("alcove:sign");
    stack.sign = sign && sign->value() == "sheet" ? Sign::sheet : Sign::solid;
    for (const FloatGrid::Ptr& grid : grids) {
        // The values of a sheet jump where its negative layer ends.
        if (!(*grid)[checksum_name] && stack.sign == Sign::solid)
            check_outliers(grid, file, stack.warnings);
        LevelSet level = level_of(grid, stack, file);
        const double voxel = number(*grid, "alcove:voxel");
        if (!(std::fabs(voxel - double(level.voxel)) <= 1e-5 * voxel))
            refuse(file,
                   fmt::format("grid '{}' was scaled after alcove wrote it: voxelize the mesh again", grid->getName()));
        level.voxel = static_cast<float>(voxel);
        level.outer_band = static_cast<float>(number(*grid, "alcove:outer_band"));
        level.inner_band = static_cast<float>(number(*grid, "alcove:inner_band"));
        if (!(level.outer_band >= 3.0f && level.inner_band > 0.0f))
            refuse(file, fmt::format("grid '{}' lacks its alcove metadata: write it again", grid->getName()));
        stack.levels.push_back(std::move(level));
    }
    return stack;
}

bool has_inside(const FloatGrid& grid) {
    for (auto value = grid.cbeginValueAll(); value; ++value)
        if (*value < 0.0f)
            return true;
    return false;
}

/// Converts distances in another unit, such as voxels, to scene units.
void scale_to_scene(const FloatGrid::Ptr& grid, std::vector<std::string>& warnings) {
    const double slope = slope_of({grid}, grid->voxelSize().x());
    constexpr double tolerance = 1.3; // smoothing changes the slope by less
    if (!(slope > 0.0) || (slope < tolerance && slope > 1.0 / tolerance))
        return;
    scale_values(*grid, 1.0 / slope);
    warnings.push_back(fmt::format("grid '{}' has values that change by {:.3g} per unit of length: they are treated as "
                                   "distances in another unit and divided by that factor",
                                   in_one_line(grid->getName()), slope));
}

/// Refuses a grid whose active voxels do not have the bounding box in its metadata.
void check_bounding_box(const FloatGrid& grid, const openvdb::CoordBBox& voxels, const std::filesystem::path& file) {
    const auto low = grid.getMetadata<openvdb::Vec3IMetadata>("file_bbox_min"),
               high = grid.getMetadata<openvdb::Vec3IMetadata>("file_bbox_max");
    if (low && high && (voxels.min().asVec3i() != low->value() || voxels.max().asVec3i() != high->value()))
        refuse(file, fmt::format("grid '{}' does not have the bounding box that it declares: the file is damaged",
                                 grid.getName()));
}

GridStack foreign_stack(const std::vector<FloatGrid::Ptr>& grids, const std::filesystem::path& file) {
    auto chosen = std::find_if(grids.begin(), grids.end(),
                               [](const auto& g) { return g->getGridClass() == openvdb::GRID_LEVEL_SET; });
    if (chosen == grids.end())
        chosen = std::find_if(grids.begin(), grids.end(), [](const auto& g) { return g->background() > 0.0f; });
    if (chosen == grids.end() || !((*chosen)->background() > 0.0f) || (*chosen)->activeVoxelCount() == 0)
        refuse(file, "contains no float level set: alcove needs signed distances, positive outside");
    if (!has_inside(**chosen))
        refuse(file, fmt::format("grid '{}' has no negative distance: alcove needs signed distances, negative "
                                 "inside, and finds the surface where they change sign",
                                 (*chosen)->getName()));
    // Programs that set voxels one by one leave the inside beyond the band at the outside value.
    openvdb::tools::signedFloodFill((*chosen)->tree());
    (*chosen)->setGridClass(openvdb::GRID_LEVEL_SET);
    std::vector<std::string> warnings;
    scale_to_scene(*chosen, warnings);
    check_outliers(*chosen, file, warnings);
    const openvdb::CoordBBox voxels = (*chosen)->evalActiveVoxelBoundingBox();
    check_bounding_box(**chosen, voxels, file);
    const openvdb::BBoxd scene = (*chosen)->transform().indexToWorld(voxels);
    Box box;
    box.add({scene.min().x(), scene.min().y(), scene.min().z()});
    box.add({scene.max().x(), scene.max().y(), scene.max().z()});
    GridStack stack;
    stack.creator = (*chosen)->getCreator();
    try {
        stack.frame = frame_of(box);
    } catch (const InputError& error) {
        refuse(file, error.what());
    }
    stack.value_unit = value_unit_of(stack.frame);
    if (!(glm::length(stack.frame.center) < 1e12 * (*chosen)->voxelSize().x()))
        refuse(file, fmt::format("grid '{}' is so far from the origin that its voxels coincide: move it nearer",
                                 (*chosen)->getName()));
    stack.levels.push_back(level_of(*chosen, stack, file));
    stack.warnings = std::move(warnings);
    return stack;
}

}

void scale_values(FloatGrid& grid, double factor) {
    if (factor == 1.0)
        return;
    const auto scale = static_cast<float>(factor);
    grid.tree().root().setBackground(grid.background() * scale, /*updateChildNodes=*/false);
    for (auto value = grid.beginValueAll(); value; ++value)
        value.setValue(*value * scale);
}

void write_grids(const GridStack& stack, const std::filesystem::path& file) {
    // OpenVDB accepts no smaller transform, and floats cannot represent larger distances.
    if (const double voxel = stack.levels.front().voxel * stack.frame.diagonal; voxel < 1e-10 || voxel > 1e30)
        throw IoError(fmt::format("{}: voxels in a .vdb file must be from 1e-10 to 1e30 scene units, these are {:.3g}: "
                                  "scale the scene",
                                  file.string(), voxel));
    openvdb::GridCPtrVec grids;
    for (std::size_t i = 0; i < stack.levels.size(); ++i) {
        const LevelSet& level = stack.levels[i];
        const auto grid = level.grid->grid->deepCopy();
        scale_values(*grid, stack.value_unit);
        const auto transform =
            openvdb::math::Transform::createLinearTransform(double(level.voxel) * stack.frame.diagonal);
        const Vec3d origin = stack.frame.to_scene(level.origin);
        transform->postTranslate({origin.x, origin.y, origin.z});
        grid->setTransform(transform);
        grid->setName(level_name(i));
        grid->setCreator(creator);
        grid->setGridClass(openvdb::GRID_LEVEL_SET);
        const auto put = [&](const char* name, double value) {
            grid->insertMeta(name, openvdb::DoubleMetadata(value));
        };
        put("alcove:center_x", stack.frame.center.x);
        put("alcove:center_y", stack.frame.center.y);
        put("alcove:center_z", stack.frame.center.z);
        put("alcove:diagonal", stack.frame.diagonal);
        put("alcove:levels", static_cast<double>(stack.levels.size()));
        put("alcove:voxel", level.voxel);
        put("alcove:outer_band", level.outer_band);
        put("alcove:inner_band", level.inner_band);
        grid->insertMeta("alcove:sign", openvdb::StringMetadata(stack.sign == Sign::sheet ? "sheet" : "solid"));
        grid->insertMeta(checksum_name, openvdb::Int64Metadata(checksum_of({grid})));
        grids.push_back(grid);
    }
    AtomicFile out(file);
    try {
        io::File archive(out.temporary().string());
        archive.setCompression(io::COMPRESS_BLOSC | io::COMPRESS_ACTIVE_MASK);
        archive.write(grids);
        archive.close();
        // OpenVDB does not notice a full disk: read the new file before it replaces the old one.
        for (const FloatGrid::Ptr& grid : read_all(out.temporary()))
            verify(grid, out.temporary());
    } catch (const std::exception& error) {
        throw IoError(
            fmt::format("{}: cannot be written completely, is the disk full? ({})", file.string(), error.what()));
    }
    out.commit();
}

GridStack read_grids(const std::filesystem::path& file) {
    std::vector<FloatGrid::Ptr> grids = read_all(file);
    for (const FloatGrid::Ptr& grid : grids)
        check_values(*grid, file);
    if (grids.empty())
        refuse(file, "contains no float grid: alcove needs a level set");
    std::vector<FloatGrid::Ptr> ours;
    std::copy_if(grids.begin(), grids.end(), std::back_inserter(ours), [](const auto& g) { return is_ours(*g); });
    std::sort(ours.begin(), ours.end(),
              [](const auto& a, const auto& b) { return number(*a, "alcove:voxel") < number(*b, "alcove:voxel"); });
    try {
        for (const FloatGrid::Ptr& grid : ours)
            verify(grid, file);
        return ours.empty() ? foreign_stack(grids, file) : our_stack(ours, file);
    } catch (const openvdb::Exception&) {
        refuse(file, "contains a transform that cannot be inverted: write it again");
    }
}

}
