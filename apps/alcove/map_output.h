/// Texture maps as output of `bake`: the options, and the printed summary.
#pragma once

#include "options.h"

#include "alcove/maps/maps.h"

namespace alcove::cli {

struct MapRequest {
    MapOptions map;
    MapFileOptions files;
    std::vector<std::string> high{};
    std::string cage{}, miss_mask{};
    bool into_texture = false; ///< bake occlusion textures into a glTF file instead of a map
    bool pack_orm = false;     ///< pack ao into the metallic-roughness textures of that file
    bool has_size = false;     ///< whether --size was used
    bool sized = false;        ///< whether --size, --subsamples or --margin was used

    bool given() const;             ///< whether any option for maps was used
    bool given_beyond_size() const; ///< whether an option other than --size, --subsamples or --margin was used
    TexturePacking packing() const;
};

/// Whether the name of an output ends in .png or .exr.
bool is_map(const std::string& output);

/// Adds --into, --pack-orm, --size, --subsamples, --margin, --depth, --space, --flip-green, --uv-set, --high, --reach,
/// --cage, --miss-mask and --pack.
void add_map_options(CLI::App& verb, MapRequest& request);

/// Checks the file of the miss mask. \throw InputError if the file is not a .png, if it could replace a map, if <UDIM>
/// is in the name of only one of mask and output, or if there is no high mesh; what AtomicFile throws if the file
/// cannot be written.
void check_miss_mask(const MapRequest& request, const std::string& output);

/// The names of the attributes: "ao, normal".
std::string attributes_of(const BakedMaps& maps);

/// What was baked: "ao of 306,123 texels of 2048 x 2048".
std::string summary_of(const BakedMaps& maps);

/// Parses names of attributes such as "ao,normal". \throw InputError for an unknown name, or if there is none.
EnumSet<MapAttribute> parse_attributes(const std::string& text);

}
