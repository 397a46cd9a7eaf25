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
    tangent, ///< the axes of the texel: along u, along v, along the normal, as MikkTSpace defines them
    object,  ///< the axes of the mesh
};

/// What a map shows: a channel of a bake, in the order of `channels`, or a property of the surface of the high meshes.
enum class MapAttribute : std::uint8_t {
    ao,
    ao_short,
    ao_long,
    convexity,
    bent_normal,
    thickness,
    normal,   ///< unit length
    height,   ///< above the baked mesh along its normal, scene units
    position, ///< scene units
    object,   ///< number of the high mesh, counted from 1
};

struct MapAttributeInfo {
    std::string_view name;
    std::size_t components;
    float missing;     ///< value of the background
    bool is_direction; ///< converted to MapOptions::space
};

constexpr MapAttribute attribute_of(Channel channel) {
    return static_cast<MapAttribute>(channel);
}
MapAttributeInfo info(MapAttribute attribute);

/// The attribute called `name`. \throw InputError for an unknown name; the message lists all names.
MapAttribute map_attribute(std::string_view name);

EnumSet<MapAttribute> attributes_of(ChannelSet baked);
/// The attributes that are channels of a bake, without those of the surface of high meshes.
ChannelSet channels_of(EnumSet<MapAttribute> attributes);

struct MapOptions {
    int width = 2048, height = 2048; ///< texels, in [1, 16384]
    int uv_set = 0;                  ///< for a glTF file, the N of TEXCOORD_N
    bool udim = false;               ///< bake all UDIM tiles with faces, not only the unit square
    int subsamples = 1;              ///< samples along each axis of a texel, in [1, 8]; averaged
    /// The width of the margin around islands that is filled, in texels, >= 0; empty: 1/128 of the larger side. A
    /// margin of at least the size of the map fills everything.
    std::optional<int> margin{};
    MapSpace space = MapSpace::tangent;
    bool flip_green = false; ///< negate the second coordinate of directions, as DirectX expects

    /// Meshes whose surface is baked instead of the surface of the baked mesh. Each texel is projected onto the high
    /// meshes along the averaged normals of the baked mesh. The baked mesh itself then occludes nothing, and lengths
    /// relative to a diagonal refer to the high meshes.
    std::vector<Mesh> high{};
    /// How far to look for the high meshes, in front of and behind the mesh; a percentage refers to their diagonal.
    /// Empty: derived from the distance between the meshes.
    std::optional<Length> reach{};
    /// A copy of the baked mesh with its vertices moved outward. If set, texels are projected from the cage toward the
    /// mesh.
    std::optional<Mesh> cage{};
    EnumSet<MapAttribute> surface{}; ///< normal, height, position or object, in addition to the attributes of the bake
};

/// The values of one attribute, row by row from the top, where v is 1.
struct MapLayer {
    MapAttribute attribute;
    std::vector<float> values; ///< for each texel, one float per component of the attribute
};

enum class Coverage : std::uint8_t {
    background, ///< MapAttributeInfo::missing
    face,       ///< baked
    margin,     ///< the value of the nearest baked texel
    miss,       ///< the value of the nearest baked texel, because no high mesh is within reach
};

struct MapTile {
    int udim = 1001; ///< 1001 + u + 10 v, for a tile with its lower left corner at (u, v)
    std::vector<MapLayer> layers;
    std::vector<Coverage> coverage;
};

struct BakedMaps {
    int width = 0, height = 0;
    std::vector<MapTile> tiles; ///< in the order of their numbers
    std::size_t texels = 0;     ///< baked
    std::size_t overlaps = 0;   ///< baked texels that several faces cover; the first face is used
    std::size_t misses = 0;     ///< texels without a high mesh within reach
    double reach = 0.0;         ///< of the projection, scene units; 0 without high meshes
    double thickest = 0.0;      ///< min(radius, diagonal), which images show as 1; scene units
    Box box;                    ///< of the surface, scene units: positions in images are relative to it
    Baked baked;                ///< method, error, grids, times and warnings; its values are empty
};

