#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/file_kind.h"
#include "alcove/base/types.h"
#include "alcove/maps/detail/map_provenance.h"
#include "alcove/maps/maps.h"
#include "alcove/render/detail/exr_file.h"
#include "alcove/render/detail/png_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace alcove {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view udim_mark = "<UDIM>";

fs::path of_tile(const fs::path& file, int udim) {
    std::string name = file.filename().string();
    for (std::size_t at; (at = name.find(udim_mark)) != std::string::npos;)
        name.replace(at, udim_mark.size(), std::to_string(udim));
    return file.parent_path() / name;
}

/// The file of an attribute. The first attribute, which is ao if ao is baked, goes to `file` itself.
fs::path of_attribute(const fs::path& file, std::string_view attribute, bool is_first) {
    if (is_first)
        return file;
    std::string stem = file.stem().string();
    const std::size_t at = stem.find(udim_mark); // NAME.<UDIM>.png becomes NAME_attribute.<UDIM>.png
    const std::size_t mark = at == std::string::npos ? stem.size() : at > 0 && stem[at - 1] == '.' ? at - 1 : at;
    stem.insert(mark, fmt::format("_{}", attribute));
    return file.parent_path() / (stem + file.extension().string());
}

/// The values of a layer as a PNG stores them.
class PngValues {
  public:
    PngValues(const BakedMaps& maps, const MapLayer& layer, int bits)
        : values_(layer.values), components_(info(layer.attribute).components), most_(float((1 << bits) - 1)) {
        const auto map = [&](double from, double to) { // maps this range to [0, 1]
            for (Range& range : ranges_)
                range = {static_cast<float>(1.0 / (to - from)), static_cast<float>(-from / (to - from))};
        };
        if (layer.attribute == MapAttribute::thickness)
            map(0.0, maps.thickest);
        else if (layer.attribute == MapAttribute::height)
            map(-maps.reach, maps.reach);
        else if (layer.attribute == MapAttribute::object)
            map(0.0, most_);
        else if (info(layer.attribute).is_direction)
            map(-1.0, 1.0);
        else if (layer.attribute == MapAttribute::position)
            for (int axis = 0; axis < 3; ++axis) {
                const double low = maps.box.min[axis], size = maps.box.max[axis] - low;
                ranges_[static_cast<std::size_t>(axis)] =
                    size > 0.0 ? Range{static_cast<float>(1.0 / size), static_cast<float>(-low / size)}
                               : Range{0.0f, 0.5f};
            }
    }

    /// The i-th value of the layer.
    std::uint16_t operator()(std::size_t i) const {
        const Range& range = ranges_[components_ == 1 ? 0 : i % components_];
        const float share = std::clamp(range.scale * values_[i] + range.offset, 0.0f, 1.0f);
        constexpr float half = 0.5f; // for rounding, which is faster than lround()
        return static_cast<std::uint16_t>(most_ * share + half);
    }

  private:
    struct Range {
        float scale = 1.0f, offset = 0.0f;
    };

    const std::vector<float>& values_;
    std::size_t components_;
    float most_;
    std::array<Range, 3> ranges_{};
};

