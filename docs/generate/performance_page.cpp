// Writes docs/performance.md: where the time of a bake goes, compared with its budget, its peers and simple baselines,
// and how it scales.
//
//     alcove_performance_page <folder of meshes> <docs folder>
#include "bakes.h"
#include "floors.h"
#include "page.h"
#include "timing.h"

#include "openvdb_peer.h"

#include "alcove/measure/detail/chart.h"

#include <alcove/alcove.h>

#include <fmt/format.h>

#include <unistd.h>

#include <array>

namespace alcove::docs {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view head = R"(# Where the time goes

Written by `tools/docs.sh performance`, on one thread: do not edit. Times are CPU seconds. Figures that are compared
with each other are medians of five measurements, taken in turns. The times of phases are wall-clock times of the median
of five bakes (of three in the last section). The machine is shared and its clock rate drifts: trust only ratios.
Lengths are fractions of the diagonal. The meshes are armadillo.off and versions of it with each triangle split into
four, up to three times. Where errors are measured, the vertices are also moved along their normals by noise that is one
mean edge high.

)";

std::string thousands(std::size_t count) {
    return fmt::format("{} k", (count + 500) / 1000);
}

std::string milliseconds(double seconds) {
    return fmt::format("{:.0f}", 1e3 * seconds);
}

/// Seconds that each phase of a bake of the densest mesh may take at an RMSE of 0.05. The goal is a quarter of the time
/// of Embree alone.
constexpr std::array<std::pair<std::string_view, double>, 5> budget{
    {{"start", 0.010}, {"read", 0.040}, {"grid", 0.130}, {"occlusion", 0.080}, {"write", 0.040}}};

std::string phases_table(const std::vector<Bake>& bakes) {
    std::string text = "| phase | budget, ms |", rule = "| --- | --- |";
    for (const Bake& bake : bakes) {
        text += fmt::format(" {} |", bake.choice.text());
        rule += " --- |";
    }
    text += "\n" + rule + "\n";
    for (const auto& [phase, allowed] : budget) {
        text += fmt::format("| {} | {} |", phase, milliseconds(allowed));
        for (const Bake& bake : bakes)
            text += fmt::format(" {} |", milliseconds(bake.phases.at(std::string(phase))));
        text += "\n";
    }
    return text;
}

constexpr std::string_view file_to_file_words = R"(## From file to file

The table compares `alcove bake` on binary PLY, at a radius of 10 %, with a baker that uses Embree alone. That baker has
the same reader and writer, builds its BVH with low quality, traces streams of rays, and visits vertices along a Morton
curve. Each uses settings that meet an RMSE of E: ours are the cheapest of a few measured choices, without the pilot;
Embree alone gets as many rays as it needs. The column `--error E` gives the time of a bake that chooses its settings
itself and measures its error.

| vertices | E | ours | RMSE | s | `--error E`, s | Embree, rays | RMSE | s | Embree : ours |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
{}
This table shows the phases of our bakes of the largest mesh. The budget applies to the first of these bakes; the goal
is a quarter of the time of Embree alone. Most of the start is spent in the dynamic linker, on the symbols of OpenVDB.
Where dozens of triangles share a voxel, the grid is built from clustered vertices, which are as dense as the voxels can
resolve.

{}
)";

std::string file_to_file_section(const std::vector<fs::path>& files) {
    std::string rows, phases;
    for (const fs::path& file : files) {
        const MeasuredChoices choices(file);
        std::vector<Bake> bakes;
        for (const double error : {0.05, 0.02, 0.005}) {
            const Comparison c = choices.compare(error);
            rows += fmt::format("| {} | {} | {} | {:.4f} | {:.3f} | {:.3f} | {} | {:.4f} | {:.3f} | {:.2f} |\n",
                                thousands(choices.vertices()), error, c.ours.choice.text(), c.ours.choice.rmse,
                                c.ours.seconds, c.planned_seconds, c.rays, c.plain_rmse, c.plain_seconds,
                                c.plain_seconds / c.ours.seconds);
            bakes.push_back(c.ours);
            std::cerr << file.filename().string() << " " << error << "\n";
        }
        phases = phases_table(bakes);
    }
    return fmt::format(file_to_file_words, rows, phases);
}

VoxelizeOptions one_level(double voxels) {
    VoxelizeOptions options;
    options.grid.voxel = static_cast<float>(1.0 / voxels);
    options.grid.outer_band = options.grid.inner_band = 5.0f;
    options.grid.radius = 4.0f * options.grid.voxel;
    return options;
}

std::string voxelizing_section() {
    std::string rows;
    for (const std::int64_t level : {0, 1, 2}) {
        const Scan& s = scan(level);
        const OpenVdbMesh mesh(s);
        for (const double voxels : {128.0, 256.0}) {
            const VoxelizeOptions finest = one_level(voxels);
            VoxelizeOptions far = finest;
            far.grid.radius = 0.5f;
            const auto ours = [&](const VoxelizeOptions& options) {
                return warm_cpu_seconds_of([&] { voxelize(s.mesh, s.triangles, options); });
            };
            const auto t = medians({[&] { return ours(finest); }, [&] { return ours(far); },
                                    [&] {
                                        return warm_cpu_seconds_of([&] {
                                            openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
                                                *openvdb::math::Transform::createLinearTransform(1.0 / voxels),
                                                mesh.points, mesh.triangles, 5.0f);
                                        });
                                    }});
            const std::size_t active = voxelize(s.mesh, s.triangles, finest).levels.front().active_voxels;
            rows += fmt::format("| {} | {} | {} | {} | {:.0f} | {:.0f} | {:.1f} | {:.2f} |\n",
                                thousands(s.triangles.size()), voxels, milliseconds(t[0]), milliseconds(t[2]),
                                1e9 * t[0] / static_cast<double>(s.triangles.size()),
                                1e9 * t[0] / static_cast<double>(active), t[2] / t[0], t[1] / t[0]);
            std::cerr << "voxelizing " << s.triangles.size() << " " << voxels << "\n";
        }
    }
    return fmt::format(R"(## Voxelizing

The table gives the time to convert an indexed mesh to an OpenVDB level set with a band of 5 voxels on both sides,
compared with `openvdb::tools::meshToVolume` with its default flags. The last column gives the time for all levels at a
radius of 50 %, relative to that for the finest level alone.

| triangles | voxels along D | ms | meshToVolume, ms | ns per triangle | ns per voxel | meshToVolume : ours | all levels : finest |
| --- | --- | --- | --- | --- | --- | --- | --- |
{}
)",
                       rows);
}

