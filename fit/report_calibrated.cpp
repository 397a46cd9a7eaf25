/// Measures the error of `calibrated` and writes docs/calibrated.md.
///
///     alcove_fit_report [PART...]
///
/// PART: generated parts of bench/make_parts.py, which are measured too. Takes a few minutes.
#include "meshes.h"

#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/methods/calibrated.h"
#include "alcove/occlusion/methods/exact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>

namespace alcove::fit {
namespace {

constexpr std::array radii{0.02f, 0.05f, 0.1f, 0.2f, 0.5f, std::numeric_limits<float>::infinity()};
constexpr std::array networks{13, 38, 63};
constexpr std::size_t reported_radius = 2; // of each mesh
constexpr std::size_t most_surfels = 1000;
constexpr int rays = 1024;

enum class Group { held_out, trained_on, parts };
constexpr std::array names{"held out", "trained on", "generated parts, never trained on"};

struct Errors {
    double deviation = 0.0; ///< of the reference: the RMSE of the best constant
    std::array<double, networks.size()> rmse{};
};

struct MeasuredFile {
    std::string name;
    Group group;
    std::array<Errors, radii.size()> at{};
};

MeasuredFile measured(const std::filesystem::path& path, Group group) {
    MeasuredFile file{path.filename().string(), group};
    const Mesh mesh = read_mesh(path.string());
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    const std::vector<Surfel> all = make_surfels(mesh, triangles, frame);
    std::vector<Surfel> surfels;
    const std::size_t count = std::min(most_surfels, all.size());
    for (std::size_t i = 0; i < count; ++i)
        if (const Surfel& surfel = all[i * all.size() / count]; surfel.has_normal())
            surfels.push_back(surfel);
    std::vector<Vec3> positions;
    for (const Vec3d& p : mesh.positions)
        positions.push_back(frame.to_unit(p));
    const RaySurface surface(positions, triangles);
    const auto size = static_cast<double>(surfels.size());
    for (std::size_t r = 0; r < radii.size(); ++r) {
        const std::vector<float> truth = evaluate_ao(surfels, surface, Exact{.radius = radii[r], .rays = rays});
        double sum = 0.0, squares = 0.0;
        for (const double ao : truth)
            sum += ao, squares += ao * ao;
        file.at[r].deviation = std::sqrt(std::max(squares / size - sum / size * sum / size, 0.0));
        const float probed = std::min(radii[r], 1.0f);
        const LevelStack field(voxelize(mesh, triangles, {.grid = {.radius = probed}}));
        for (std::size_t n = 0; n < networks.size(); ++n) {
            const std::vector<float> ao = evaluate_ao(surfels, field, Calibrated{probed, networks[n]});
            double error = 0.0;
            for (std::size_t i = 0; i < ao.size(); ++i)
                error += (double(ao[i]) - truth[i]) * (double(ao[i]) - truth[i]);
            file.at[r].rmse[n] = std::sqrt(error / size);
        }
    }
    return file;
}

std::string columns(const Errors& errors) {
    std::string text = fmt::format(" {:.4f} |", errors.deviation);
    for (const double rmse : errors.rmse)
        text += fmt::format(" {:.4f} |", rmse);
    return text;
}

std::string report(const std::vector<MeasuredFile>& files) {
    std::string text = R"(# Error of the calibrated estimator

The RMSE against 1,024 exact rays, at up to 1,000 vertices of each mesh, on the grids that a bake uses by default. Half
of the meshes of the archive, chosen by name, were held out from training: their errors are the ones that matter, and
those on generated parts. The standard deviation of the reference is the RMSE of the best constant. All meshes have the
same weight. To train the networks and write this page:

    fit/fit_calibrated.sh

## Mean over the meshes

| meshes | radius | standard deviation of the reference | 13 probes | 38 probes | 63 probes |
| --- | --- | --- | --- | --- | --- |
)";
    for (std::size_t group = 0; group < names.size(); ++group)
        for (std::size_t r = 0; r < radii.size(); ++r) {
            Errors mean;
            int count = 0;
            for (const MeasuredFile& file : files) {
                if (file.group != static_cast<Group>(group))
                    continue;
                ++count;
                mean.deviation += file.at[r].deviation;
                for (std::size_t n = 0; n < networks.size(); ++n)
                    mean.rmse[n] += file.at[r].rmse[n];
            }
            if (count == 0)
                continue;
            mean.deviation /= count;
            for (double& rmse : mean.rmse)
                rmse /= count;
            text += fmt::format("| {} {} | {:.3g} % |{}\n", count, names[group], 100.0 * radii[r], columns(mean));
        }
    text += fmt::format("\n## Each mesh, radius {:.3g} %\n\n", 100.0 * radii[reported_radius]);
    text += "| mesh | | standard deviation of the reference | 13 probes | 38 probes | 63 probes |\n"
            "| --- | --- | --- | --- | --- | --- |\n";
    for (const MeasuredFile& file : files)
        text += fmt::format("| {} | {} |{}\n", file.name, names[static_cast<std::size_t>(file.group)],
                            columns(file.at[reported_radius]));
    return text;
}

void run(std::span<char*> parts) {
    std::vector<MeasuredFile> files;
    for (const MeshFile& file : split_meshes(std::string(ALCOVE_TREE) + "/build/meshes/meshes"))
        files.push_back(measured(file.path, file.fitted ? Group::trained_on : Group::held_out));
    for (const char* part : parts)
        files.push_back(measured(part, Group::parts));
    std::ofstream page(std::string(ALCOVE_TREE) + "/docs/calibrated.md");
    page << report(files);
    if (!page.flush())
        throw std::runtime_error("cannot write docs/calibrated.md");
}

}
}

int main(int argc, char** argv) {
    try {
        alcove::fit::run(std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
        return EXIT_SUCCESS;
    } catch (const std::exception& failure) {
        fmt::print(stderr, "alcove_fit_report: {}\n", failure.what());
        return EXIT_FAILURE;
    }
}
