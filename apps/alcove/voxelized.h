/// The first half of every verb on meshes: read, triangulate, voxelize.
#pragma once

#include "common.h"

#include "alcove/base/length.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"

#include <optional>

namespace alcove::cli {

/// What a user may say of the grid.
struct GridRequest {
    std::string radius = "10%", voxel = "auto", sign = "auto";
    float band = GridOptions{}.outer_band;
    bool inside = false;  ///< the band is as wide behind the surface
    bool cluster = false; ///< as GridOptions has it
};

void add_radius_option(CLI::App& verb, GridRequest& request, const std::string& description);

/// Adds --voxel and --sign.
void add_grid_options(CLI::App& verb, GridRequest& request);

/// What --voxel says; nothing for `auto`. \throw UsageError unless it is a length or `auto`.
std::optional<Length> parse_voxel(const std::string& text);

/// What --sign says. \throw UsageError unless it is `auto`, `signed` or `unsigned`.
SignChoice parse_sign(const std::string& text);

struct VoxelizedMesh {
    std::string file;
    Mesh mesh;
    std::vector<Triangle> triangles;
    Frame frame;
    float radius = 0.0f;     ///< unit space
    VoxelizeOptions options; ///< what the request comes to, unit space
    GridStack stack;
    std::vector<std::string> warnings; ///< of reading and voxelizing
};

/// What a bake says of its grids; no levels where it needed none.
struct GridFacts {
    double voxel = 0.0; ///< finest, scene units
    std::size_t levels = 0, bytes = 0;
    Sign sign = Sign::solid;
    bool clustered = false;

    /// The larger of each; a sheet where any is, clustered where any is.
    void include(const GridFacts& other);
    /// For people.
    std::string text() const;
};
GridFacts facts_of(const GridStack& stack);

/// All but the stack. Puts `read` into `seconds`. \throw UsageError, and what read_mesh() throws.
VoxelizedMesh read_to_voxelize(const std::string& input, const GridRequest& request,
                               nlohmann::ordered_json& seconds);

/// Makes the stack; what there is to say of it goes to the warnings. \throw what voxelize() throws, naming the
/// file.
void make_stack(VoxelizedMesh& input, const CommonOptions& common);

/// Puts `read` and `grid` into `seconds`. \throw UsageError, and what read_mesh() and voxelize() throw.
VoxelizedMesh read_and_voxelize(const std::string& input, const GridRequest& request,
                                const CommonOptions& common, nlohmann::ordered_json& seconds);

/// \throw UsageError unless the name ends in .vdb, IoError if nothing can be written there: before any work.
void check_grid_output(const std::string& file);

/// The name of a sign for people.
std::string_view name_of(Sign sign);

}
