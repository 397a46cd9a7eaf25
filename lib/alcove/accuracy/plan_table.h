/// What the planner chooses from. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// Of the diagonal; 1 stands for all that are larger.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds; a ray at each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{8.79e-08, 9.53e-08, 9.66e-08, 1.06e-07, 1.09e-07, 1.11e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.072;
inline constexpr double tree_seconds_per_triangle = 1.39e-07;
inline constexpr double seconds_per_grid = 0.00268;
inline constexpr double grid_seconds_per_triangle = 5.96e-07;
inline constexpr double grid_seconds_per_voxel = 1.66e-06; ///< a cell of the finest level that the surface is in: area / voxel²

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as GridOptions has it
    double seconds_per_surfel; ///< beside its rays
    std::array<double, radii.size()> error_per_deviation; ///< RMSE over the standard deviation of the truth, median of the meshes, at each radius
};
inline constexpr std::array<Row, 28> rows{{
    {"guided", 1, 1.0f / 64, 5.7e-07, {0.359, 0.333, 0.304, 0.292, 0.305, 0.318}},
    {"guided", 2, 1.0f / 64, 5.5e-07, {0.283, 0.275, 0.259, 0.240, 0.252, 0.253}},
    {"guided", 3, 1.0f / 64, 5.5e-07, {0.252, 0.227, 0.214, 0.211, 0.210, 0.220}},
    {"guided", 4, 1.0f / 64, 5.7e-07, {0.239, 0.198, 0.206, 0.208, 0.191, 0.211}},
    {"guided", 6, 1.0f / 64, 5.9e-07, {0.198, 0.187, 0.185, 0.177, 0.171, 0.181}},
    {"guided", 8, 1.0f / 64, 6e-07, {0.184, 0.171, 0.173, 0.154, 0.145, 0.166}},
    {"guided", 11, 1.0f / 64, 6.2e-07, {0.161, 0.148, 0.158, 0.143, 0.135, 0.144}},
    {"guided", 16, 1.0f / 64, 6.2e-07, {0.153, 0.137, 0.127, 0.121, 0.114, 0.131}},
    {"guided", 22, 1.0f / 64, 6.3e-07, {0.139, 0.137, 0.119, 0.112, 0.103, 0.109}},
    {"guided", 32, 1.0f / 64, 6.2e-07, {0.122, 0.114, 0.099, 0.092, 0.082, 0.090}},
    {"guided", 45, 1.0f / 64, 6.1e-07, {0.086, 0.103, 0.084, 0.074, 0.070, 0.071}},
    {"guided", 64, 1.0f / 64, 5.2e-07, {0.079, 0.087, 0.074, 0.062, 0.060, 0.063}},
    {"calibrated", 10, 1.0f / 64, 1.3e-07, {0.275, 0.303, 0.301, 0.307, 0.354, 0.469}},
    {"calibrated", 24, 1.0f / 64, 2.1e-07, {0.275, 0.310, 0.332, 0.307, 0.289, 0.413}},
    {"guided", 1, 1.0f / 256, 5.8e-07, {0.359, 0.325, 0.279, 0.294, 0.305, 0.318}},
    {"guided", 2, 1.0f / 256, 5.6e-07, {0.283, 0.244, 0.242, 0.226, 0.255, 0.253}},
    {"guided", 3, 1.0f / 256, 5.7e-07, {0.252, 0.216, 0.203, 0.204, 0.217, 0.220}},
    {"guided", 4, 1.0f / 256, 5.8e-07, {0.239, 0.188, 0.192, 0.202, 0.192, 0.211}},
    {"guided", 6, 1.0f / 256, 6.2e-07, {0.198, 0.181, 0.174, 0.177, 0.169, 0.181}},
    {"guided", 8, 1.0f / 256, 6.4e-07, {0.184, 0.168, 0.152, 0.153, 0.146, 0.166}},
    {"guided", 11, 1.0f / 256, 6.6e-07, {0.161, 0.150, 0.134, 0.143, 0.134, 0.144}},
    {"guided", 16, 1.0f / 256, 6.4e-07, {0.153, 0.136, 0.122, 0.118, 0.118, 0.131}},
    {"guided", 22, 1.0f / 256, 6.7e-07, {0.139, 0.137, 0.110, 0.112, 0.103, 0.109}},
    {"guided", 32, 1.0f / 256, 6.5e-07, {0.122, 0.111, 0.093, 0.092, 0.081, 0.090}},
    {"guided", 45, 1.0f / 256, 6.4e-07, {0.086, 0.099, 0.082, 0.075, 0.069, 0.071}},
    {"guided", 64, 1.0f / 256, 5.6e-07, {0.079, 0.085, 0.073, 0.063, 0.059, 0.063}},
    {"calibrated", 10, 1.0f / 256, 1.4e-07, {0.275, 0.263, 0.286, 0.321, 0.381, 0.469}},
    {"calibrated", 24, 1.0f / 256, 2.5e-07, {0.275, 0.224, 0.257, 0.249, 0.282, 0.408}},
}};

}
