#include "bake_job.h"

#include "ending.h"
#include "inputs.h"
#include "weld.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/mesh/detail/join.h"
#include "alcove/mesh/detail/tessellate.h"
#include "alcove/mesh/files.h"
#include "alcove/vdb/vdb_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace alcove::cli {
namespace {

std::string rmse_text(const Baked& baked) {
    constexpr double resolution = 1e-3; // smallest error that is shown as measured
    if (!baked.rmse)
        return "";
    return *baked.rmse < resolution ? fmt::format(", RMSE below {}", resolution)
                                    : fmt::format(", RMSE about {:.2g}", *baked.rmse);
}

std::string evaluated_text(const Baked& baked) {
    return baked.evaluated < 1.0 ? fmt::format(" at {:.2g} % of them, the others interpolated", 100.0 * baked.evaluated)
                                 : "";
}

/// How the values were computed, and their error.
std::string method_text(const Baked& baked) {
    return fmt::format(" by {}{}, radius {:.4g}, {}{}{}", baked.method, evaluated_text(baked), baked.radius,
                       baked.grid_summary.text(), rmse_text(baked),
                       baked.reason.empty() ? "" : fmt::format(" (no grid used: {})", baked.reason));
}

/// Handles one input, from reading the mesh to printing the result.
class BakeJob {
  public:
    BakeJob(const BakeVerb& verb, const BatchFile& file) : verb_(verb), file_(file) {}

    void run(const BakeProgress& progress) {
        BakeOptions options = verb_.bake;
        options.progress = progress;
        if (const std::optional<double> left = seconds_left())
            options.time_limit = left;
        Stopwatch watch;
        read(options);
        seconds_["read"] = watch.lap();
        const bool into_texture = verb_.map.into_texture, into_map = !into_texture && is_map(file_.output);
        OcclusionTextures textures;
        BakedMaps map;
        Baked at_vertices;
        if (into_texture)
            textures = bake_occlusion_textures(mesh_, options, verb_.map.map, verb_.map.packing());
        else if (into_map)
            map = bake_maps(mesh_, options, map_options());
        else
            at_vertices = bake(mesh_, options);
        const BakedMaps* const maps = into_texture ? &textures.maps : into_map ? &map : nullptr;
        const Baked& baked = maps ? maps->baked : at_vertices;
        seconds_["grid"] = baked.seconds.grid;
        seconds_["occlusion"] = baked.seconds.occlusion;
        seconds_["pilot"] = baked.seconds.pilot;
        if (verb_.strict && baked.missed())
            throw std::runtime_error(
                fmt::format("{}: misses the error target of {:g}: the measured RMSE is {:.2g}, and nothing is written",
                            file_.input, *baked.target, *baked.rmse));
        watch.lap();
        if (into_texture)
            warnings_ = write_occlusion_textures(mesh_, textures, file_.output);
        else if (into_map)
            write(map);
        else
            write(baked);
        seconds_["write"] = watch.lap();
        warnings_.insert(warnings_.begin(), baked.warnings.begin(), baked.warnings.end());
        warnings_.insert(warnings_.begin(), mesh_.warnings.begin(), mesh_.warnings.end());
        warnings_.insert(warnings_.begin(), grid_.warnings.begin(), grid_.warnings.end());
        for (const std::string& warning : warnings_)
            print_warnings({verb_.inputs.size() > 1 ? fmt::format("{}: {}", file_.input, warning) : warning},
                           verb_.common);
        print(baked, maps);
    }

  private:
    MapOptions map_options() const {
        MapOptions options = verb_.map.map;
        options.udim = file_.output.find("<UDIM>") != std::string::npos;
        for (const std::string& high : verb_.map.high) {
            options.high.push_back(is_grid(high) ? surface_of(read_grids(high), high) : with_surface(read_mesh(high)));
            for (const std::string& warning : options.high.back().warnings)
                print_warnings({fmt::format("{}: {}", high, warning)}, verb_.common);
        }
        if (!verb_.map.cage.empty())
            options.cage = read_mesh(verb_.map.cage);
        return options;
    }

