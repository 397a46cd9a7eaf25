/// Measures what the planner chooses from, errors and costs, on the meshes that calibrated is fitted to and on two
/// finer ones for costs alone, and writes the table the library is compiled with.
///
///     cmake --build build --target alcove_fit_plans && build/fit/alcove_fit_plans
///
/// in a checkout whose meshes tools/setup.sh has unpacked; a few minutes, on one core. Costs are of the machine it
/// runs on: what matters to plans is how they compare.
#include "meshes.h"

#include "alcove/bake/detail/pilot.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/measure/measure.h"
#include "alcove/mesh/read.h"
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
constexpr std::array<std::pair<std::string_view, int>, 14> methods{{{"guided", 1},
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
                                                                    {"calibrated", 10},
                                                                    {"calibrated", 24}}};
constexpr TruthOptions truth_options{.rays = 512, .most = 4000};
constexpr double least_deviation = 0.01;      // of a truth that errors are compared with
constexpr std::size_t fewest_vertices = 2000; // of a mesh whose seconds count a vertex
constexpr int rays_timed = 64;
constexpr double doublings = 17.0;

/// Errors and costs of all meshes, by what they are of.
struct Figures {
    std::array<std::vector<double>, radii.size()> error_per_difficulty{};
    std::vector<double> seconds_per_surfel{};
};

struct Costs {
    std::vector<std::array<double, 4>> grid{};     // triangles voxelized and left out, cells, seconds
    std::vector<std::pair<double, double>> tree{}; // triangles, seconds
    std::array<std::vector<std::pair<double, double>>, radii.size()> rays{}; // triangles, seconds a ray
};

double relative_ray(double triangles, double slower_per_doubling) {
    return std::max(1.0 + slower_per_doubling * (std::log2(triangles) - doublings), 0.3);
}

