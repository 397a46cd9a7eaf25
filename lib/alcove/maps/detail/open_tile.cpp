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
            layer.values[components * i + c] =
                coverage[i] != Coverage::background                ? layer.values[components * nearest[i] + c]
                : attribute.is_direction && c == 2 && has_tangents ? 1.0f // along the normal
                                                                   : attribute.missing;
}

/// Calls `visit(index)` for each texel from which `texel` is interpolated.
template <class Visit>
void for_each_around(const TexelsAround& around, std::size_t texel, std::size_t width, const Visit& visit) {
    const std::size_t rows = around.down * width, across = around.across;
    visit(texel - rows - across);
    visit(texel + rows + across);
    if (rows > 0 && across > 0) {
        visit(texel - rows + across);
        visit(texel + rows - across);
    }
}

/// Interpolates texels of a row from their neighbours at `distance`, and adds the number of these texels to `count`.
/// Texels whose neighbours differ by more than `tolerance` are appended to `others` instead.
void interpolate_row(OpenTile& tile, std::size_t row, std::size_t distance, float tolerance, std::size_t& count,
                     std::vector<std::uint32_t>& others) {
    std::vector<float>& values = tile.map.layers.front().values;
    const auto width = static_cast<std::size_t>(tile.uvs.width);
    const bool is_between = (row & distance) != 0;
    for (std::size_t x = is_between ? 0 : distance; x < width; x += is_between ? distance : 2 * distance) {
        const std::size_t texel = row * width + x;
        if (!tile.wanted[texel])
            continue;
        const TexelsAround around = texels_around(tile, x, row);
        if (!around.any())
            continue;
        float sum = 0.0f, least = 1.0f, most = 0.0f, neighbours = 0.0f;
        for_each_around(around, texel, width, [&](std::size_t i) {
            sum += values[i];
            least = std::min(least, values[i]);
            most = std::max(most, values[i]);
            ++neighbours;
        });
        if (most - least > tolerance) {
            others.push_back(static_cast<std::uint32_t>(texel));
            continue;
        }
        values[texel] = sum / neighbours;
        tile.counts[texel] = 1;
        ++count;
    }
}

}

int stride_of_samples(std::size_t covered_texels, std::size_t triangles, float error) {
    constexpr int largest = 4;
    constexpr double fewest = 65'000, per_triangle_and_error = 0.07; // samples
    const double needed = std::max(fewest, per_triangle_and_error / double{error} * static_cast<double>(triangles));
    int stride = 1;
    while (stride < largest && static_cast<double>(covered_texels) >= 4.0 * stride * stride * needed)
        stride *= 2;
    return stride;
}

TexelsAround texels_around(const OpenTile& tile, std::size_t x, std::size_t y) {
    const auto width = static_cast<std::size_t>(tile.uvs.width), height = static_cast<std::size_t>(tile.uvs.height);
    const std::size_t distance = (x | y) & (~(x | y) + 1); // the lowest bit
    if (distance == 0 || distance >= static_cast<std::size_t>(tile.stride))
        return {};
    const TexelsAround around{x & distance, y & distance};
    if ((around.across > 0 && x + around.across >= width) || (around.down > 0 && y + around.down >= height))
        return {};
    const std::size_t texel = y * width + x;
    const std::uint32_t own = tile.owners.triangles[texel], chart = tile.faces->chart(own);
    bool is_inside = true;
    for_each_around(around, texel, width, [&](std::size_t i) {
        const std::uint32_t triangle = tile.owners.triangles[i];
        is_inside = is_inside && (triangle == own || (triangle != no_triangle && tile.faces->chart(triangle) == chart));
    });
    return is_inside ? around : TexelsAround{};
}

std::vector<std::uint32_t> interpolate_between(OpenTile& tile, float tolerance, std::size_t& count) {
    std::vector<std::uint32_t> others;
    int ready = tile.sampled_rows; // rows from the top that have values at larger distances
    for (int distance = tile.stride / 2; distance > 0 && others.empty(); distance /= 2) {
        int& row = tile.interpolated_rows[static_cast<std::size_t>(distance - 1)];
        const int end = ready == tile.uvs.height ? ready : std::max(ready - distance, 0);
        for (; row < end; row += distance)
            interpolate_row(tile, static_cast<std::size_t>(row), static_cast<std::size_t>(distance), tolerance, count,
                            others);
        ready = std::min(row, end);
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
    if (counts.missed > 0) { // the neighbours of a missed texel may be further away than the margin
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
