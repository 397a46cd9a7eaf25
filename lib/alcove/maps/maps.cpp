#include "alcove/maps/maps.h"

#include "alcove/bake/detail/selection.h"
#include "alcove/bake/detail/surface_points.h"
#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/maps/detail/open_tile.h"
#include "alcove/maps/detail/rasterize.h"
#include "alcove/maps/detail/uv_faces.h"
#include "alcove/maps/detail/uv_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr double bytes_per_point = 260.0; // measured for bakes of points
constexpr double bytes_per_sample = 7.0;  // for rasterizing
constexpr double bytes_per_texel = 10.0;  // for coverage, padding and counts
constexpr int most_subsamples = 8;

/// The faces of several meshes as one mesh, with normals if all the meshes have them.
Mesh united(std::span<const Mesh> meshes) {
    Mesh all;
    all.name = meshes.front().name;
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    const auto append_of_all = [&](std::vector<Vec3> Mesh::*normals) {
        if (std::none_of(meshes.begin(), meshes.end(), [&](const Mesh& mesh) { return (mesh.*normals).empty(); }))
            for (const Mesh& mesh : meshes)
                append(all.*normals, mesh.*normals);
    };
    append_of_all(&Mesh::normals);
    append_of_all(&Mesh::corner_normals);
    for (const Mesh& mesh : meshes) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        append(all.positions, mesh.positions);
        for (const std::uint32_t corner : mesh.corners)
            all.corners.push_back(first + corner);
        for (std::size_t f = 0; f < mesh.face_count(); ++f)
            all.face_begin.push_back(all.face_begin.back() + static_cast<std::uint32_t>(mesh.face(f).size()));
    }
    return all;
}

/// A sample of a texel.
struct Sample {
    std::uint32_t tile, index; ///< the index of the tile, and of the sample in it
};

/// Bakes the samples of all tiles in batches.
class MapBake {
  public:
    MapBake(const Mesh& mesh, const BakeOptions& bake, const MapOptions& options, std::span<const UvLayout> layouts)
        : mesh_(mesh), options_(options), bake_(bake), width_(static_cast<std::size_t>(options.width)),
          texels_(width_ * static_cast<std::size_t>(options.height)) {
        for (const UvLayout& layout : layouts)
            layouts_.emplace_back(mesh, UvFacesOptions{bake.normals, layout.uv_set, layout.wanted});
        maps_.width = options.width;
        maps_.height = options.height;
        for (const ChannelInfo& channel : channels)
            if (bake.attributes.has(channel.channel))
                attributes_.push_back(attribute_of(channel.channel));
        for (const MapAttribute attribute :
             {MapAttribute::normal, MapAttribute::height, MapAttribute::position, MapAttribute::object})
            if (options.surface.has(attribute))
                attributes_.push_back(attribute);
        has_tangents_ = options.space == MapSpace::tangent &&
                        std::any_of(attributes_.begin(), attributes_.end(),
                                    [](MapAttribute attribute) { return info(attribute).is_direction; });
        if (!options.high.empty()) {
            high_ = united(options.high);
            projection_.emplace(*high_, bake.normals);
            for (const Mesh& part : options.high)
                object_ends_.push_back((object_ends_.empty() ? 0 : object_ends_.back()) + part.face_count());
        }
        for (UvFaces& faces : layouts_) {
            if (has_tangents_)
                faces.add_tangents();
            if (high_)
                faces.add_directions();
            if (options.cage)
                faces.set_cage(*options.cage);
        }
        const double error = bake.error.value_or(bake.method.empty() ? rmse_of(bake.quality) : 0.0);
        // If less error is wanted, the noise of the rays alone makes neighbours differ by more than the tolerance.
        constexpr double least_error = 0.01;
        if (error >= least_error && options.subsamples == 1 && !high_ && bake.attributes == Channel::ao)
            sparse_error_ = static_cast<float>(error);
    }

