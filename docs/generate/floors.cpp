#include "floors.h"

#include "dense_array.h"
#include "probe_batches.h"
#include "scan.h"
#include "timing.h"

#include <fmt/format.h>

#include <alcove/alcove.h>

#include <cstring>
#include <fstream>

namespace alcove::docs {
namespace {

constexpr float voxel = 1.0f / 128.0f;
constexpr int probes = 5;

std::string row(std::string_view operation, double baseline, double ours) {
    return fmt::format("| {} | {:.3g} | {:.3g} | {:.2f} |\n", operation, baseline, ours, ours / baseline);
}

/// CPU seconds of five probes above each surfel.
template <class Sample>
double seconds_of_probes(const std::vector<Surfel>& surfels, const Sample& sample) {
    return warm_cpu_seconds_of([&] {
        probe_batches(surfels, probes, 0.8f * voxel, sample,
                      [](const SurfelBatch::Values& values, std::size_t) { benchmark::DoNotOptimize(values); });
    });
}

std::string files_row(const std::filesystem::path& file) {
    const std::filesystem::path copy = std::filesystem::path(file).replace_extension(".copy.ply");
    std::vector<char> bytes(std::filesystem::file_size(file));
    Mesh mesh;
    const auto t = medians(
        {[&] {
             return warm_cpu_seconds_of([&] {
                 std::ifstream(file, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
             });
         },
         [&] { return warm_cpu_seconds_of([&] { mesh = read_mesh(file); }); },
         [&] {
             return warm_cpu_seconds_of([&] {
                 std::ofstream(copy, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
             });
         },
         [&] { return warm_cpu_seconds_of([&] { write_mesh(mesh, copy); }); }});
    const double nanoseconds = 1e9 / static_cast<double>(bytes.size());
    return row("reading binary PLY, ns per byte, against reading the bytes alone", nanoseconds * t[0],
               nanoseconds * t[1]) +
           row("writing binary PLY, ns per byte, against writing the bytes alone", nanoseconds * t[2],
               nanoseconds * t[3]);
}

std::string map_row() {
    const Scan& s = scan(1);
    const GridStack stack = voxelize(s.mesh, s.triangles, {.grid = {.radius = 4.0f * voxel, .voxel = voxel}});
    const LevelStack field(stack);
    std::vector<Surfel> surfels;
    for (const std::uint32_t i : spatial_order(s.surfels))
        surfels.push_back(s.surfels[i]);
    const DenseArray dense;
    const auto fetch = [&](const Points& points, float* values) {
        for (std::size_t i = 0; i < points.count; ++i)
            values[i] = dense.at((points[i] + 0.5f) / voxel);
    };
    const auto map = [&](const Points& points, float* values) { field.map(points, 4.0f * voxel, values); };
    const auto t =
        medians({[&] { return seconds_of_probes(surfels, fetch); }, [&] { return seconds_of_probes(surfels, map); }});
    const double nanoseconds = 1e9 / (static_cast<double>(surfels.size()) * probes);
    return row("map() near a surface, ns, against a trilinear fetch from a dense array", nanoseconds * t[0],
               nanoseconds * t[1]);
}

std::string grid_row() {
    const Scan& s = scan(2);
    const VoxelizeOptions options{.grid = {.radius = 4.0f / 256.0f, .voxel = 1.0f / 256.0f}};
    const std::size_t bytes = voxelize(s.mesh, s.triangles, options).bytes();
    // The input, positions and triangles, is copied and memory for the grid is allocated.
    std::vector<char> from(s.mesh.positions.size() * sizeof(Vec3d) + s.triangles.size() * sizeof(Triangle), 1);
    const auto t = medians({[&] {
                                return warm_cpu_seconds_of([&] {
                                    std::vector<char> to(from.size() + bytes);
                                    std::memcpy(to.data(), from.data(), from.size());
                                    benchmark::DoNotOptimize(to.data());
                                });
                            },
                            [&] {
                                return warm_cpu_seconds_of(
                                    [&] { benchmark::DoNotOptimize(voxelize(s.mesh, s.triangles, options)); });
                            }});
    const double nanoseconds = 1e9 / static_cast<double>(s.triangles.size());
    return row("voxelizing 832 k triangles at 1/256, ns per triangle, against copying the input and output",
               nanoseconds * t[0], nanoseconds * t[1]);
}

}

std::string baselines_section(const std::filesystem::path& file) {
    return fmt::format("## Baselines\n\n| operation | baseline | ours | ratio |\n| --- | --- | --- | --- |\n{}{}{}\n",
                       files_row(file), map_row(), grid_row());
}

}
