#include "alcove/maps/detail/open_tile.h"

#include "alcove/maps/detail/padding.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace alcove {
namespace {

void take_mean(std::span<float> sums, std::uint16_t count, bool is_direction) {
    float length2 = 0.0f;
    for (float& sum : sums) {
        sum /= static_cast<float>(count);
        length2 += sum * sum;
    }
    if (is_direction && length2 > 0.0f)
        for (float& value : sums)
            value /= std::sqrt(length2);
}

void finish(MapLayer& layer, const MapTile& map, const std::vector<std::uint16_t>& counts,
            const std::vector<std::uint32_t>& nearest, bool are_sums, bool has_tangents) {
    const std::vector<Coverage>& coverage = map.coverage;
    const MapAttributeInfo attribute = info(layer.attribute);
    const std::size_t components = attribute.components, texels = coverage.size();
    for (std::size_t i = 0; i < texels && (are_sums || attribute.is_direction); ++i)
        if (coverage[i] == Coverage::face)
            take_mean(std::span(layer.values).subspan(components * i, components), counts[i], attribute.is_direction);
    for (std::size_t i = 0; i < texels; ++i)
        for (std::size_t c = 0; c < components && coverage[i] != Coverage::face; ++c)
            layer.values[components * i + c] = coverage[i] != Coverage::background
                                                   ? layer.values[components * nearest[i] + c]
                                               : attribute.is_direction && c == 2 && has_tangents ? 1.0f // the normal
                                                                                                  : attribute.missing;
}

}

TexelsAround texels_around(const OpenTile& tile, std::size_t texel) {
    const std::size_t width = static_cast<std::size_t>(tile.uvs.width), x = texel % width, y = texel / width;
    const std::size_t across = x % 2, down = (y % 2) * width;
    if ((across == 0 && down == 0) || (across > 0 && x + 1 == width) ||
        (down > 0 && y + 1 == static_cast<std::size_t>(tile.uvs.height)))
        return {};
    TexelsAround around{{texel - across - down, texel + across + down, texel + across - down, texel - across + down},
                        across > 0 && down > 0 ? 4u : 2u};
    const auto chart = [&](std::size_t i) {
        const std::uint32_t triangle = tile.owners.triangles[i];
        return triangle == no_triangle ? no_triangle : tile.faces->chart(triangle);
    };
    const std::uint32_t own = chart(texel);
    if (std::any_of(around.texels.begin(), around.texels.begin() + static_cast<std::ptrdiff_t>(around.count),
                    [&](std::size_t i) { return chart(i) != own; }))
        return {};
    return around;
}

std::vector<std::uint32_t> interpolate_between(OpenTile& tile, float tolerance, std::size_t& count) {
    std::vector<float>& values = tile.map.layers.front().values;
    std::vector<std::uint32_t> others;
    const auto width = static_cast<std::size_t>(tile.uvs.width);
    const int end = tile.sampled_rows == tile.uvs.height ? tile.uvs.height : std::max(tile.sampled_rows - 1, 0);
    for (; tile.interpolated_rows < end; ++tile.interpolated_rows)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t texel = static_cast<std::size_t>(tile.interpolated_rows) * width + x;
            if (!tile.wanted[texel])
                continue;
            const TexelsAround around = texels_around(tile, texel);
            if (around.count == 0)
                continue;
            float sum = 0.0f, least = 1.0f, most = 0.0f;
            for (std::size_t k = 0; k < around.count; ++k) {
                const float value = values[around.texels[k]];
                sum += value;
                least = std::min(least, value);
                most = std::max(most, value);
            }
            if (most - least > tolerance) {
                others.push_back(static_cast<std::uint32_t>(texel));
                continue;
            }
            values[texel] = sum / static_cast<float>(around.count);
            tile.counts[texel] = 1;
            ++count;
        }
    return others;
}

TexelCounts finish(OpenTile& tile, const MapOptions& options, bool has_tangents) {
    MapTile& map = tile.map;
    const std::size_t texels = tile.counts.size();
    std::vector<std::uint8_t> covered(texels);
    TexelCounts counts;
    for (std::size_t i = 0; i < texels; ++i) {
        covered[i] = tile.counts[i] > 0;
        counts.covered += covered[i];
        counts.missed += tile.wanted[i] & (tile.counts[i] == 0);
    }
    const int larger = std::max(options.width, options.height),
              margin = std::min(options.margin.value_or(std::max(larger / 128, 1)), larger);
    std::vector<std::uint32_t> nearest = nearest_covered(covered, options.width, options.height, margin);
    if (counts.missed > 0) { // their neighbours may be further than the margin
        const auto any = nearest_covered(covered, options.width, options.height, larger);
        for (std::size_t i = 0; i < texels; ++i)
            nearest[i] = tile.wanted[i] ? any[i] : nearest[i];
    }
    map.coverage.resize(texels);
    for (std::size_t i = 0; i < texels; ++i)
        map.coverage[i] = covered[i]        ? Coverage::face
                          : nearest[i] == i ? Coverage::background
                          : tile.wanted[i]  ? Coverage::miss
                                            : Coverage::margin;
    for (MapLayer& layer : map.layers)
        finish(layer, map, tile.counts, nearest, options.subsamples > 1 && layer.attribute != MapAttribute::object,
               has_tangents);
    return counts;
}

}
