#include "alcove/vdb/vdb_file.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/input_file.h"
#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/vdb/detail/archive.h"
#include "alcove/vdb/detail/checksum.h"
#include "alcove/vdb/detail/foreign.h"
#include "alcove/vdb/detail/join.h"
#include "alcove/vdb/detail/selection.h"
#include "alcove/vdb/detail/structure.h"

#include <fmt/format.h>
#include <openvdb/io/File.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace alcove {
namespace {

using openvdb::FloatGrid;
namespace io = openvdb::io;

constexpr const char* creator = "Alcove";
constexpr const char *checksum_name = "alcove:checksum", *lattice_name = "alcove:lattice",
                     *partial_name = "alcove:partial";

std::string level_name(std::size_t level) {
    return level == 0 ? "surface" : fmt::format("surface_{}", level + 1);
}

LevelSet level_of(const FloatGrid::Ptr& grid, const GridStack& stack, const std::filesystem::path& file) {
    const Frame& frame = stack.frame;
    const auto& transform = grid->transform();
    const double size = transform.voxelSize().x();
    const double band = double(grid->background()) / size;
    if (!(band > 0.0 && band < double(std::numeric_limits<float>::max())))
        refuse(file,
               fmt::format("grid '{}' has a background of {:g}, which is not a distance outside its band: the file "
                           "is damaged; write it again",
                           grid->getName(), grid->background()));
    LevelSet level;
    level.voxel = size / frame.diagonal;
    level.origin = exact_in_unit(frame, origin_of({grid}));
    level.outer_band = static_cast<float>(band);
    level.inner_band = static_cast<float>(double(inner_band_of({grid})) / size);
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

GridStack our_stack(std::vector<FloatGrid::Ptr> grids, const std::filesystem::path& file) {
    std::sort(grids.begin(), grids.end(),
              [](const auto& a, const auto& b) { return number(*a, "alcove:voxel") < number(*b, "alcove:voxel"); });
    GridStack stack;
    const FloatGrid& finest = *grids.front();
    stack.creator = creator;
    stack.frame.center = {number(finest, "alcove:center_x"), number(finest, "alcove:center_y"),
                          number(finest, "alcove:center_z")};
    stack.frame.diagonal = number(finest, "alcove:diagonal");
    if (!is_finite(stack.frame.center) || !std::isfinite(stack.frame.diagonal))
        refuse(file, "lacks part of its alcove metadata: write it again");
    stack.value_unit = value_unit_of(stack.frame);
    if (number(finest, lattice_name) > 0.0)
        stack.lattice = {finest.voxelSize().x(), origin_of({grids.front()})};
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
            check_outliers({grid}, file, stack.warnings);
        LevelSet level = level_of(grid, stack, file);
        const double voxel = number(*grid, "alcove:voxel");
        if (!(std::fabs(voxel - level.voxel) <= 1e-5 * voxel) || !is_aligned({grid}))
            refuse(file, fmt::format("grid '{}' was rotated or scaled after alcove wrote it: voxelize the mesh again",
                                     grid->getName()));
        level.voxel = voxel;
        if (!stack.lattice)
            level.origin = rounded_to_floats(level.origin); // restores the exact origin
        level.outer_band = static_cast<float>(number(*grid, "alcove:outer_band"));
        level.inner_band = static_cast<float>(number(*grid, "alcove:inner_band"));
        if (!(level.outer_band >= 3.0f && level.inner_band > 0.0f))
            refuse(file, fmt::format("grid '{}' lacks its alcove metadata: write it again", grid->getName()));
        (number(*grid, partial_name) > 0.0 ? stack.partial : stack.levels).push_back(std::move(level));
    }
    if (stack.levels.empty())
        refuse(file, "contains only partial levels: choose 'surface', too");
    return stack;
}

/// A stack of a single level, whose voxels are cubes along the axes.
GridStack one_level(const FloatGrid::Ptr& grid, const std::filesystem::path& file) {
    const openvdb::BBoxd scene = grid->transform().indexToWorld(grid->evalActiveVoxelBoundingBox());
    Box box;
    box.add({scene.min().x(), scene.min().y(), scene.min().z()});
    box.add({scene.max().x(), scene.max().y(), scene.max().z()});
    GridStack stack;
    stack.creator = grid->getCreator();
    try {
        stack.frame = frame_of(box);
    } catch (const InputError& error) {
        refuse(file, error.what());
    }
    stack.value_unit = value_unit_of(stack.frame);
    stack.levels.push_back(level_of(grid, stack, file));
    return stack;
}

/// The finest level of a stack, in scene units. Refuses a stack that is a sheet.
VdbGrid solid_of(const GridStack& stack, const std::filesystem::path& file) {
    const FloatGrid::Ptr finest = stack.levels.front().grid->grid;
    if (stack.sign == Sign::sheet)
        refuse(file, fmt::format("grid '{}' is a sheet, which cannot be united with other level sets: choose with "
                                 "--grid-name",
                                 finest->getName()));
    scale_values(*finest, stack.value_unit);
    return {finest};
}

/// The stack that `grids` make up, if they are one stack that Alcove wrote. Otherwise the union of all grids.
GridStack stack_of(const std::vector<VdbGrid>& grids, const std::filesystem::path& file, double memory_limit,
                   std::vector<std::string>& warnings) {
    std::map<std::string, std::vector<FloatGrid::Ptr>> stacks; // by frame, as text
    std::vector<VdbGrid> solids;
    std::vector<std::string> useless;
    for (const VdbGrid& grid : grids) {
        if (is_ours(*grid.grid)) {
            verify(grid.grid, file);
            std::string frame;
            for (const char* part : {"alcove:center_x", "alcove:center_y", "alcove:center_z", "alcove:diagonal"})
                frame += fmt::format("{} ", number(*grid.grid, part));
            stacks[frame].push_back(grid.grid);
        } else if (std::string why = prepare(grid, file, warnings); why.empty()) {
            solids.push_back(grid);
        } else {
            useless.push_back(std::move(why));
        }
    }
    if (solids.empty() && stacks.empty())
        refuse(file, useless.front());
    for (const std::string& why : useless)
        warnings.push_back(why + ": it is left out");
    if (solids.empty() && stacks.size() == 1)
        return our_stack(stacks.begin()->second, file);
    for (const auto& [frame, levels] : stacks)
        solids.push_back(solid_of(our_stack(levels, file), file));
    try {
        return one_level(join(solids, memory_limit, warnings).grid, file);
    } catch (const InputError& error) {
        const std::string what = error.what();
        throw InputError(what.starts_with(file.string()) ? what : file.string() + ": " + what);
    } catch (const LimitError& error) {
        throw LimitError(file.string() + ": " + error.what());
    }
}

/// The grids of a selection (at least one) and their names.
struct Chosen {
    std::vector<VdbGrid> grids;
    std::vector<std::string> names;
};

double limit_of(const GridSelection& selection) {
    return std::min(selection.memory_limit, memory_limit());
}

Chosen read_chosen(const std::filesystem::path& file, const GridSelection& selection,
                   std::vector<std::string>& warnings) {
    check_input_file(file);
    const VdbStructure structure = check_vdb_structure(file);
    const std::vector<bool> wanted = choose(structure, selection.names, file, warnings);
    Chosen chosen;
    double bytes = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
        if (wanted[i]) {
            bytes += static_cast<double>(structure.grids[i].bytes);
            chosen.names.push_back(structure.grids[i].grid.name);
        }
    if (const double limit = limit_of(selection); bytes > limit)
        throw LimitError(
            fmt::format("{}: its level sets need about {}, over the limit of {}: resample to larger voxels, "
                        "choose with --grid-name, or allow more with --max-memory",
                        file.string(), bytes_text(bytes), bytes_text(limit)));
    chosen.grids = read_trees(file, structure, wanted);
    return chosen;
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
    if (const double voxel = stack.scene_voxel(); voxel < 1e-10 || voxel > 1e30)
        throw IoError(fmt::format("{}: voxels in a .vdb file must be from 1e-10 to 1e30 scene units, these are {:.3g}: "
                                  "scale the scene",
                                  file.string(), voxel));
    openvdb::GridCPtrVec grids;
    const auto add = [&](const LevelSet& level, double scene_voxel, const std::string& name, bool is_partial) {
        const auto grid = level.grid->grid->deepCopy();
        scale_values(*grid, stack.value_unit);
        const auto transform = openvdb::math::Transform::createLinearTransform(scene_voxel);
        const Vec3d origin =
            stack.lattice ? stack.lattice->origin : level.origin * stack.frame.diagonal + stack.frame.center;
        transform->postTranslate({origin.x, origin.y, origin.z});
        grid->setTransform(transform);
        grid->setName(name);
        grid->setCreator(creator);
        grid->setGridClass(openvdb::GRID_LEVEL_SET);
        const auto put = [&](const char* key, double value) { grid->insertMeta(key, openvdb::DoubleMetadata(value)); };
        put("alcove:center_x", stack.frame.center.x);
        put("alcove:center_y", stack.frame.center.y);
        put("alcove:center_z", stack.frame.center.z);
        put("alcove:diagonal", stack.frame.diagonal);
        put("alcove:levels", static_cast<double>(stack.levels.size() + stack.partial.size()));
        put("alcove:voxel", level.voxel);
        put("alcove:outer_band", level.outer_band);
        put("alcove:inner_band", level.inner_band);
        if (stack.lattice)
            put(lattice_name, stack.scene_voxel());
        if (is_partial)
            put(partial_name, 1.0);
        grid->insertMeta("alcove:sign", openvdb::StringMetadata(stack.sign == Sign::sheet ? "sheet" : "solid"));
        grid->insertMeta(checksum_name, openvdb::Int64Metadata(checksum_of({grid})));
        grids.push_back(grid);
    };
    for (std::size_t i = 0; i < stack.levels.size(); ++i)
        add(stack.levels[i], stack.scene_voxel(i), level_name(i), false);
    for (std::size_t i = 0; i < stack.partial.size(); ++i)
        add(stack.partial[i], stack.partial[i].voxel * stack.frame.diagonal,
            fmt::format("surface_fine_{}", stack.partial.size() - i), true);
    AtomicFile out(file);
    try {
        io::File archive(out.temporary().string());
        archive.setCompression(io::COMPRESS_BLOSC | io::COMPRESS_ACTIVE_MASK);
        archive.write(grids);
        archive.close();
        // OpenVDB does not notice a full disk: read the new file before it replaces the old one.
        for (const VdbGrid& grid :
             read_trees(out.temporary(), check_vdb_structure(out.temporary()), std::vector<bool>(grids.size(), true)))
            verify(grid.grid, out.temporary());
    } catch (const std::exception& error) {
        throw IoError(
            fmt::format("{}: cannot be written completely; is the disk full? ({})", file.string(), error.what()));
    }
    out.commit();
}

std::vector<StoredGrid> list_grids(const std::filesystem::path& file) {
    check_input_file(file);
    std::vector<StoredGrid> grids;
    for (GridEntry& entry : check_vdb_structure(file).grids)
        grids.push_back(std::move(entry.grid));
    return grids;
}

GridStack read_grids(const std::filesystem::path& file, const GridSelection& selection) {
    std::vector<std::string> warnings;
    const Chosen chosen = read_chosen(file, selection, warnings);
    try {
        GridStack stack = stack_of(chosen.grids, file, limit_of(selection), warnings);
        stack.sources = chosen.names;
        stack.warnings.insert(stack.warnings.begin(), warnings.begin(), warnings.end());
        return stack;
    } catch (const openvdb::Exception&) {
        refuse(file, "contains a transform that cannot be inverted: write it again");
    }
}

Lattice read_lattice(const std::filesystem::path& file) {
    std::vector<std::string> warnings;
    const std::vector<VdbGrid> grids = read_chosen(file, {}, warnings).grids;
    const auto finest = std::min_element(grids.begin(), grids.end(), [](const VdbGrid& a, const VdbGrid& b) {
        return a.grid->voxelSize().x() < b.grid->voxelSize().x();
    });
    if (!is_aligned(*finest))
        refuse(file,
               fmt::format("grid '{}' has voxels that are not cubes along the axes, so no mesh can be voxelized on "
                           "them: name another grid, or a length",
                           finest->grid->getName()));
    return {finest->grid->voxelSize().x(), origin_of(*finest)};
}

}