    BakedMaps run() {
        std::vector<std::pair<UvFaces*, int>> tiles;
        for (UvFaces& faces : layouts_)
            for (const int udim : faces.tiles(options_.udim))
                tiles.emplace_back(&faces, udim);
        check_memory(tiles.size());
        maps_.box = surface().box();
        if (projection_)
            maps_.reach = reach();
        for (const auto& [faces, udim] : tiles)
            add_tile(*faces, udim);
        flush();
        if (maps_.texels == 0)
            throw InputError(maps_.misses > 0
                                 ? "no texel is within reach of the high meshes: give a larger --reach"
                                 : "no face covers a texel: the UVs lie outside the tile, or have no area");
        warn();
        maps_.thickest = std::min(maps_.baked.radius, frame_of(maps_.box).diagonal);
        maps_.baked.values = {};
        if (error_weight_ > 0.0)
            maps_.baked.rmse = std::sqrt(squares_ / error_weight_);
        return std::move(maps_);
    }

  private:
    /// The mesh whose surface is baked.
    const Mesh& surface() const { return high_ ? *high_ : mesh_; }

    double reach() const {
        if (options_.reach)
            return double(options_.reach->to_unit(projection_->diagonal())) * projection_->diagonal();
        constexpr std::size_t sample = 4096; // points, spread over triangles
        const UvFaces& faces = layouts_.front();
        if (faces.uvs().empty())
            return 0.0;
        const std::size_t count = faces.uvs().size(), stride = std::max<std::size_t>(count / sample, 1);
        const auto steps = static_cast<int>(std::ceil(std::sqrt(2.0 * static_cast<double>(sample) / double(count))));
        std::vector<ProjectedFrom> points;
        for (std::size_t t = 0; t < count; t += stride)
            for (int i = 0; i <= steps; ++i)
                for (int k = 0; k <= steps - i; ++k)
                    points.push_back(faces.projected_from(static_cast<std::uint32_t>(t),
                                                          Vec3d(i, k, steps - i - k) / double(steps), 0.0));
        return projection_->reach_for(points);
    }

    std::size_t components() const {
        std::size_t count = 0;
        for (const MapAttribute attribute : attributes_)
            count += info(attribute).components;
        return count;
    }

    /// Refuses maps that do not fit in memory.
    void check_memory(std::size_t tiles) const {
        const double samples = double(texels_) * options_.subsamples * options_.subsamples;
        const double values = double(tiles) * double(texels_) * (4.0 * double(components()) + 1.0);
        const double open = std::min(double(tiles), std::ceil(double(most_open) / samples));
        const double bytes = values + open * (bytes_per_sample * samples + bytes_per_texel * double(texels_)) +
                             bytes_per_point * std::min(double(tiles) * samples, double(batch));
        if (bytes > memory_limit())
            throw LimitError(fmt::format("maps of {} x {} texels need about {} GB, over the limit of {} GB: choose a "
                                         "smaller --size or fewer --subsamples, or raise --max-memory",
                                         options_.width, options_.height, rounded(bytes / 1e9, 2),
                                         rounded(memory_limit() / 1e9, 2)));
    }

    UvTile tile_of(int udim) const {
        const int number = udim - first_udim, n = options_.subsamples;
        return {n * options_.width, n * options_.height, Vec2(number % udims_per_row, number / udims_per_row)};
    }

    /// Rasterizes a tile and adds its samples to the batch, which is baked when it is full.
    void add_tile(UvFaces& faces, int udim) {
        OpenTile tile{&faces, tile_of(udim), {}, {}};
        tile.owners = rasterize(faces.uvs(), tile.uvs);
        const std::size_t covered =
            tile.owners.size() - static_cast<std::size_t>(std::count(tile.owners.triangles.begin(),
                                                                     tile.owners.triangles.end(), no_triangle));
        if (options_.udim && covered == 0)
            return;
        if (sparse_error_ > 0.0f)
            tile.stride = stride_of_samples(covered, faces.uvs().size(), sparse_error_);
        const auto per_side = static_cast<std::size_t>(options_.subsamples);
        maps_.overlaps += tile.owners.overlaps / (per_side * per_side);
        tile.map.udim = udim;
        for (const MapAttribute attribute : attributes_)
            tile.map.layers.push_back({attribute, std::vector<float>(texels_ * info(attribute).components, 0.0f)});
        tile.counts.assign(texels_, 0);
        tile.wanted.assign(texels_, 0);
        tiles_.push_back(std::move(tile));
        const auto number = static_cast<std::uint32_t>(tiles_.size() - 1);
        if (tiles_[number].stride > 1)
            faces.add_charts();
        each_texel_in_blocks(tiles_[number].uvs, [&](std::size_t x, std::size_t y, int complete_rows) {
            OpenTile& open = tiles_[number];
            const std::size_t i = y * static_cast<std::size_t>(open.uvs.width) + x;
            if (open.owners.triangles[i] == no_triangle)
                return;
            open.wanted[texel_of(i)] = 1;
            if (open.stride > 1 && texels_around(open, x, y).any())
                return;
            if (samples_.size() == batch) {
                open.sampled_rows = complete_rows;
                bake_samples();
            }
            samples_.push_back({number, static_cast<std::uint32_t>(i)});
        });
        tiles_[number].sampled_rows = tiles_[number].uvs.height;
        // If no samples of earlier tiles are left, those tiles are complete.
        if (samples_.empty() || samples_.front().tile == number)
            finish_tiles(number);
        if ((tiles_.size() - finished_) * tiles_[number].owners.size() >= most_open)
            flush();
    }

