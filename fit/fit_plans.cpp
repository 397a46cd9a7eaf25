/// Measures the errors and costs by which the planner chooses, and writes the table that is compiled into the library.
/// Uses the meshes on which calibrated is trained, and two finer meshes for costs only.
///
///     cmake --build build --target alcove_fit_plans && build/fit/alcove_fit_plans
///
/// Run this program in a checkout where tools/setup.sh has unpacked the meshes; it takes a few minutes on one core. The
/// costs depend on the machine, but plans depend only on ratios of costs.
#include "meshes.h"

#include "alcove/bake/detail/pilot.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/measure/measure.h"
#include "alcove/mesh/files.h"
#include "subdivided.h"

#include <Eigen/QR>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>

namespace alcove::fit {
namespace {

constexpr std::array<float, 6> radii{0.02f, 0.05f, 0.1f, 0.2f, 0.5f, std::numeric_limits<float>::infinity()};
constexpr std::array<float, 2> largest_voxels{1.0f / 64.0f, 1.0f / 256.0f};
constexpr std::array<std::pair<std::string_view, int>, 15> methods{{{"guided", 1},
                                                                    {"guided", 2},
                                                                    {"guided", 3},
                                                                    {"guided", 4},
                                                                    {"guided", 6},
                                                                    {"guided", 8},
                                                                    {"guided", 11},
                                                                    {"guided", 16},
                                                                    {"guided", 22},
                                                                    {"guided", 32},
                                                                    {"guided", 45},
                                                                    {"guided", 64},
                                                                    {"calibrated", 13},
                                                                    {"calibrated", 38},
                                                                    {"calibrated", 63}}};
constexpr TruthOptions truth_options{.rays = 512, .most = 4000, .labels = labels_of_pilot};
constexpr double min_deviation = 0.01;     // smallest deviation of a truth for which errors count
constexpr std::size_t min_vertices = 2000; // smallest mesh for which seconds per vertex count
constexpr int rays_timed = 64;
constexpr double reference_doublings = 17.0; // log2 of the number of triangles for which ray costs are given

/// Errors and costs of one method on all meshes.
struct MethodFigures {
    std::array<std::vector<double>, radii.size()> error_per_difficulty{};
    std::vector<double> seconds_per_surfel{};
};

struct Costs {
    std::vector<std::array<double, 4>> grid{};    // triangles voxelized and left out, cells, seconds
    std::vector<std::pair<double, double>> bvh{}; // triangles, seconds
    std::array<std::vector<std::pair<double, double>>, radii.size()> rays{}; // triangles, seconds per ray
};

/// The cost of a ray in a mesh of `triangles` triangles, relative to a ray in a mesh of 2^reference_doublings
/// triangles.
double relative_ray_cost(double triangles, double slower_per_doubling) {
    return std::max(1.0 + slower_per_doubling * (std::log2(triangles) - reference_doublings), 0.3);
}

double median_of(std::vector<double> values) {
    if (values.empty())
        return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Collects measurements, mesh by mesh, and writes the table.
class PlanTable {
  public:
    void add(const MeasuredMesh& mesh, bool errors_count) {
        const auto triangles = static_cast<double>(mesh.triangles.size());
        const double area = surface_size(mesh.mesh, mesh.triangles).area;
        costs_.bvh.emplace_back(triangles, mesh.tree_seconds);
        for (std::size_t r = 0; r < radii.size(); ++r) {
            const Truth truth = make_truth(mesh, radii[r], truth_options);
            Truth unlabelled = truth;
            unlabelled.labels.reset();
            const Pilot pilot(mesh.surfels, mesh.rays, radii[r]);
            const Measurement exact = measure(mesh, truth, nullptr, choose(find_method("exact"), rays_timed));
            const double ray = exact.occlusion_seconds / (static_cast<double>(mesh.order.size()) * rays_timed);
            if (mesh.order.size() >= min_vertices)
                costs_.rays[r].emplace_back(triangles, ray);
            for (std::size_t v = 0; v < largest_voxels.size(); ++v) {
                const MeasuredGrid grid = build_grid(mesh, radii[r], chosen_voxel(radii[r], largest_voxels[v]));
                const double voxel = grid.field.resolution();
                const double voxelized = triangles_voxelized(area, mesh.triangles.size(), voxel, {.cluster = true});
                costs_.grid.push_back({voxelized, triangles - voxelized, area / (voxel * voxel), grid.seconds});
                for (std::size_t m = 0; m < methods.size(); ++m) {
                    const Measurement measured =
                        measure(mesh, truth, &grid, choose(find_method(methods[m].first), methods[m].second));
                    // Leave out the time of the fit to the labels, which does not depend on the number of vertices.
                    const double seconds =
                        measured.method == "calibrated"
                            ? measure(mesh, unlabelled, &grid, choose(find_method(methods[m].first), methods[m].second))
                                  .occlusion_seconds
                            : measured.occlusion_seconds;
                    MethodFigures& figures = figures_[v][m];
                    if (errors_count && measured.error.deviation > min_deviation)
                        figures.error_per_difficulty[r].push_back(measured.error.rmse / pilot.difficulty());
                    if (mesh.order.size() >= min_vertices)
                        figures.seconds_per_surfel.push_back(seconds / static_cast<double>(mesh.order.size()) -
                                                             measured.rays * ray);
                }
            }
        }
    }

    std::string text() const {
        std::string rays, rows;
        for (const auto& at_radius : costs_.rays)
            rays += fmt::format("{}{:.3g}", rays.empty() ? "" : ", ", reference_ray_cost(at_radius));
        for (std::size_t v = 0; v < largest_voxels.size(); ++v)
            for (std::size_t m = 0; m < methods.size(); ++m) {
                const MethodFigures& figures = figures_[v][m];
                std::vector<std::string> errors;
                for (const auto& at_radius : figures.error_per_difficulty)
                    errors.push_back(fmt::format("{:.3f}", median_of(at_radius)));
                rows += fmt::format("    {{\"{}\", {}, 1.0f / {:.0f}, {:.2g}, {{{}}}}},\n", methods[m].first,
                                    methods[m].second, 1.0f / largest_voxels[v],
                                    std::max(median_of(figures.seconds_per_surfel), 0.0), fmt::join(errors, ", "));
            }
        const GridCosts grid = grid_costs();
        return fmt::format(head, rays, reference_doublings, slower_per_doubling(), bvh_cost(), grid(0), grid(1),
                           grid(2), grid(3), grid(4), 2 * methods.size(), rows);
    }

  private:
    static constexpr std::string_view head =
        R"(/// The errors and costs that the planner chooses by. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {{

/// As fractions of the diagonal; 1 stands for all larger radii.
inline constexpr std::array radii{{0.02, 0.05, 0.1, 0.2, 0.5, 1.0}};

/// CPU seconds. The cost per ray is given for each radius, for rays shot at a mesh of 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{{{}}};
inline constexpr double doublings_of_rays = {};
inline constexpr double rays_slower_per_doubling = {:.3f};
inline constexpr double tree_seconds_per_triangle = {:.3g};
inline constexpr double seconds_per_grid = {:.3g};
inline constexpr double grid_seconds_per_triangle = {:.3g}; ///< per voxelized triangle
inline constexpr double clustering_seconds_per_triangle = {:.3g}; ///< per triangle that clustering removes
inline constexpr double grid_seconds_per_voxel = {:.3g}; ///< per finest voxel on the surface: area / voxel²
inline constexpr double grid_seconds_of_both = {:.3g}; ///< per geometric mean of voxelized triangles and such voxels

struct Row {{
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as in GridOptions
    double seconds_per_surfel; ///< without its rays
    /// RMSE / Pilot::difficulty(), median over the meshes, at each radius.
    std::array<double, radii.size()> error_per_difficulty;
}};
inline constexpr std::array<Row, {}> rows{{{{
{}}}}};

}}
)";

