#include "bake_verb.h"
#include "inputs.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/mesh/files.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove::cli {
namespace {

/// Refuses options that apply only to values at vertices.
void check_at_vertices(const BakeVerb& verb, const std::string& output, std::string_view instead) {
    const auto refuse = [&](bool given, std::string_view option) {
        if (given)
            throw UsageError(fmt::format("{} is for values at vertices, but {}: {}", option, instead, output));
    };
    refuse(!verb.tessellate.empty(), "--tessellate");
    refuse(verb.bake.self, "--self");
    refuse(verb.bake.weld.has_value(), "--weld");
    refuse(verb.add.color != ColorUse::automatic, "--color");
    refuse(!verb.write_grid.empty(), "--write-grid");
}

void check_map_usage(const BakeVerb& verb, const std::string& output) {
    check_at_vertices(verb, output, "the output is a texture map");
    if (!verb.bake.faces.empty() && !verb.map.high.empty())
        throw UsageError(
            "--only, --exclude, --no-occlude and --opaque-only choose parts of the input, but --high bakes "
            "other meshes: leave out one of them");
    as_usage([&] {
        MapOptions map = verb.map.map;
        map.high.resize(verb.map.high.size()); // the files are read later
        if (!verb.map.cage.empty())
            map.cage.emplace();
        check(map);
        check(verb.map.files, output);
        if (!verb.map.miss_mask.empty())
            check_miss_mask(verb.map, output);
    });
    const AtomicFile probe(output); // fails early
}

/// Checks the options of occlusion textures.
void check_texture_usage(const BakeVerb& verb, const std::string& output) {
    if (!is_gltf(output))
        throw UsageError(fmt::format("--into texture is for .glb and .gltf: {} is neither", output));
    if (verb.map.given_beyond_size() || !(verb.bake.attributes == Channel::ao))
        throw UsageError("--into texture writes only ao: it accepts --size, --subsamples and --margin, but no other "
                         "options for maps and no other --attributes");
    check_at_vertices(verb, output, "an occlusion texture is written");
    as_usage([&] { check(verb.map.map); });
    can_write_mesh(output); // fails early
}

}

bool is_gltf(const std::string& output) {
    return extension(output) == ".glb" || extension(output) == ".gltf";
}

void check_options(const BakeVerb& verb) {
    const bool meshed = std::any_of(verb.inputs.begin(), verb.inputs.end(), is_grid);
    if (meshed && !verb.grid.empty())
        throw UsageError("--grid is for meshes: a .vdb input is a grid already");
    if (!meshed && verb.grid.empty() && !verb.grid_names.empty())
        throw UsageError("--grid-name is for grids: " + verb.inputs.front() + " is a mesh");
    if (!meshed && verb.adaptivity > 0.0f)
        throw UsageError("--adaptivity is for grids: " + verb.inputs.front() + " is a mesh already");
    if (meshed && !verb.tessellate.empty())
        throw UsageError("--tessellate is for meshes: a .vdb input is meshed with faces of one voxel");
    if (meshed && verb.bake.weld)
        throw UsageError("--weld is for meshes: a .vdb input has no vertices");
    if (verb.inputs.size() > 1 && (!verb.grid.empty() || !verb.write_grid.empty()))
        throw UsageError("--grid and --write-grid take one input: bake the inputs one at a time");
    if (!verb.write_grid.empty())
        check_grid_output(verb.write_grid);
    if (verb.strict && !verb.bake.method.empty() && !verb.bake.error)
        throw UsageError("--strict needs an --error for the --method to meet");
    if ((verb.add.color == ColorUse::ao || verb.add.color == ColorUse::multiply) &&
        !verb.bake.attributes.has(Channel::ao))
        throw UsageError("--color ao and --color multiply need ao among the --attributes");
    BakeOptions options = verb.bake;
    const GridStack any;
    if (meshed || !verb.grid.empty())
        options.grid = &any;
    if (!verb.map.map.surface.empty()) // then no other attribute is needed
        options.attributes = options.attributes | Channel::ao;
    as_usage([&] { check(options); });
}

void check_output(const BakeVerb& verb, const std::string& output) {
    if (verb.map.pack_orm && !verb.map.into_texture)
        throw UsageError("--pack-orm packs occlusion textures: give --into texture, too");
    if (verb.map.into_texture)
        return check_texture_usage(verb, output);
    if (is_map(output))
        return check_map_usage(verb, output);
    if (verb.map.sized && is_gltf(output))
        throw UsageError("--size, --subsamples and --margin are for textures: add --into texture, or write a .png or "
                         ".exr");
    if (verb.map.given())
        throw UsageError(
            "--size, --subsamples, --margin, --depth, --space, --flip-green, --uv-set, --high, --reach, --cage, "
            "--miss-mask, --pack, and the attributes of a high mesh are for texture maps: write a .png or .exr");
    const ChannelSet others = verb.bake.attributes.without(Channel::ao);
    if (extension(output) == ".obj" && !others.empty())
        throw UsageError(output + ": an .obj can store only ao, as colours: write a .ply for " + names_of(others));
    if (extension(output) == ".obj" && verb.add.color == ColorUse::none)
        throw UsageError(output + ": an .obj can store ao only as colours: leave out --color none, or write a .ply");
    if (!can_write_mesh(output))
        throw UsageError(output +
                         ": meshes are written as .ply, .obj, .glb or .gltf, texture maps as .png or .exr: use one of "
                         "these extensions");
}

}