    void flush() {
        if (!samples_.empty())
            bake_samples();
        finish_tiles(static_cast<std::uint32_t>(tiles_.size()));
    }

    /// Finishes the tiles with indices below `end`.
    void finish_tiles(std::uint32_t end) {
        for (; finished_ < end; ++finished_) {
            const TexelCounts counts = finish(tiles_[finished_], options_, has_tangents_);
            maps_.texels += counts.covered;
            maps_.misses += counts.missed;
            maps_.tiles.push_back(std::move(tiles_[finished_].map));
            tiles_[finished_] = OpenTile{};
        }
    }

    std::size_t texel_of(std::size_t sample) const {
        const auto n = static_cast<std::size_t>(options_.subsamples);
        return n == 1 ? sample : sample / (n * width_) / n * width_ + sample % (n * width_) / n;
    }

    void bake_samples() {
        std::vector<ProjectedTo> projected;
        if (projection_)
            projected = project_samples();
        const std::size_t sampled = samples_.size();
        std::size_t between = 0; // interpolated texels
        if (sampled > 0) {
            SurfacePoints points = projection_ ? points_of(projected) : points_of_samples();
            if (sparse_error_ > 0.0f)
                points.more = [&](std::span<const float> ao) { return interpolate(ao, between); };
            // In small maps, errors exceed what the pilot measures, as it sees few texels of each island.
            const bool is_dense = std::any_of(tiles_.begin() + static_cast<std::ptrdiff_t>(finished_), tiles_.end(),
                                              [](const OpenTile& tile) { return tile.stride > 1; });
            points.error_share = is_dense ? 1.0 : 0.93;
            Baked baked;
            if (!bake_.attributes.empty())
                baked = bake_points(surface(), points, bake_);
            for (std::size_t a = 0; a < attributes_.size(); ++a) {
                const MapAttribute attribute = attributes_[a];
                std::vector<float> values = attribute < MapAttribute::normal
                                                ? std::move(baked.values[static_cast<Channel>(attribute)])
                                                : values_of_surface(attribute, projected);
                if (info(attribute).is_direction)
                    turn_directions(values);
                const std::size_t components = info(attribute).components;
                for (std::size_t i = 0; i < samples_.size(); ++i) {
                    MapLayer& layer = tiles_[samples_[i].tile].map.layers[a];
                    for (std::size_t c = 0; c < components; ++c)
                        add(layer, components * texel_of(samples_[i].index) + c, values[components * i + c]);
                }
            }
            for (const Sample& sample : samples_)
                ++tiles_[sample.tile].counts[texel_of(sample.index)];
            merge(std::move(baked), sampled, samples_.size() - sampled, between);
        }
        samples_.clear();
        filled_ = 0;
    }