std::string encoded(const BakedMaps& maps, const MapLayer& layer, int bits) {
    const PngValues png(maps, layer, bits);
    std::vector<std::uint16_t> values(layer.values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = png(i);
    return encode_png_file(maps.width, maps.height, static_cast<int>(info(layer.attribute).components), bits, values,
                           png_texts(maps));
}

std::string packed(const BakedMaps& maps, const MapTile& tile, std::span<const PackedChannel> pack, int bits) {
    const std::size_t texels = tile.coverage.size(), channels = pack.size();
    std::vector<std::uint16_t> values(channels * texels);
    for (std::size_t c = 0; c < channels; ++c) {
        if (!pack[c].attribute) {
            const auto value = static_cast<std::uint16_t>(
                std::lround(static_cast<float>((1 << bits) - 1) * std::clamp(pack[c].number, 0.0f, 1.0f)));
            for (std::size_t i = 0; i < texels; ++i)
                values[channels * i + c] = value;
            continue;
        }
        const auto layer = std::find_if(tile.layers.begin(), tile.layers.end(), [&](const MapLayer& candidate) {
            return *pack[c].attribute == candidate.attribute;
        });
        if (layer == tile.layers.end())
            throw InputError(fmt::format("{} was not baked, so it cannot be packed", info(*pack[c].attribute).name));
        const PngValues png(maps, *layer, bits);
        for (std::size_t i = 0; i < texels; ++i)
            values[channels * i + c] = png(i);
    }
    return encode_png_file(maps.width, maps.height, static_cast<int>(channels), bits, values, png_texts(maps));
}

void write_file(const fs::path& file, const std::string& bytes) {
    AtomicFile target(file);
    target.write(bytes);
    target.commit();
}

std::vector<fs::path> write_pngs(const BakedMaps& maps, const MapTile& tile, const fs::path& file, int bits) {
    std::vector<fs::path> written;
    for (const MapLayer& layer : tile.layers) {
        const fs::path path =
            of_tile(of_attribute(file, info(layer.attribute).name, &layer == &tile.layers.front()), tile.udim);
        write_file(path, encoded(maps, layer, bits));
        written.push_back(path);
    }
    return written;
}

/// The name of a layer in an .exr: "AO", "BentNormal".
std::string layer_name(MapAttribute attribute) {
    if (attribute == MapAttribute::ao)
        return "AO";
    std::string name;
    bool starts_word = true;
    for (const char c : info(attribute).name) {
        if (c != '_')
            name += starts_word ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        starts_word = c == '_';
    }
    return name;
}

void write_exr(const BakedMaps& maps, const MapTile& tile, const fs::path& file, Precision precision) {
    std::vector<float> alpha(tile.coverage.size());
    std::transform(tile.coverage.begin(), tile.coverage.end(), alpha.begin(),
                   [](Coverage coverage) { return coverage == Coverage::background ? 0.0f : 1.0f; });
    std::vector<ExrChannel> channels{{"A", alpha.data(), 1, precision}};
    for (const MapLayer& layer : tile.layers) {
        const std::size_t components = info(layer.attribute).components;
        const auto add = [&](const std::string& prefix, std::string_view names) {
            for (std::size_t c = 0; c < 3; ++c)
                channels.push_back(
                    {prefix + names[c], layer.values.data() + (components == 3 ? c : 0), components, precision});
        };
        if (&layer == &tile.layers.front())
            add("", "RGB");
        add(layer_name(layer.attribute) + ".", components == 3 ? "XYZ" : "RGB");
    }
    ImageHeader header;
    header.software = map_software();
    header.comments = how_made(maps);
    write_exr_file(maps.width, maps.height, channels, header, false, file);
}

}

void check(const MapFileOptions& options, const fs::path& file) {
    const std::string extension = lower_extension(file);
    const MapDepth depth = options.depth;
    if (extension != ".png" && extension != ".exr")
        throw InputError(file.string() + ": maps are written as .png or .exr: use one of these extensions");
    if (extension == ".png" && (depth == MapDepth::half || depth == MapDepth::single))
        throw InputError("--depth half and float are for .exr: a .png has 8 or 16 bits");
    if (extension == ".exr" && (depth == MapDepth::eight || depth == MapDepth::sixteen))
        throw InputError("--depth 8 and 16 are for .png: an .exr has half or float values");
    constexpr std::size_t most_channels = 4;
    if (!options.pack.empty() && (extension != ".png" || options.pack.size() > most_channels))
        throw InputError("--pack puts one to four attributes into a .png");
    for (const PackedChannel& channel : options.pack)
        if (channel.attribute && info(*channel.attribute).components > 1)
            throw InputError(
                fmt::format("--pack takes attributes with one value, not {}", info(*channel.attribute).name));
}

std::vector<fs::path> write_maps(const BakedMaps& maps, const fs::path& file, const MapFileOptions& options) {
    check(options, file);
    std::vector<fs::path> written;
    const int bits = options.depth == MapDepth::sixteen ? 16 : 8;
    for (const MapTile& tile : maps.tiles)
        if (!options.pack.empty()) {
            written.push_back(of_tile(file, tile.udim));
            write_file(written.back(), packed(maps, tile, options.pack, bits));
        } else if (lower_extension(file) == ".png") {
            for (fs::path& path : write_pngs(maps, tile, file, bits))
                written.push_back(std::move(path));
        } else {
            written.push_back(of_tile(file, tile.udim));
            write_exr(maps, tile, written.back(),
                      options.depth == MapDepth::single ? Precision::single : Precision::half);
        }
    return written;
}

std::vector<fs::path> write_miss_mask(const BakedMaps& maps, const fs::path& file) {
    if (lower_extension(file) != ".png")
        throw InputError(file.string() + ": the miss mask is written as .png: use this extension");
    std::vector<fs::path> written;
    for (const MapTile& tile : maps.tiles) {
        std::vector<std::uint16_t> values(tile.coverage.size());
        std::transform(tile.coverage.begin(), tile.coverage.end(), values.begin(), [](Coverage coverage) {
            return static_cast<std::uint16_t>(coverage == Coverage::miss ? 255 : 0);
        });
        written.push_back(of_tile(file, tile.udim));
        write_file(written.back(), encode_png_file(maps.width, maps.height, 1, 8, values, png_texts(maps)));
    }
    return written;
}

}
