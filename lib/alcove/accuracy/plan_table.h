/// What the planner chooses from. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// Of the diagonal; 1 stands for all that are larger.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds; a ray at each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{1.04e-07, 1.12e-07, 1.2e-07, 1.28e-07, 1.36e-07, 1.34e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.101;
inline constexpr double tree_seconds_per_triangle = 1.73e-07;
inline constexpr double seconds_per_grid = 0.00262;
inline constexpr double grid_seconds_per_triangle = 1.31e-06;
inline constexpr double grid_seconds_per_voxel = 2.46e-06; ///< a cell of the finest level that the surface is in: area / voxel²

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as GridOptions has it
    double seconds_per_surfel; ///< beside its rays
    std::array<double, radii.size()> error_per_deviation; ///< RMSE over the standard deviation of the truth, median of the meshes, at each radius
};
inline constexpr std::array<Row, 22> rows{{
    {"guided", 1, 1.0f / 64, 4.6e-07, {0.341, 0.296, 0.297, 0.276, 0.297, 0.357}},
    {"guided", 2, 1.0f / 64, 4.6e-07, {0.260, 0.262, 0.244, 0.243, 0.232, 0.271}},
    {"guided", 3, 1.0f / 64, 4.7e-07, {0.253, 0.230, 0.217, 0.213, 0.215, 0.224}},
    {"guided", 4, 1.0f / 64, 4.8e-07, {0.231, 0.218, 0.200, 0.202, 0.195, 0.216}},
    {"guided", 6, 1.0f / 64, 5.1e-07, {0.196, 0.185, 0.188, 0.175, 0.176, 0.187}},
    {"guided", 8, 1.0f / 64, 5.2e-07, {0.188, 0.173, 0.169, 0.157, 0.145, 0.173}},
    {"guided", 16, 1.0f / 64, 5.2e-07, {0.163, 0.147, 0.127, 0.128, 0.119, 0.135}},
    {"guided", 32, 1.0f / 64, 4.5e-07, {0.131, 0.119, 0.107, 0.095, 0.090, 0.095}},
    {"guided", 64, 1.0f / 64, 2.5e-07, {0.097, 0.085, 0.077, 0.068, 0.066, 0.067}},
    {"calibrated", 10, 1.0f / 64, 1.7e-07, {0.275, 0.303, 0.301, 0.307, 0.354, 0.469}},
    {"calibrated", 24, 1.0f / 64, 2.4e-07, {0.275, 0.310, 0.332, 0.307, 0.289, 0.413}},
    {"guided", 1, 1.0f / 256, 4.9e-07, {0.341, 0.279, 0.270, 0.266, 0.304, 0.357}},
    {"guided", 2, 1.0f / 256, 4.7e-07, {0.260, 0.243, 0.231, 0.233, 0.237, 0.271}},
    {"guided", 3, 1.0f / 256, 4.8e-07, {0.253, 0.219, 0.213, 0.205, 0.216, 0.224}},
    {"guided", 4, 1.0f / 256, 5e-07, {0.231, 0.198, 0.186, 0.198, 0.194, 0.216}},
    {"guided", 6, 1.0f / 256, 5.1e-07, {0.196, 0.181, 0.178, 0.176, 0.173, 0.187}},
    {"guided", 8, 1.0f / 256, 5.2e-07, {0.188, 0.167, 0.160, 0.153, 0.149, 0.173}},
    {"guided", 16, 1.0f / 256, 5.3e-07, {0.163, 0.153, 0.123, 0.126, 0.118, 0.135}},
    {"guided", 32, 1.0f / 256, 5e-07, {0.131, 0.122, 0.101, 0.095, 0.088, 0.095}},
    {"guided", 64, 1.0f / 256, 2.8e-07, {0.097, 0.090, 0.078, 0.070, 0.064, 0.067}},
    {"calibrated", 10, 1.0f / 256, 2e-07, {0.275, 0.263, 0.286, 0.321, 0.381, 0.469}},
    {"calibrated", 24, 1.0f / 256, 2.9e-07, {0.275, 0.224, 0.257, 0.249, 0.282, 0.408}},
}};

}