    void read(BakeOptions& options) {
        if (is_grid(file_.input)) {
            grid_ = read_grids(file_.input, {verb_.grid_names});
            mesh_ = surface_of(grid_, file_.input, verb_.adaptivity);
        } else {
            mesh_ = read_mesh(file_.input);
            if (options.weld)
                check_has_faces(mesh_, file_.input, "--weld");
            if (!verb_.tessellate.empty())
                check_has_faces(mesh_, file_.input, "--tessellate");
            if (options.weld && mesh_.format == "STL") // reading an STL joins its vertices anyway
                mesh_ = join_vertices(mesh_, *std::exchange(options.weld, std::nullopt)).mesh;
            if (!verb_.grid.empty())
                grid_ = read_grids(verb_.grid, {verb_.grid_names});
        }
        if (mesh_.face_count() == 0 && is_gltf(file_.output))
            throw InputError(fmt::format("{}: points are not written as glTF: write a .ply", file_.input));
        if (!grid_.levels.empty())
            options.grid = &grid_;
        if (verb_.tessellate == "auto")
            mesh_ = tessellate_for_ao(mesh_, options);
        else if (!verb_.tessellate.empty()) {
            const double diagonal = frame_of(mesh_.box()).diagonal;
            mesh_ = tessellate(mesh_, {.longest = Length(verb_.tessellate).to_unit(diagonal) * diagonal});
        }
    }

    void write(const Baked& baked) {
        if (!verb_.write_grid.empty())
            write_grids(baked.grid, verb_.write_grid);
        if (!add(mesh_, baked, verb_.add) && extension(file_.output) == ".obj")
            throw UsageError(file_.output +
                             ": an .obj can store ao only as colours, but the input has its own: add --color "
                             "ao to replace them, or write a .ply");
        warnings_ = write_mesh(mesh_, file_.output);
    }

    void write(const BakedMaps& maps) const {
        write_maps(maps, file_.output, verb_.map.files);
        if (!verb_.map.miss_mask.empty())
            write_miss_mask(maps, verb_.map.miss_mask);
    }

    std::size_t baked_vertices(const Baked& baked) const {
        return baked.selected.empty()
                   ? mesh_.vertex_count()
                   : static_cast<std::size_t>(std::count(baked.selected.begin(), baked.selected.end(), 1));
    }

    void print(const Baked& baked, const BakedMaps* maps) const {
        const auto or_null = [](bool there, const auto& value) {
            return there ? nlohmann::ordered_json(value) : nullptr;
        };
        const GridSummary& grid = baked.grid_summary;
        nlohmann::ordered_json size;
        if (maps)
            size = {maps->width, maps->height};
        if (verb_.common.json)
            print_json({{"input", file_.input},
                        {"output", file_.output},
                        {"vertices", mesh_.vertex_count()},
                        {"faces", mesh_.face_count()},
                        {"size", size},
                        {"texels", or_null(maps != nullptr, maps ? maps->texels : 0)},
                        {"overlaps", or_null(maps != nullptr, maps ? maps->overlaps : 0)},
                        {"misses", or_null(maps != nullptr && maps->reach > 0.0, maps ? maps->misses : 0)},
                        {"reach", or_null(maps != nullptr && maps->reach > 0.0, maps ? maps->reach : 0.0)},
                        {"attributes", maps ? attributes_of(*maps) : names_of(baked.attributes)},
                        {"method", or_null(!baked.method.empty(), baked.method.substr(0, baked.method.find(':')))},
                        {"samples", or_null(baked.samples.has_value(), baked.samples.value_or(0))},
                        {"evaluated", baked.evaluated},
                        {"reason", or_null(!baked.reason.empty(), baked.reason)},
                        {"radius", baked.radius},
                        {"voxel", or_null(grid.levels > 0, grid.voxel)},
                        {"levels", grid.levels},
                        {"sign", or_null(grid.levels > 0, name_of(grid.sign))},
                        {"clustered", or_null(grid.levels > 0, grid.clustered)},
                        {"grid_bytes", grid.bytes},
                        {"estimated_rmse", or_null(baked.rmse.has_value(), baked.rmse.value_or(0.0))},
                        {"seconds", seconds_},
                        {"peak_rss_bytes", peak_resident_bytes()},
                        {"warnings", warnings_}},
                       verb_.inputs.size() > 1);
        else if (!verb_.common.quiet)
            say(fmt::format(
                "{}: {}{}", file_.output,
                maps ? summary_of(*maps)
                     : fmt::format("{} of {} vertices", names_of(baked.attributes), grouped(baked_vertices(baked))),
                baked.method.empty() ? "" : method_text(baked)));
    }

    const BakeVerb& verb_;
    const BatchFile& file_;
    Mesh mesh_;
    GridStack grid_;
    nlohmann::ordered_json seconds_;
    std::vector<std::string> warnings_;
};

}

void bake_file(const BakeVerb& verb, const BatchFile& file, const BakeProgress& progress) {
    BakeJob(verb, file).run(progress);
}

}