double median_of(std::vector<double> values) {
    if (values.empty())
        return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

class Survey {
  public:
    void add(const MeasuredMesh& mesh, bool errors_count) {
        const auto triangles = static_cast<double>(mesh.triangles.size());
        const double area = surface_size(mesh.mesh, mesh.triangles).area;
        costs_.tree.emplace_back(triangles, mesh.tree_seconds);
        for (std::size_t r = 0; r < radii.size(); ++r) {
            const Truth truth = make_truth(mesh, radii[r], truth_options);
            const Pilot pilot(mesh.surfels, mesh.rays, radii[r]);
            const Measurement exact = measure(mesh, truth, nullptr, choose(find_method("exact"), rays_timed));
            const double ray =
                exact.occlusion_seconds / (static_cast<double>(mesh.order.size()) * rays_timed);
            if (mesh.order.size() >= fewest_vertices)
                costs_.rays[r].emplace_back(triangles, ray);
            for (std::size_t v = 0; v < largest_voxels.size(); ++v) {
                const MeasuredGrid grid =
                    build_grid(mesh, radii[r], chosen_voxel(radii[r], largest_voxels[v]));
                const double voxel = grid.field.resolution();
                const double voxelized =
                    triangles_voxelized(area, mesh.triangles.size(), voxel, {.cluster = true});
                costs_.grid.push_back(
                    {voxelized, triangles - voxelized, area / (voxel * voxel), grid.seconds});
                for (std::size_t m = 0; m < methods.size(); ++m) {
                    const Measurement measured =
                        measure(mesh, truth, &grid, choose(find_method(methods[m].first), methods[m].second));
                    Figures& figures = figures_[v][m];
                    if (errors_count && measured.error.deviation > least_deviation)
                        figures.error_per_difficulty[r].push_back(measured.error.rmse / pilot.difficulty());
                    if (mesh.order.size() >= fewest_vertices)
                        figures.seconds_per_surfel.push_back(measured.occlusion_seconds /
                                                                 static_cast<double>(mesh.order.size()) -
                                                             measured.rays * ray);
                }
            }
        }
    }

    std::string table() const {
        std::string rays, rows;
        for (const auto& at_radius : costs_.rays)
            rays += fmt::format("{}{:.3g}", rays.empty() ? "" : ", ", reference_ray(at_radius));
        for (std::size_t v = 0; v < largest_voxels.size(); ++v)
            for (std::size_t m = 0; m < methods.size(); ++m) {
                const Figures& figures = figures_[v][m];
                std::vector<std::string> errors;
                for (const auto& at_radius : figures.error_per_difficulty)
                    errors.push_back(fmt::format("{:.3f}", median_of(at_radius)));
                rows += fmt::format("    {{\"{}\", {}, 1.0f / {:.0f}, {:.2g}, {{{}}}}},\n", methods[m].first,
                                    methods[m].second, 1.0f / largest_voxels[v],
                                    std::max(median_of(figures.seconds_per_surfel), 0.0),
                                    fmt::join(errors, ", "));
            }
        const GridCosts grid = grid_costs();
        return fmt::format(head, rays, doublings, slower_per_doubling(), tree_cost(), grid(0), grid(1),
                           grid(2), grid(3), grid(4), 2 * methods.size(), rows);
    }

  private:
    static constexpr std::string_view head =
        R"(/// What the planner chooses from. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {{

/// Of the diagonal; 1 stands for all that are larger.
inline constexpr std::array radii{{0.02, 0.05, 0.1, 0.2, 0.5, 1.0}};

/// CPU seconds; a ray at each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{{{}}};
inline constexpr double doublings_of_rays = {};
inline constexpr double rays_slower_per_doubling = {:.3f};
inline constexpr double tree_seconds_per_triangle = {:.3g};
inline constexpr double seconds_per_grid = {:.3g};
inline constexpr double grid_seconds_per_triangle = {:.3g}; ///< that is voxelized
inline constexpr double clustering_seconds_per_triangle = {:.3g}; ///< that is left out
inline constexpr double grid_seconds_per_voxel = {:.3g}; ///< a cell of the finest level that the surface is in: area / voxel²
inline constexpr double grid_seconds_of_both = {:.3g}; ///< by the geometric mean of triangles that are voxelized and such cells

struct Row {{
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as GridOptions has it
    double seconds_per_surfel; ///< beside its rays
    std::array<double, radii.size()> error_per_difficulty; ///< RMSE over Pilot::difficulty(), median of the meshes, at each radius
}};
inline constexpr std::array<Row, {}> rows{{{{
{}}}}};

}}
)";

    double slower_per_doubling() const {
        // Of each radius beside its own mean: all share one slope.
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
    double reference_ray(const std::vector<std::pair<double, double>>& at_radius) const {
        std::vector<double> seconds;
        for (const auto& [triangles, ray] : at_radius)
            seconds.push_back(ray / relative_ray(triangles, slower_per_doubling()));
        return median_of(seconds);
    }
    double tree_cost() const {
        double seconds = 0.0, all = 0.0;
        for (const auto& [triangles, tree] : costs_.tree)
            seconds += tree, all += triangles;
        return seconds / all;
    }
    using GridCosts = Eigen::Matrix<double, 5, 1>;
    /// Least squares of what each grid took beside what it is said to take.
    GridCosts grid_costs() const {
        Eigen::MatrixXd terms(costs_.grid.size(), 5);
        for (std::size_t i = 0; i < costs_.grid.size(); ++i) {
            const auto& [voxelized, left_out, cells, seconds] = costs_.grid[i];
            terms.row(static_cast<Eigen::Index>(i)) << 1.0 / seconds, voxelized / seconds, left_out / seconds,
                cells / seconds, std::sqrt(voxelized * cells) / seconds;
        }
        return terms.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(terms.rows())).cwiseMax(0.0);
    }

    std::array<std::array<Figures, methods.size()>, largest_voxels.size()> figures_;
    Costs costs_;
};

void run() {
    const ThreadLimit one_core(1);
    Survey survey;
    for (const MeshFile& file : split_meshes(std::string(ALCOVE_TREE) + "/build/meshes/meshes")) {
        if (!file.fitted)
            continue;
        fmt::print("{}\n", file.path.filename().string());
        std::fflush(stdout);
        const Mesh mesh = read_mesh(file.path.string());
        survey.add(MeasuredMesh(file.path.string(), mesh), true);
        if (file.path.stem() == "armadillo") {
            const Mesh finer = subdivided(mesh);
            survey.add(MeasuredMesh("finer", finer), false);
            survey.add(MeasuredMesh("finest", subdivided(finer)), false);
        }
    }
    const std::string path = std::string(ALCOVE_TREE) + "/lib/alcove/bake/detail/plan_table.h";
    std::ofstream table(path);
    table << survey.table();
    if (!table.flush())
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
