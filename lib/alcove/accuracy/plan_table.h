/// What the planner chooses from. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// Of the diagonal; 1 stands for all that are larger.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds; a ray at each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{1.19e-07, 1.39e-07, 1.34e-07, 1.49e-07, 1.6e-07, 1.49e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.116;
inline constexpr double tree_seconds_per_triangle = 3.4e-07;
inline constexpr double seconds_per_grid = 0.00219;
inline constexpr double grid_seconds_per_triangle = 1.48e-06;
inline constexpr double grid_seconds_per_voxel = 2.58e-06; ///< a cell of the finest level that the surface is in: area / voxel²

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as GridOptions has it
    double seconds_per_surfel; ///< beside its rays
    std::array<double, radii.size()> error_per_deviation; ///< RMSE over the standard deviation of the truth, median of the meshes, at each radius
};
inline constexpr std::array<Row, 22> rows{{
    {"guided", 1, 1.0f / 64, 6.7e-07, {0.337, 0.293, 0.280, 0.274, 0.297, 0.338}},
    {"guided", 2, 1.0f / 64, 6.5e-07, {0.256, 0.264, 0.243, 0.235, 0.229, 0.266}},
    {"guided", 3, 1.0f / 64, 6.8e-07, {0.249, 0.230, 0.217, 0.216, 0.214, 0.223}},
    {"guided", 4, 1.0f / 64, 6.8e-07, {0.229, 0.206, 0.193, 0.191, 0.190, 0.214}},
    {"guided", 6, 1.0f / 64, 7e-07, {0.195, 0.184, 0.190, 0.173, 0.174, 0.196}},
    {"guided", 8, 1.0f / 64, 7.2e-07, {0.185, 0.176, 0.157, 0.155, 0.149, 0.178}},
    {"guided", 16, 1.0f / 64, 7.2e-07, {0.166, 0.146, 0.128, 0.129, 0.123, 0.141}},
    {"guided", 32, 1.0f / 64, 6.3e-07, {0.133, 0.116, 0.103, 0.095, 0.094, 0.100}},
    {"guided", 64, 1.0f / 64, 4.3e-07, {0.098, 0.089, 0.079, 0.070, 0.066, 0.066}},
    {"calibrated", 10, 1.0f / 64, 2e-07, {0.275, 0.303, 0.301, 0.307, 0.354, 0.469}},
    {"calibrated", 24, 1.0f / 64, 2.7e-07, {0.275, 0.310, 0.332, 0.307, 0.289, 0.413}},
    {"guided", 1, 1.0f / 256, 7e-07, {0.337, 0.277, 0.273, 0.260, 0.303, 0.338}},
    {"guided", 2, 1.0f / 256, 6.7e-07, {0.256, 0.238, 0.230, 0.222, 0.234, 0.266}},
    {"guided", 3, 1.0f / 256, 6.9e-07, {0.249, 0.216, 0.213, 0.205, 0.220, 0.223}},
    {"guided", 4, 1.0f / 256, 7.1e-07, {0.229, 0.196, 0.185, 0.190, 0.192, 0.214}},
    {"guided", 6, 1.0f / 256, 7.3e-07, {0.195, 0.178, 0.172, 0.175, 0.174, 0.196}},
    {"guided", 8, 1.0f / 256, 7.5e-07, {0.185, 0.163, 0.154, 0.151, 0.158, 0.178}},
    {"guided", 16, 1.0f / 256, 7.4e-07, {0.166, 0.149, 0.124, 0.126, 0.122, 0.141}},
    {"guided", 32, 1.0f / 256, 7e-07, {0.133, 0.121, 0.098, 0.095, 0.092, 0.100}},
    {"guided", 64, 1.0f / 256, 4.3e-07, {0.098, 0.095, 0.078, 0.072, 0.065, 0.066}},
    {"calibrated", 10, 1.0f / 256, 2.1e-07, {0.275, 0.263, 0.286, 0.321, 0.381, 0.469}},
    {"calibrated", 24, 1.0f / 256, 3.3e-07, {0.275, 0.224, 0.257, 0.249, 0.282, 0.408}},
}};

}
