/// What the planner chooses from. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// Of the diagonal; 1 stands for all that are larger.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds; a ray at each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{9.48e-08, 1.04e-07, 1.11e-07, 1.15e-07, 1.21e-07, 1.22e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.084;
inline constexpr double tree_seconds_per_triangle = 2.01e-07;
inline constexpr double seconds_per_grid = 0.00189;
inline constexpr double grid_seconds_per_triangle = 1.09e-06;
inline constexpr double grid_seconds_per_voxel = 1.62e-06; ///< a cell of the finest level that the surface is in: area / voxel²

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as GridOptions has it
    double seconds_per_surfel; ///< beside its rays
    std::array<double, radii.size()> error_per_deviation; ///< RMSE over the standard deviation of the truth, median of the meshes, at each radius
};
inline constexpr std::array<Row, 28> rows{{
    {"guided", 1, 1.0f / 64, 4.7e-07, {0.332, 0.285, 0.291, 0.278, 0.294, 0.327}},
    {"guided", 2, 1.0f / 64, 4.2e-07, {0.264, 0.259, 0.239, 0.234, 0.229, 0.253}},
    {"guided", 3, 1.0f / 64, 4.4e-07, {0.240, 0.216, 0.215, 0.202, 0.215, 0.219}},
    {"guided", 4, 1.0f / 64, 4.5e-07, {0.231, 0.204, 0.191, 0.206, 0.187, 0.214}},
    {"guided", 6, 1.0f / 64, 4.7e-07, {0.185, 0.183, 0.185, 0.174, 0.167, 0.184}},
    {"guided", 8, 1.0f / 64, 4.8e-07, {0.168, 0.165, 0.171, 0.159, 0.145, 0.173}},
    {"guided", 11, 1.0f / 64, 4.9e-07, {0.161, 0.154, 0.161, 0.147, 0.135, 0.151}},
    {"guided", 16, 1.0f / 64, 4.8e-07, {0.151, 0.140, 0.124, 0.124, 0.113, 0.131}},
    {"guided", 22, 1.0f / 64, 4.8e-07, {0.132, 0.144, 0.115, 0.113, 0.106, 0.109}},
    {"guided", 32, 1.0f / 64, 4.4e-07, {0.115, 0.115, 0.105, 0.090, 0.087, 0.093}},
    {"guided", 45, 1.0f / 64, 3.9e-07, {0.088, 0.100, 0.084, 0.075, 0.071, 0.074}},
    {"guided", 64, 1.0f / 64, 2.5e-07, {0.082, 0.085, 0.075, 0.064, 0.059, 0.065}},
    {"calibrated", 10, 1.0f / 64, 1.5e-07, {0.275, 0.303, 0.301, 0.307, 0.354, 0.469}},
    {"calibrated", 24, 1.0f / 64, 2.3e-07, {0.275, 0.310, 0.332, 0.307, 0.289, 0.413}},
    {"guided", 1, 1.0f / 256, 5e-07, {0.332, 0.279, 0.268, 0.284, 0.301, 0.327}},
    {"guided", 2, 1.0f / 256, 4.4e-07, {0.264, 0.234, 0.232, 0.223, 0.231, 0.253}},
    {"guided", 3, 1.0f / 256, 4.6e-07, {0.240, 0.213, 0.204, 0.202, 0.219, 0.219}},
    {"guided", 4, 1.0f / 256, 4.7e-07, {0.231, 0.196, 0.185, 0.202, 0.188, 0.214}},
    {"guided", 6, 1.0f / 256, 4.8e-07, {0.185, 0.178, 0.172, 0.173, 0.166, 0.184}},
    {"guided", 8, 1.0f / 256, 4.9e-07, {0.168, 0.158, 0.156, 0.156, 0.150, 0.173}},
    {"guided", 11, 1.0f / 256, 5.1e-07, {0.161, 0.157, 0.139, 0.144, 0.134, 0.151}},
    {"guided", 16, 1.0f / 256, 5.1e-07, {0.151, 0.144, 0.120, 0.121, 0.117, 0.131}},
    {"guided", 22, 1.0f / 256, 5.1e-07, {0.132, 0.138, 0.112, 0.113, 0.106, 0.109}},
    {"guided", 32, 1.0f / 256, 4.7e-07, {0.115, 0.111, 0.100, 0.090, 0.086, 0.093}},
    {"guided", 45, 1.0f / 256, 4.2e-07, {0.088, 0.099, 0.082, 0.077, 0.070, 0.074}},
    {"guided", 64, 1.0f / 256, 2.7e-07, {0.082, 0.083, 0.075, 0.066, 0.059, 0.065}},
    {"calibrated", 10, 1.0f / 256, 1.8e-07, {0.275, 0.263, 0.286, 0.321, 0.381, 0.469}},
    {"calibrated", 24, 1.0f / 256, 2.9e-07, {0.275, 0.224, 0.257, 0.249, 0.282, 0.408}},
}};

}
