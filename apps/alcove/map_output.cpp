#include "map_output.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

namespace alcove::cli {
namespace {

/// The whole number that the text represents; empty for any other text.
std::optional<int> whole_number(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// Parses a size: N or WxH.
std::pair<int, int> parse_size(const std::string& text) {
    const std::size_t times = text.find('x');
    const std::optional<int> width = whole_number(std::string_view(text).substr(0, times)),
                             height = times == std::string::npos
                                          ? width
                                          : whole_number(std::string_view(text).substr(times + 1));
    if (!width || !height)
        throw InputError(fmt::format("takes a number of texels such as 2048, or 2048x1024, not '{}'", text));
    return {*width, *height};
}

/// Parses names of attributes and numbers, separated by commas.
std::vector<PackedChannel> parse_pack(const std::string& text) {
    std::vector<PackedChannel> pack;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) {
        float number = 0.0f;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc())
            pack.push_back({map_attribute(word)});
        else if (end == word.data() + word.size() && number >= 0.0f && number <= 1.0f)
            pack.push_back({{}, number});
        else
            throw InputError(fmt::format(
                "takes attributes and numbers from 0 to 1, separated by commas, such as ao,thickness,0, not '{}'",
                word));
    }
    return pack;
}

int parse_margin(const std::string& text) {
    constexpr int everything = 1 << 16;
    if (text == "none" || text == "all")
        return text == "none" ? 0 : everything;
    if (const std::optional<int> texels = whole_number(text); texels && *texels >= 0)
        return *texels;
    throw InputError(fmt::format("takes a number of texels, none or all, not '{}'", text));
}

}

EnumSet<MapAttribute> parse_attributes(const std::string& text) {
    EnumSet<MapAttribute> attributes;
    std::istringstream names(text);
    for (std::string name; std::getline(names, name, ',');)
        attributes = attributes | map_attribute(name);
    if (attributes.empty())
        map_attribute(text); // throws, listing the attributes
    return attributes;
}

bool MapRequest::given() const {
    return sized || given_beyond_size();
}

bool MapRequest::given_beyond_size() const {
    return !high.empty() || !cage.empty() || map.uv_set != 0 || map.reach || !miss_mask.empty() ||
           !map.surface.empty() || files.depth != MapDepth::automatic || map.space != MapSpace::tangent ||
           map.flip_green || !files.pack.empty();
}

TexturePacking MapRequest::packing() const {
    if (!pack_orm)
        return TexturePacking::none;
    return has_size ? TexturePacking::size_of_map : TexturePacking::size_of_image;
}

bool is_map(const std::string& output) {
    return extension(output) == ".png" || extension(output) == ".exr";
}

