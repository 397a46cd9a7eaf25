#include "alcove/maps/maps.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/parallel.h"
#include "alcove/maps/detail/padding.h"
#include "alcove/maps/detail/rasterize.h"
#include "alcove/maps/detail/uv_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

constexpr double bytes_per_point = 260.0; // measured: a bake of points
constexpr double bytes_per_sample = 7.0;  // rasterizing
constexpr double bytes_per_texel = 10.0;  // coverage, padding, counts
constexpr int largest_side = 16384, most_subsamples = 8;
constexpr int first_udim = 1001;

/// Bakes the tiles one after another, in batches of texels that fit in memory.
class MapBake {
  public:
    MapBake(const Mesh& mesh, const BakeOptions& bake, const MapOptions& options)
        : mesh_(mesh), options_(options), bake_(bake), faces_(mesh, bake.normals),
          width_(static_cast<std::size_t>(options.width)), texels_(width_ * static_cast<std::size_t>(options.height)) {
        maps_.width = options.width;
        maps_.height = options.height;
        if (has_tangents())
            faces_.add_tangents();
    }

    BakedMaps run() {
        const std::vector<int> tiles = faces_.tiles(options_.udim);
        check_memory(tiles.size());
        for (const int udim : tiles)
            bake_tile(udim);
        if (maps_.texels == 0)
            throw InputError("no face covers a texel: the UVs lie outside the tile, or have no area");
        warn();
        maps_.thickest = std::min(maps_.baked.radius, frame_of(mesh_.box()).diagonal);
        maps_.baked.values = {};
        if (error_weight_ > 0.0)
            maps_.baked.rmse = std::sqrt(squares_ / error_weight_);
        return std::move(maps_);
    }

  private:
    bool has_tangents() const {
        return options_.space == MapSpace::tangent && bake_.attributes.has(Channel::bent_normal);
    }

    std::size_t components() const {
        std::size_t count = 0;
        for (const ChannelInfo& channel : channels)
            count += bake_.attributes.has(channel.channel) ? channel.components : 0;
        return count;
    }

    /// Refuses maps that do not fit, and sets the size of batches.
    void check_memory(std::size_t tiles) {
        const double samples = double(texels_) * options_.subsamples * options_.subsamples;
        const double values = double(tiles) * double(texels_) * (4.0 * double(components()) + 1.0);
        const double bytes = values + bytes_per_sample * samples + bytes_per_texel * double(texels_) +
                             bytes_per_point * double(fewest_in_batch);
        if (bytes > memory_limit())
            throw LimitError(fmt::format("maps of {} x {} texels need about {} GB, over the limit of {} GB: choose a "
                                         "smaller --size or fewer --subsamples, or raise --max-memory",
                                         options_.width, options_.height, rounded(bytes / 1e9, 2),
                                         rounded(memory_limit() / 1e9, 2)));
        batch_ = std::max(fewest_in_batch, static_cast<std::size_t>(0.5 * (memory_limit() - bytes) / bytes_per_point));
    }

    UvTile tile_of(int udim) const {
        const int number = udim - first_udim, n = options_.subsamples;
        return {n * options_.width, n * options_.height, Vec2(number % 10, number / 10)};
    }

    void bake_tile(int udim) {
        const UvTile tile = tile_of(udim);
        const TexelOwners owners = rasterize(faces_.uvs(), tile);
        maps_.overlaps += owners.overlaps;
        MapTile& map = maps_.tiles.emplace_back();
        map.udim = udim;
        for (const ChannelInfo& channel : channels)
            if (bake_.attributes.has(channel.channel))
                map.layers.push_back({channel.channel, std::vector<float>(texels_ * channel.components, 0.0f)});
        std::vector<std::uint16_t> counts(texels_, 0); // samples per texel
        std::vector<std::uint32_t> samples;
        const auto flush = [&] {
            if (!samples.empty())
                bake_samples(tile, owners, samples, map, counts);
            samples.clear();
        };
        for (std::size_t i = 0; i < owners.size(); ++i)
            if (owners.triangles[i] != no_triangle) {
                samples.push_back(static_cast<std::uint32_t>(i));
                if (samples.size() == batch_)
                    flush();
            }
        flush();
        finish(map, counts);
    }

    std::size_t texel_of(std::size_t sample) const {
        const auto n = static_cast<std::size_t>(options_.subsamples);
        return sample / (n * width_) / n * width_ + sample % (n * width_) / n;
    }