    /// Interpolates the texels between samples. `ao` contains the values of the samples. Texels whose neighbours differ
    /// are appended to the samples. \return the points of the new samples
    std::vector<SurfacePoint> interpolate(std::span<const float> ao, std::size_t& between) {
        const float tolerance = 2.0f * sparse_error_; // because noise makes neighbours differ, too
        for (std::size_t i = filled_; i < ao.size(); ++i)
            tiles_[samples_[i].tile].map.layers.front().values[samples_[i].index] = ao[i];
        filled_ = ao.size();
        const std::size_t sampled = samples_.size();
        for (auto number = static_cast<std::uint32_t>(finished_); number < tiles_.size(); ++number)
            if (tiles_[number].stride > 1)
                for (const std::uint32_t texel : interpolate_between(tiles_[number], tolerance, between))
                    samples_.push_back({number, texel});
        const SurfacePoints all = points_of_samples();
        std::vector<SurfacePoint> points;
        for (std::size_t i = sampled; i < samples_.size(); ++i)
            points.push_back(all.point(i));
        return points;
    }

    void add(MapLayer& layer, std::size_t at, float value) const {
        const bool is_sum = options_.subsamples > 1 && layer.attribute != MapAttribute::object;
        layer.values[at] = is_sum ? layer.values[at] + value : value;
    }

    SurfacePoints points_of_samples() const {
        return {samples_.size(),
                [this](std::size_t i) {
                    const auto [faces, triangle, weights] = place_of(samples_[i]);
                    return faces->point(triangle, weights);
                },
                [this](std::size_t i) {
                    const OpenTile& tile = tiles_[samples_[i].tile];
                    return tile.faces->face(tile.owners.triangles[samples_[i].index]);
                }};
    }

    static SurfacePoints points_of(const std::vector<ProjectedTo>& projected) {
        return {projected.size(), [&](std::size_t i) { return projected[i].point; },
                [&](std::size_t i) { return projected[i].point.face; }};
    }

    /// Projects the samples onto the high meshes. Drops samples that miss these meshes.
    std::vector<ProjectedTo> project_samples() {
        std::vector<ProjectedFrom> from(samples_.size());
        parallel_for(samples_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto [faces, triangle, weights] = place_of(samples_[i]);
                from[i] = faces->projected_from(triangle, weights, maps_.reach);
            }
        });
        std::vector<ProjectedTo> to = projection_->project(from, maps_.reach);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < to.size(); ++i)
            if (to[i].hit) {
                to[kept] = to[i];
                samples_[kept++] = samples_[i];
            }
        to.resize(kept);
        samples_.resize(kept);
        return to;
    }

    /// A point of a triangle.
    struct Place {
        const UvFaces* faces;
        std::uint32_t triangle;
        Vec3d weights;
    };
    Place place_of(const Sample& sample) const {
        const OpenTile& tile = tiles_[sample.tile];
        const std::uint32_t triangle = tile.owners.triangles[sample.index];
        return {tile.faces, triangle, weights_at(tile.faces->uvs()[triangle], tile.uvs, sample.index)};
    }

    std::vector<float> values_of_surface(MapAttribute attribute, const std::vector<ProjectedTo>& points) const {
        std::vector<float> values;
        for (const auto& [point, height, hit] : points) {
            if (attribute == MapAttribute::height)
                values.push_back(height);
            else if (attribute == MapAttribute::object)
                values.push_back(
                    1.0f + static_cast<float>(std::upper_bound(object_ends_.begin(), object_ends_.end(), point.face) -
                                              object_ends_.begin()));
            else
                for (int axis = 0; axis < 3; ++axis)
                    values.push_back(attribute == MapAttribute::normal ? point.normal[axis]
                                                                       : static_cast<float>(point.position[axis]));
        }
        return values;
    }

    /// Converts the directions of the samples to the axes that the options specify.
    void turn_directions(std::vector<float>& directions) const {
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            float* const d = &directions[3 * i];
            if (has_tangents_) {
                const Place place = place_of(samples_[i]);
                const Vec3 local = place.faces->to_tangent(place.triangle, place.weights, {d[0], d[1], d[2]});
                d[0] = local.x, d[1] = local.y, d[2] = local.z;
            }
            if (options_.flip_green)
                d[1] = -d[1];
        }
    }

    /// Keeps the description of the first batch, sums times and errors, and collects warnings. The bake was planned for
    /// `sampled` texels; afterwards, `more` texels were evaluated and `between` interpolated.
    void merge(Baked baked, std::size_t sampled, std::size_t more, std::size_t between) {
        const auto points = static_cast<double>(sampled + more + between);
        if (baked.rmse) {
            squares_ += *baked.rmse * *baked.rmse * points;
            error_weight_ += points;
        }
        evaluated_ += baked.evaluated * static_cast<double>(sampled) + static_cast<double>(more);
        points_ += points;
        if (points_ == points) {
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

    void warn() {
        std::vector<std::string> warnings;
        for (const UvFaces& faces : layouts_)
            for (std::string& warning : faces.warnings(options_.udim))
                warnings.push_back(std::move(warning));
        if (maps_.overlaps > 0)
            warnings.push_back(fmt::format("{} covered by several faces (overlapping UVs): the first face is baked "
                                           "there; unwrap without overlaps to give each face its own texels",
                                           counted(maps_.overlaps, "texel is", "texels are")));
        if (maps_.misses > 0)
            warnings.push_back(
                fmt::format("{} no high mesh within {:.4g} and got the values of neighbours: give a larger "
                            "--reach, and look at --miss-mask",
                            counted(maps_.misses, "texel has", "texels have"), maps_.reach));
        maps_.baked.warnings.insert(maps_.baked.warnings.begin(), warnings.begin(), warnings.end());
    }

    // Fixed, whatever memory is available: each batch is planned by itself, and the result must not depend on the
    // machine.
    static constexpr std::size_t batch = 1 << 23, most_open = 2 * batch; // samples in a batch; in open tiles

    const Mesh& mesh_;
    const MapOptions& options_;
    BakeOptions bake_;
    std::vector<UvFaces> layouts_;
    std::size_t width_, texels_; // width of the map; texels per tile
    std::vector<MapAttribute> attributes_;
    bool has_tangents_ = false; // whether directions are converted to tangent space
    std::optional<Mesh> high_;
    std::optional<Projection> projection_;
    std::vector<std::size_t> object_ends_; // the end of each high mesh in the faces of high_
    std::vector<OpenTile> tiles_;
    std::size_t finished_ = 0;   // number of finished tiles
    HugeVector<Sample> samples_; // of the batch
    std::size_t filled_ = 0;     // samples whose values interpolate() has stored
    BakedMaps maps_;
    float sparse_error_ = 0.0f; // RMSE of a map whose texels may be interpolated; 0: they may not
    double squares_ = 0.0, error_weight_ = 0.0, evaluated_ = 0.0, points_ = 0.0;
};

}