std::string scaling_table(std::string_view variable, const std::vector<std::pair<std::string, Bake>>& bakes) {
    std::string rows;
    for (const auto& [name, bake] : bakes)
        rows += fmt::format("| {} | {} | {} | {} | {} | {:.2f} |\n", name, milliseconds(bake.phases.at("read")),
                            milliseconds(bake.phases.at("grid")), milliseconds(bake.phases.at("occlusion")),
                            milliseconds(bake.phases.at("write")), static_cast<double>(bake.peak_rss_bytes) / 1e9);
    return fmt::format("| {} | read | grid | occlusion | write | peak, GB |\n| --- | --- | --- | --- | --- | --- "
                       "|\n{}\n",
                       variable, rows);
}

std::string scaling_section(const fs::path& scratch, const fs::path& images) {
    const Choice calibrated{choose(find_method("calibrated"), 13), 1.0f / 256.0f, 0.0};
    std::vector<std::pair<std::string, Bake>> by_triangles, by_voxel, by_radius;
    Chart chart{"triangles", "seconds", {}, {}};
    for (const std::string_view phase : {"read", "grid", "occlusion", "write"})
        chart.series.push_back({std::string(phase), chart.series.size(), true});
    Mesh mesh = scan(0).mesh;
    const fs::path file = scratch / "growing.ply", middle = scratch / "middle.ply";
    for (int level = 0; level <= 3; ++level) {
        write_mesh(mesh, file);
        if (level == 1)
            fs::copy_file(file, middle);
        const std::size_t triangles = mesh.face_count();
        by_triangles.emplace_back(thousands(triangles), bake_median(file, calibrated, 0.1));
        for (ChartSeries& series : chart.series)
            series.points.push_back(
                {static_cast<double>(triangles), by_triangles.back().second.phases.at(series.name), "", ""});
        if (level < 3)
            mesh = subdivided(mesh);
    }
    for (const double voxels : {64.0, 128.0, 256.0, 512.0, 1024.0})
        by_voxel.emplace_back(fmt::format("{}", voxels),
                              bake_median(middle, {calibrated.method, static_cast<float>(1.0 / voxels), 0.0}, 0.1));
    for (const double radius : {0.02, 0.1, 0.5, 1.0})
        by_radius.emplace_back(fmt::format("{:.0f} %", 100.0 * radius), bake_median(middle, calibrated, radius));
    std::cerr << "scaling\n";
    write_text(images / "triangles.svg", svg(chart) + "\n");
    return fmt::format(R"(## Scaling

The tables give the milliseconds of each phase with calibrated:13. The voxel is 1/256 and the radius 10 %, unless the
first column says otherwise. There are half as many vertices as triangles.

{}![seconds by triangles](images/performance/triangles.svg)

With 208 k triangles:

{}{})",
                       scaling_table("triangles", by_triangles), scaling_table("voxels along D", by_voxel),
                       scaling_table("radius", by_radius));
}

std::string twelve_million_section(const fs::path& folder, const fs::path& scratch) {
    Mesh mesh = read_mesh(folder / "diplodocus.off");
    for (int level = 0; level < 4; ++level)
        mesh = subdivided(mesh);
    const fs::path file = scratch / "large.ply", baked = scratch / "large_ao.ply";
    write_mesh(displaced(std::move(mesh)), file);
    const Run bake = run({ALCOVE_PROGRAM, "bake", file, "-o", baked, "--threads", "1", "--error", "0.05", "--json"});
    return fmt::format(R"(## Twelve million triangles

This bake has `--error 0.05`. Its mesh is diplodocus.off, with each triangle split into four, four times over, and its
vertices moved by noise. It took {}.

)",
                       outcome_of(bake));
}

/// A temporary folder, removed on destruction.
struct Scratch {
    fs::path folder = fs::temp_directory_path() / fmt::format("alcove-performance-{}", ::getpid());

    Scratch() { fs::create_directories(folder); }
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
};

void write_page(const fs::path& folder, const fs::path& docs) {
    const ThreadLimit one_thread(1);
    const fs::path images = docs / "images" / "performance";
    const Scratch scratch;
    fs::create_directories(images);
    std::vector<fs::path> files;
    for (const std::int64_t level : {0, 1, 2}) {
        files.push_back(scratch.folder / fmt::format("noisy_{}.ply", level));
        write_mesh(displaced(scan(level).mesh), files.back());
    }
    std::string text(head);
    text += file_to_file_section(files);
    text += voxelizing_section();
    text += baselines_section(files.back());
    text += twelve_million_section(folder, scratch.folder);
    text += scaling_section(scratch.folder, images);
    write_text(docs / "performance.md", text);
}

}
}

int main(int argc, char** argv) {
    return alcove::docs::run_page(argc, argv, alcove::docs::write_page);
}
