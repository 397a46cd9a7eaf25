/// Measures the error of `calibrated` and writes docs/calibrated.md.
///
///     alcove_fit_report [PART...]
///
/// PART: generated parts of bench/make_parts.py, which are measured too. Takes a few minutes.
#include "meshes.h"

#include "alcove/measure/measure.h"
#include "alcove/mesh/files.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace alcove::fit {
namespace {

constexpr std::array radii{0.02f, 0.05f, 0.1f, 0.2f, 0.5f, std::numeric_limits<float>::infinity()};
constexpr std::array networks{13, 38, 63};
constexpr std::size_t reported_radius = 2; // of each mesh
constexpr std::size_t most_vertices = 1000;
constexpr int rays = 1024;

enum class Group { held_out, trained_on, parts };
constexpr std::array names{"held out", "trained on", "generated parts, never trained on"};

struct Errors {
    double deviation = 0.0;                                  ///< of the reference: the RMSE of the best constant
    std::array<double, networks.size()> trained{}, fitted{}; ///< RMSE of the networks, and of those fitted to the mesh
};

struct MeasuredFile {
    std::string name;
    Group group;
    std::array<Errors, radii.size()> at{};
};

MeasuredFile measured(const std::filesystem::path& path, Group group) {
    MeasuredFile file{path.filename().string(), group};
    const MeasuredMesh mesh(file.name, read_mesh(path.string()));
    for (std::size_t r = 0; r < radii.size(); ++r) {
        Truth truth = make_truth(mesh, radii[r], {.rays = rays, .most = most_vertices, .labels = labels_of_pilot});
        const MeasuredGrid grid = build_grid(mesh, radii[r], 0.0f);
        file.at[r].deviation = compare(truth.ao, truth.ao).deviation;
        const auto rmse = [&](std::size_t network) {
            return measure(mesh, truth, &grid, choose(find_method("calibrated"), networks[network])).error.rmse;
        };
        for (std::size_t n = 0; n < networks.size(); ++n)
            file.at[r].fitted[n] = rmse(n);
        truth.labels.reset();
        for (std::size_t n = 0; n < networks.size(); ++n)
            file.at[r].trained[n] = rmse(n);
    }
    return file;
}

std::string columns(const Errors& errors) {
    std::string text = fmt::format(" {:.4f} |", errors.deviation);
    for (const auto* const all : {&errors.trained, &errors.fitted})
        for (const double rmse : *all)
            text += fmt::format(" {:.4f} |", rmse);
    return text;
}

std::string report(const std::vector<MeasuredFile>& files) {
    std::string text = R"(# Error of the calibrated estimator

This page gives the RMSE of `calibrated` against 1,024 exact rays, at up to 1,000 vertices of each mesh, on the grids
that a bake uses by default. Columns such as *13 probes* are for the networks as they were trained. Columns such as
*13, fitted* are for networks whose last layer was fitted to the mesh, as in a bake with a pilot. Meshes of fewer than
200 vertices are not fitted. Half of the meshes of the archive, chosen by name, were held out from training. The
networks were trained on the other half and on 640 random scenes (fit/scenes.h). The errors that matter are those on the
held-out meshes and on the generated parts, which come from a different generator than the scenes. The standard
deviation of the reference is the RMSE of the best constant guess. All meshes have the same weight. To train the
networks and write this page:

    fit/fit_calibrated.sh

## Mean over the meshes

| meshes | radius | standard deviation of the reference | 13 probes | 38 probes | 63 probes | 13, fitted | 38, fitted | 63, fitted |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
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
                for (std::size_t n = 0; n < networks.size(); ++n) {
                    mean.trained[n] += file.at[r].trained[n];
                    mean.fitted[n] += file.at[r].fitted[n];
                }
            }
            if (count == 0)
                continue;
            mean.deviation /= count;
            for (auto* const all : {&mean.trained, &mean.fitted})
                for (double& rmse : *all)
                    rmse /= count;
            text +=
                fmt::format("| {} {} | {} |{}\n", count, names[group],
                            std::isinf(radii[r]) ? "inf" : fmt::format("{:.3g} %", 100.0 * radii[r]), columns(mean));
        }
    text += fmt::format("\n## Each mesh, radius {:.3g} %\n\n", 100.0 * radii[reported_radius]);
    text += "| mesh | group | standard deviation of the reference | 13 probes | 38 probes | 63 probes | 13, fitted | "
            "38, fitted | 63, fitted |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
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