/// Bakes the texels of all faces with UVs. A texel belongs to the first face that contains its centre, or else to the
/// first face that touches it. The normals of corners or vertices in the file are interpolated. If the file has none,
/// normals are means over faces within 40 degrees, so that edges are hard. NormalSource::angle and area smooth
/// everything.
///
/// With high meshes, each texel is projected inward, from MapOptions::reach in front of the mesh, onto the first face
/// of the high meshes that faces outward. Texels that hit no such face get the value of the nearest baked texel.
///
/// Cost: for each baked texel, that of bake() per point. Maps have many texels, so most of them are interpolated: in
/// dense tiles, only every second or fourth texel of every second or fourth row is baked at first. A texel between
/// these gets their mean if they differ by at most twice the error, and is baked otherwise. Texels are interpolated
/// only if ao is the only attribute, the error is at least 0.01, and there are no high meshes or subsamples.
/// Thread-safety as bake(). \throw like bake(), and InputError if the mesh has no UVs, no face covers a texel, or an
/// option is out of range. LimitError if the maps do not fit in memory.
BakedMaps bake_maps(const Mesh& mesh, const BakeOptions& bake = {}, const MapOptions& options = {});

/// What an occlusion texture contains besides ao.
enum class TexturePacking {
    none,          ///< nothing
    size_of_image, ///< the metallic-roughness texture of the material, at the size of its image; ao is the red channel
    size_of_map,   ///< the metallic-roughness texture, at the size in MapOptions
};

/// Textures of ao: one for each material of a glTF scene, or one for a mesh from another format.
struct OcclusionTextures {
    struct Texture {
        std::optional<std::size_t> material; ///< material of the glTF file; empty: for faces without one
        std::vector<std::pair<std::size_t, std::size_t>>
            primitives; ///< the primitives that show the texture: pairs of a mesh of the file and a primitive in it
        int uv_set = 0;
        int width = 0, height = 0; ///< texels
        bool is_packed = false;    ///< into the red channel of the metallic-roughness texture
    };
    std::vector<Texture> textures; ///< one per tile of `maps`
    BakedMaps maps;
};

/// Bakes a texture per material, on the first set of UVs that has no overlaps. If a glTF mesh has several instances,
/// all show the ao of the first instance; Baked::warnings says so. The attributes and MapOptions::uv_set, udim, high
/// and surface have no effect.
///
/// With packing, the UVs are those of the metallic-roughness texture if these do not overlap. Otherwise, and where
/// there is no such texture, the material gets a texture of its own; Baked::warnings says so.
/// TexturePacking::size_of_image bakes at the size of the largest metallic-roughness image. \throw like bake_maps(),
/// InputError naming the meshes that have no set of UVs without overlaps, or an image that is damaged, missing, or
/// neither PNG nor JPEG, and LimitError if an image does not fit in memory.
OcclusionTextures bake_occlusion_textures(const Mesh& mesh, const BakeOptions& bake = {},
                                          const MapOptions& options = {},
                                          TexturePacking packing = TexturePacking::none);

/// Writes a glTF file with the textures added as the occlusionTexture of the materials. \return messages like
/// write_mesh(). \throw like write_mesh(); InputError for an extension other than .glb and .gltf.
std::vector<std::string> write_occlusion_textures(const Mesh& mesh, const OcclusionTextures& textures,
                                                  const std::filesystem::path& file);

enum class MapDepth { automatic, eight, sixteen, half, single };

/// What a channel of a packed PNG contains: an attribute with one component, or a number.
struct PackedChannel {
    std::optional<MapAttribute> attribute{};
    float number = 0.0f; ///< in [0, 1]; used if there is no attribute
};

struct MapFileOptions {
    MapDepth depth = MapDepth::automatic; ///< 8 bits in a .png, half in an .exr
    std::vector<PackedChannel> pack{};    ///< one to four: write one .png with these channels
};

/// Check options without a mesh. \throw InputError for an option out of range, an extension other than .png and .exr, a
/// depth that the format lacks, or channels that cannot be packed.
void check(const MapOptions& options);
void check(const MapFileOptions& options, const std::filesystem::path& file);

/// Writes a .png per attribute, or one .exr with a layer per attribute. The first attribute, which is ao if ao is
/// baked, goes to `file`; the others go to `name_<attribute>.png`. `<UDIM>` in the name becomes the number of the tile.
/// PNGs contain ao and convexity unchanged, thickness as a share of BakedMaps::thickest, heights as 0.5 + 0.5 h/reach,
/// positions as shares of BakedMaps::box, object numbers as they are, and directions as 0.5 + 0.5 v, all without an
/// sRGB tag. Each file is written completely or not at all. \return the files. \throw like check(); IoError if a file
/// cannot be written.
std::vector<std::filesystem::path> write_maps(const BakedMaps& maps, const std::filesystem::path& file,
                                              const MapFileOptions& options = {});

/// Writes a .png per tile that is white at the texels that BakedMaps::misses counts. \return the files. \throw like
/// write_maps()
std::vector<std::filesystem::path> write_miss_mask(const BakedMaps& maps, const std::filesystem::path& file);

}