    double slower_per_doubling() const {
        // One slope for all radii, fitted to costs relative to the mean of each radius.
        double xy = 0.0, xx = 0.0;
        for (const auto& at_radius : costs_.rays) {
            double x = 0.0, y = 0.0;
            for (const auto& [triangles, seconds] : at_radius)
                x += std::log2(triangles), y += seconds;
            x /= static_cast<double>(at_radius.size()), y /= static_cast<double>(at_radius.size());
            for (const auto& [triangles, seconds] : at_radius) {
                xy += (std::log2(triangles) - x) * (seconds / y - 1.0);
                xx += (std::log2(triangles) - x) * (std::log2(triangles) - x);
            }
        }
        return std::max(xy / xx, 0.0);
    }
    double reference_ray_cost(const std::vector<std::pair<double, double>>& at_radius) const {
        std::vector<double> seconds;
        for (const auto& [triangles, ray] : at_radius)
            seconds.push_back(ray / relative_ray_cost(triangles, slower_per_doubling()));
        return median_of(seconds);
    }
    double bvh_cost() const {
        double seconds = 0.0, triangles = 0.0;
        for (const auto& [count, bvh_seconds] : costs_.bvh)
            seconds += bvh_seconds, triangles += count;
        return seconds / triangles;
    }
    using GridCosts = Eigen::Matrix<double, 5, 1>;
    /// A least-squares fit that minimises the relative errors of the seconds predicted for each grid.
    GridCosts grid_costs() const {
        Eigen::MatrixXd terms(costs_.grid.size(), 5);
        for (std::size_t i = 0; i < costs_.grid.size(); ++i) {
            const auto& [voxelized, left_out, cells, seconds] = costs_.grid[i];
            terms.row(static_cast<Eigen::Index>(i)) << 1.0 / seconds, voxelized / seconds, left_out / seconds,
                cells / seconds, std::sqrt(voxelized * cells) / seconds;
        }
        return terms.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(terms.rows())).cwiseMax(0.0);
    }

    std::array<std::array<MethodFigures, methods.size()>, largest_voxels.size()> figures_;
    Costs costs_;
};

void run() {
    const ThreadLimit one_core(1);
    PlanTable table;
    for (const MeshFile& file : split_meshes(std::string(ALCOVE_TREE) + "/build/meshes/meshes")) {
        if (!file.fitted)
            continue;
        fmt::print("{}\n", file.path.filename().string());
        std::fflush(stdout);
        const Mesh mesh = read_mesh(file.path.string());
        table.add(MeasuredMesh(file.path.string(), mesh), true);
        if (file.path.stem() == "armadillo") {
            const Mesh finer = subdivided(mesh);
            table.add(MeasuredMesh("finer", finer), false);
            table.add(MeasuredMesh("finest", subdivided(finer)), false);
        }
    }
    const std::string path = std::string(ALCOVE_TREE) + "/lib/alcove/bake/detail/plan_table.h";
    std::ofstream file(path);
    file << table.text();
    if (!file.flush())
        throw std::runtime_error("cannot write " + path);
}

}
}

int main() {
    try {
        alcove::fit::run();
        return EXIT_SUCCESS;
    } catch (const std::exception& failure) {
        fmt::print(stderr, "alcove_fit_plans: {}\n", failure.what());
        return EXIT_FAILURE;
    }
}
