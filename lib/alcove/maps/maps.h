/// Bakes ambient occlusion and masks into texture maps.
///
///     const auto mesh = alcove::read_mesh("dragon.obj");
///     const auto maps = alcove::bake_maps(mesh, {.quality = alcove::Quality::draft}, {.width = 2048, .height = 2048});
///     alcove::write_maps(maps, "dragon_ao.png");
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/mesh/mesh.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace alcove {

/// The axes of directions in a map.
enum class MapSpace {
    tangent, ///< those of the texel: along u, along v, along the normal, as MikkTSpace defines them
    object,  ///< those of the mesh
};

struct MapOptions {
    int width = 2048, height = 2048; ///< texels, in [1, 16384]
    bool udim = false;               ///< bake all UDIM tiles with faces, not only the unit square
    int subsamples = 1;              ///< along each axis of a texel, in [1, 8]: the values of a texel are their mean
    /// How many texels around islands are filled, >= 0; empty: 1/128 of the larger side. At least the size of the map:
    /// everything.
    std::optional<int> margin{};
    MapSpace space = MapSpace::tangent;
    bool flip_green = false; ///< negate the second coordinate of directions, as DirectX expects
};

/// The values of one attribute, row by row from the top, where v is 1.
struct MapLayer {
    Channel channel;
    std::vector<float> values; ///< as ChannelValues, one entry per texel; lengths in scene units
};

enum class Coverage : std::uint8_t {
    background, ///< ChannelInfo::missing
    face,       ///< baked
    margin,     ///< the value of the nearest baked texel
};

struct MapTile {
    int udim = 1001; ///< 1001 + u + 10 v of its lower left corner
    std::vector<MapLayer> layers;
    std::vector<Coverage> coverage;
};

struct BakedMaps {
    int width = 0, height = 0;
    std::vector<MapTile> tiles; ///< by number
    std::size_t texels = 0;     ///< baked
    std::size_t overlaps = 0;   ///< baked texels with several faces, of which the first was used
    double thickest = 0.0;      ///< min(radius, diagonal), which images show as 1; scene units
    Baked baked;                ///< method, error, grids, times and warnings; its values are empty
};

/// Bakes the texels of all faces with UVs. A texel is covered by the first face that contains its centre, else by the
/// first that touches it. Normals are those of corners or vertices in the file, interpolated; without them, means over
/// faces within 40 degrees, so that edges are hard. NormalSource::angle and area smooth everything.
///
/// Cost: per texel as bake() of points; texels are many, so most are interpolated. Thread-safety as bake().
/// \throw as bake(), and InputError if the mesh has no UVs, no face covers a texel, or an option is out of range.
/// LimitError if the maps do not fit in memory.
BakedMaps bake_maps(const Mesh& mesh, const BakeOptions& bake = {}, const MapOptions& options = {});

enum class MapDepth { automatic, eight, sixteen, half, single };

/// What a channel of a packed PNG holds: an attribute with one component, or a number.
struct PackedChannel {
    std::optional<Channel> attribute{};
    float number = 0.0f; ///< in [0, 1], without an attribute
};

struct MapFileOptions {
    MapDepth depth = MapDepth::automatic; ///< 8 bits in a .png, half in an .exr
    std::vector<PackedChannel> pack{};    ///< one to four: write one .png with these channels
};

/// Checks options without a mesh. \throw InputError if an option is out of range, for another extension than .png and
/// .exr, a depth that the format lacks, or channels that cannot be packed.
void check(const MapOptions& options);
void check(const MapFileOptions& options, const std::filesystem::path& file);

/// Writes a .png per attribute, or one .exr with a layer per attribute. ao goes to `file`, other attributes go to
/// `name_<attribute>.png`; if the first attribute is not ao, it goes to `file`. `<UDIM>` in the name becomes the number
/// of the tile. PNGs hold ao and convexity unchanged, thickness as a share of BakedMaps::thickest, and vectors as 0.5 +
/// 0.5 v, all without an sRGB tag. Each file is written completely or not at all.
/// \return the files. \throw as check(); IoError if a file cannot be written.
std::vector<std::filesystem::path> write_maps(const BakedMaps& maps, const std::filesystem::path& file,
                                              const MapFileOptions& options = {});

}