void check(const MapOptions& options) {
    const auto within = [](int value, int most) { return value >= 1 && value <= most; };
    if (!within(options.width, largest_map) || !within(options.height, largest_map))
        throw InputError(
            fmt::format("--size takes 1 to {} texels, not {} x {}", largest_map, options.width, options.height));
    if (!within(options.subsamples, most_subsamples) ||
        options.subsamples * std::max(options.width, options.height) > most_texels)
        throw InputError(fmt::format("--subsamples takes 1 to {}, and at most {} along a side of the map",
                                     most_subsamples, most_texels));
    if (options.margin && *options.margin < 0)
        throw InputError("--margin takes a number of texels, none or all");
    if (options.reach && !std::isfinite(options.reach->value))
        throw InputError("--reach takes a finite length");
    if (options.high.empty() && (!options.surface.empty() || options.reach || options.cage))
        throw InputError("normal, height, position and object come from a high mesh, and --reach and --cage apply only "
                         "to one: give --high");
    if (options.uv_set < 0)
        throw InputError("--uv-set takes a number, counted from 0");
}

BakedMaps bake_layouts(const Mesh& mesh, const BakeOptions& bake, const MapOptions& options,
                       std::span<const UvLayout> layouts) {
    const ThreadLimit limit(bake.threads);
    check(options);
    BakeOptions checked = bake;
    if (!options.surface.empty()) // maps of the surface need no other attribute
        checked.attributes = bake.attributes | Channel::ao;
    check(checked);
    return MapBake(mesh, bake, options, layouts).run();
}

BakedMaps bake_maps(const Mesh& mesh, const BakeOptions& bake, const MapOptions& options) {
    UvLayout layout{options.uv_set, {}};
    if (!bake.faces.empty())
        layout.wanted = select_faces(mesh, bake.faces).baked;
    return bake_layouts(mesh, bake, options, std::span(&layout, 1));
}

}