void add_map_options(CLI::App& verb, MapRequest& request) {
    add_choice<bool>(verb, "--into", request.into_texture, {{"vertices", false}, {"texture", true}},
                     "Where to store the values in a glb or gltf. vertices: at its vertices; texture: in one occlusion "
                     "texture per material, using a UV set of the file that has no overlaps")
        ->type_name("WHERE")
        ->default_str("vertices");
    verb.add_flag(
        "--pack-orm", request.pack_orm,
        "With --into texture: store ao in the red channel of each material's metallic-roughness texture, keeping the "
        "size of that texture unless --size is given");
    verb.add_option_function<std::string>(
            "--size",
            [&request](const std::string& text) {
                std::tie(request.map.width, request.map.height) = parse_size(text);
                request.has_size = request.sized = true;
            },
            "Texels of a map along each side: N, or WxH")
        ->check(parsable(parse_size))
        ->type_name("SIZE")
        ->default_str("2048");
    verb.add_option_function<int>(
            "--subsamples",
            [&request](int count) {
                request.map.subsamples = count;
                request.sized = true;
            },
            "Samples along each side of a texel, for smooth borders: 4 means 16 samples")
        ->check(CLI::Range(1, 8).description(""))
        ->type_name("N")
        ->default_str("1");
    verb.add_option_function<std::string>(
            "--margin",
            [&request](const std::string& text) {
                request.map.margin = parse_margin(text);
                request.sized = true;
            },
            "Texels to fill around each island of a map: a number, none or all. Default: 1/128 of the size")
        ->check(parsable(parse_margin))
        ->type_name("TEXELS");
    add_choice<MapDepth>(
        verb, "--depth", request.files.depth,
        {{"8", MapDepth::eight}, {"16", MapDepth::sixteen}, {"half", MapDepth::half}, {"float", MapDepth::single}},
        "Bit depth of a map: 8 or 16 in a png, half or float in an exr. Default: 8 in a png, half in an exr")
        ->type_name("DEPTH");
    add_choice<MapSpace>(
        verb, "--space", request.map.space, {{"tangent", MapSpace::tangent}, {"object", MapSpace::object}},
        "Coordinate space of the directions in a map: tangent (MikkTSpace) or object (the coordinates of the mesh)")
        ->type_name("SPACE")
        ->default_str("tangent");
    verb.add_flag("--flip-green", request.map.flip_green, "Negate the green channel of directions, as DirectX expects");
    verb.add_option(
            "--high", request.high,
            "High-poly mesh or level set whose surface is baked into the UVs of the input; repeat the option for "
            "more")
        ->option_text("MESH");
    verb.add_option("--uv-set", request.map.uv_set, "Index of the UV set of a glTF file, counted from 0")
        ->check(CLI::Range(0, 255).description(""))
        ->type_name("N")
        ->capture_default_str();
    verb.add_option(
            "--cage", request.cage,
            "A copy of the input with its vertices moved outward: the search for the high mesh starts there, and "
            "goes toward the input instead of along the normals")
        ->type_name("MESH");
    verb.add_option_function<std::string>(
            "--reach",
            [&request](const std::string& text) {
                if (text != "auto")
                    request.map.reach = Length(text);
            },
            "How far to look for the high mesh, in front of the surface and behind it: a length, or auto (from the "
            "distance between the meshes)")
        ->check(parsable([](const std::string& text) {
            if (text != "auto")
                length_without_vx(text, "auto, 0.2 (scene units) or 2% (of the diagonal of the high mesh)");
        }))
        ->type_name("LEN")
        ->default_str("auto");
    verb.add_option("--miss-mask", request.miss_mask, "Write a png that is white where no high mesh is within reach")
        ->type_name("FILE");
    verb.add_option_function<std::string>(
            "--pack", [&request](const std::string& text) { request.files.pack = parse_pack(text); },
            "Write one png with these attributes as its channels, such as ao,thickness,convexity. A number in "
            "place of a name sets that channel to a constant")
        ->check(parsable(parse_pack))
        ->excludes(verb.get_option("--attributes"))
        ->type_name("NAMES");
}

void check_miss_mask(const MapRequest& request, const std::string& output) {
    const std::string& mask = request.miss_mask;
    if (request.high.empty())
        throw InputError("--miss-mask shows where no high mesh is found: give --high");
    if (extension(mask) != ".png")
        throw InputError(mask + ": the miss mask is written as .png: use this extension");
    const auto has_tiles = [](const std::string& file) { return file.find("<UDIM>") != std::string::npos; };
    if (has_tiles(output) != has_tiles(mask))
        throw InputError(mask + ": put <UDIM> into the names of both the output and the --miss-mask, or of neither");
    const std::filesystem::path file(output);
    const std::string stem = file.stem().string(), name = std::filesystem::path(mask).stem().string();
    for (const std::string_view attribute : {"", "_convexity", "_bent_normal", "_thickness", "_normal", "_height",
                                             "_position", "_object", "_ao_short", "_ao_long"})
        if (name == stem + std::string(attribute))
            throw InputError(mask + ": could also be the name of a map: choose another name");
    const AtomicFile probe(mask);
}

std::string attributes_of(const BakedMaps& maps) {
    std::string names;
    for (const MapLayer& layer : maps.tiles.front().layers)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", info(layer.attribute).name);
    return names;
}

std::string summary_of(const BakedMaps& maps) {
    const std::string names = attributes_of(maps);
    return fmt::format("{} of {} texels of {} x {}{}{}", names, grouped(maps.texels), maps.width, maps.height,
                       maps.tiles.size() > 1 ? fmt::format(" in {} tiles", maps.tiles.size()) : "",
                       maps.reach > 0.0 ? fmt::format(", reach {:.4g}", maps.reach) : "");
}

}
