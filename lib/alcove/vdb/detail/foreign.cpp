#include "alcove/vdb/detail/foreign.h"

#include "alcove/base/detail/messages.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/vdb/detail/archive.h"
#include "alcove/vdb/detail/join.h"
#include "alcove/vdb/detail/outliers.h"

#include <fmt/format.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

using openvdb::FloatGrid;

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

/// Refuses a grid if the bounding box of its active voxels differs from the one in its metadata.
void check_bounding_box(const FloatGrid& grid, const openvdb::CoordBBox& voxels, const std::filesystem::path& file) {
    const auto low = grid.getMetadata<openvdb::Vec3IMetadata>("file_bbox_min"),
               high = grid.getMetadata<openvdb::Vec3IMetadata>("file_bbox_max");
    if (low && high && (voxels.min().asVec3i() != low->value() || voxels.max().asVec3i() != high->value()))
        refuse(file, fmt::format("grid '{}' does not have the bounding box that it declares: the file is damaged",
                                 grid.getName()));
}

/// Limits the background, which some programs leave far beyond the band, to the largest value within the band. Both
/// values only mean that the distance is unknown.
void limit_background(FloatGrid& grid) {
    float largest = 0.0f;
    for (auto value = grid.cbeginValueOn(); value; ++value)
        largest = std::max(largest, *value);
    constexpr float beyond = 4.0f;
    if (largest > 0.0f && grid.background() > beyond * largest)
        openvdb::tools::changeBackground(grid.tree(), largest);
}

constexpr const char* rebuild = "write a narrow-band level set, as OpenVDB's levelSetRebuild does";

/// Refuses a grid whose surface lies between constant-valued blocks: such a surface could need far more voxels than the
/// file has bytes.
void check_tiles(const FloatGrid::Ptr& grid, const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const Tiles tiles = simplify_tiles({grid});
    if (tiles.at_surface > 0)
        refuse(file, fmt::format("grid '{}' has {} of one value), next to values of the other sign, so no voxels hold "
                                 "distances to its surface: {}",
                                 grid->getName(),
                                 counted(tiles.at_surface, "active tile (a block", "active tiles (blocks"), rebuild));
    if (tiles.voxels_within > 0)
        warnings.push_back(fmt::format("grid '{}' has {} active voxels in tiles (blocks of one value), which are not "
                                       "distances: they are treated as beyond the band",
                                       in_one_line(grid->getName()), grouped(tiles.voxels_within)));
}

}

float inner_band_of(const VdbGrid& grid) {
    float deepest = 0.0f;
    for (auto value = grid.grid->cbeginValueOff(); value; ++value)
        deepest = std::min(deepest, *value);
    return deepest < 0.0f ? -deepest : grid.grid->background();
}

Vec3d origin_of(const VdbGrid& grid) {
    const openvdb::Vec3d origin = grid.grid->transform().indexToWorld(openvdb::Vec3d(0.0));
    return {origin.x(), origin.y(), origin.z()};
}

Vec3d rounded_to_floats(const Vec3d& p) {
    Vec3d result;
    for (int axis = 0; axis < 3; ++axis) {
        const volatile auto rounded = static_cast<float>(p[axis]); // else GCC 12 vectorizes the conversion away
        result[axis] = static_cast<double>(rounded);
    }
    return result;
}

void check_outliers(const VdbGrid& level, const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const FloatGrid::Ptr grid = level.grid;
    const Outliers outliers = outliers_of(level, grid->voxelSize().x());
    if (outliers.far > 0)
        refuse(file,
               fmt::format("grid '{}' has {}: the file is damaged; write it again", grid->getName(),
                           counted(outliers.far, "value that is larger than the grid is wide, so it is not a distance",
                                   "values that are larger than the grid is wide, so they are not distances")));
    if (outliers.count > 0)
        warnings.push_back(fmt::format("in grid '{}', the values of {} of {} active voxels are not distances, "
                                       "because they differ too much from their neighbours: "
                                       "the program that wrote them is faulty, or the file is damaged",
                                       in_one_line(grid->getName()), outliers.count, grid->activeVoxelCount()));
}

std::string prepare(const VdbGrid& level, const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const FloatGrid::Ptr grid = level.grid;
    const auto name = [&] { return in_quotes(grid->getName()); };
    if (grid->activeVoxelCount() == 0)
        return fmt::format("grid {} is empty", name());
    if (!(grid->background() > 0.0f))
        return fmt::format("grid {} has a background of {:g}, but outside a level set distances are positive", name(),
                           grid->background());
    if (!has_inside(*grid))
        return fmt::format(
            "grid {} has no negative distance: alcove needs signed distances, negative inside, and finds "
            "the surface where they change sign",
            name());
    const openvdb::CoordBBox voxels = grid->evalActiveVoxelBoundingBox();
    check_bounding_box(*grid, voxels, file);
    constexpr int farthest = 1 << 30;
    const double voxel = grid->voxelSize().x();
    const Vec3d origin = origin_of(level);
    if (!(voxels.min() > openvdb::Coord(-farthest)) || !(voxels.max() < openvdb::Coord(farthest)) ||
        !(glm::length(origin) < 1e12 * voxel))
        refuse(file, fmt::format("grid '{}' is so far from the origin that its voxels coincide: move it nearer",
                                 grid->getName()));
    check_tiles(grid, file, warnings);
    limit_background(*grid);
    // Programs that set voxels one by one leave the inside, beyond the band, at the value of the outside.
    const float inside = std::min(inner_band_of(level), grid->background());
    openvdb::tools::signedFloodFillWithValues(grid->tree(), grid->background(), -inside);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    if (has_cubes(level)) {
        scale_to_scene(grid, warnings);
        check_outliers(level, file, warnings);
    }
    return {};
}

}