    void bake_samples(const UvTile& tile, const TexelOwners& owners, const std::vector<std::uint32_t>& samples,
                      MapTile& map, std::vector<std::uint16_t>& counts) {
        std::vector<SurfacePoint> points(samples.size());
        parallel_for(samples.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t triangle = owners.triangles[samples[i]];
                points[i] = faces_.point(triangle, weights_at(faces_.uvs()[triangle], tile, samples[i]));
            }
        });
        Baked baked = bake(mesh_, points, bake_);
        turn_directions(tile, owners, samples, baked.values[Channel::bent_normal]);
        for (MapLayer& layer : map.layers) {
            const std::size_t components = info(layer.channel).components;
            const std::vector<float>& values = baked[layer.channel];
            for (std::size_t i = 0; i < samples.size(); ++i)
                for (std::size_t c = 0; c < components; ++c)
                    layer.values[components * texel_of(samples[i]) + c] += values[components * i + c];
        }
        for (const std::uint32_t sample : samples)
            ++counts[texel_of(sample)];
        merge(std::move(baked), samples.size());
    }

    /// Into the axes of the options.
    void turn_directions(const UvTile& tile, const TexelOwners& owners, const std::vector<std::uint32_t>& samples,
                         std::vector<float>& directions) const {
        for (std::size_t i = 0; 3 * i < directions.size(); ++i) {
            float* const d = &directions[3 * i];
            if (has_tangents()) {
                const std::uint32_t triangle = owners.triangles[samples[i]];
                const Vec3 local = faces_.to_tangent(triangle, weights_at(faces_.uvs()[triangle], tile, samples[i]),
                                                     {d[0], d[1], d[2]});
                d[0] = local.x, d[1] = local.y, d[2] = local.z;
            }
            if (options_.flip_green)
                d[1] = -d[1];
        }
    }

    /// Keeps the description of the first batch, sums times and errors, and collects warnings.
    void merge(Baked baked, std::size_t points) {
        if (baked.rmse) {
            squares_ += *baked.rmse * *baked.rmse * static_cast<double>(points);
            error_weight_ += static_cast<double>(points);
        }
        evaluated_ += baked.evaluated * static_cast<double>(points);
        points_ += static_cast<double>(points);
        if (points_ == static_cast<double>(points)) {
            maps_.baked = std::move(baked);
        } else {
            Baked& all = maps_.baked;
            all.seconds.grid += baked.seconds.grid;
            all.seconds.pilot += baked.seconds.pilot;
            all.seconds.occlusion += baked.seconds.occlusion;
            for (std::string& warning : baked.warnings)
                if (std::find(all.warnings.begin(), all.warnings.end(), warning) == all.warnings.end())
                    all.warnings.push_back(std::move(warning));
        }
        maps_.baked.evaluated = evaluated_ / points_;
    }

    /// Turns sums into means, and fills the margin.
    void finish(MapTile& map, const std::vector<std::uint16_t>& counts) {
        std::vector<std::uint8_t> covered(texels_);
        for (std::size_t i = 0; i < texels_; ++i) {
            covered[i] = counts[i] > 0;
            maps_.texels += covered[i];
        }
        const int larger = std::max(options_.width, options_.height),
                  margin = std::min(options_.margin.value_or(std::max(larger / 128, 1)), larger);
        const std::vector<std::uint32_t> nearest = nearest_covered(covered, options_.width, options_.height, margin);
        map.coverage.resize(texels_);
        for (std::size_t i = 0; i < texels_; ++i)
            map.coverage[i] = covered[i]            ? Coverage::face
                              : covered[nearest[i]] ? Coverage::margin
                                                    : Coverage::background;
        for (MapLayer& layer : map.layers) {
            const ChannelInfo& channel = info(layer.channel);
            const std::size_t components = channel.components;
            for (std::size_t i = 0; i < texels_; ++i)
                if (covered[i])
                    take_mean(std::span(layer.values).subspan(components * i, components), counts[i]);
            for (std::size_t i = 0; i < texels_; ++i)
                for (std::size_t c = 0; c < components && !covered[i]; ++c)
                    layer.values[components * i + c] =
                        map.coverage[i] == Coverage::margin           ? layer.values[components * nearest[i] + c]
                        : components == 3 && c == 2 && has_tangents() ? 1.0f // the normal
                                                                      : channel.missing;
        }
    }

    static void take_mean(std::span<float> sums, std::uint16_t count) {
        float length2 = 0.0f;
        for (float& sum : sums) {
            sum /= static_cast<float>(count);
            length2 += sum * sum;
        }
        if (sums.size() == 3 && length2 > 0.0f) // directions
            for (float& value : sums)
                value /= std::sqrt(length2);
    }

    void warn() {
        std::vector<std::string> warnings = faces_.warnings(options_.udim);
        if (maps_.overlaps > 0)
            warnings.push_back(fmt::format("{} covered by several faces (overlapping UVs): the first face is baked "
                                           "there; unwrap without overlaps to give each face its own texels",
                                           counted(maps_.overlaps, "texel is", "texels are")));
        maps_.baked.warnings.insert(maps_.baked.warnings.begin(), warnings.begin(), warnings.end());
    }

    static constexpr std::size_t fewest_in_batch = 1 << 20;

    const Mesh& mesh_;
    const MapOptions& options_;
    BakeOptions bake_;
    UvFaces faces_;
    std::size_t width_, texels_; // of the map; texels per tile
    std::size_t batch_ = fewest_in_batch;
    BakedMaps maps_;
    double squares_ = 0.0, error_weight_ = 0.0, evaluated_ = 0.0, points_ = 0.0;
};

}

void check(const MapOptions& options) {
    const auto within = [](int value, int most) { return value >= 1 && value <= most; };
    if (!within(options.width, largest_side) || !within(options.height, largest_side))
        throw InputError(
            fmt::format("--size takes 1 to {} texels, not {} x {}", largest_side, options.width, options.height));
    if (!within(options.subsamples, most_subsamples) ||
        options.subsamples * std::max(options.width, options.height) > most_texels)
        throw InputError(fmt::format("--subsamples takes 1 to {}, and at most {} along a side of the map",
                                     most_subsamples, most_texels));
    if (options.margin && *options.margin < 0)
        throw InputError("--margin takes a number of texels, none or all");
}

BakedMaps bake_maps(const Mesh& mesh, const BakeOptions& bake, const MapOptions& options) {
    const ThreadLimit limit(bake.threads);
    check(bake);
    check(options);
    return MapBake(mesh, bake, options).run();
}

}
