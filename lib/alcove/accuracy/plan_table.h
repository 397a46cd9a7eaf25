/// What the planner chooses from. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// Of the diagonal; 1 stands for all that are larger.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds; a ray at each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{9.06e-08, 9.7e-08, 1.05e-07, 1.1e-07, 1.16e-07, 1.16e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.082;
inline constexpr double tree_seconds_per_triangle = 1.75e-07;
inline constexpr double seconds_per_grid = 0.00176;
inline constexpr double grid_seconds_per_triangle = 5.79e-07; ///< that is voxelized
inline constexpr double thinning_seconds_per_triangle = 6.84e-08; ///< that is left out
inline constexpr double grid_seconds_per_voxel = 1.12e-06; ///< a cell of the finest level that the surface is in: area / voxel²

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as GridOptions has it
    double seconds_per_surfel; ///< beside its rays
    std::array<double, radii.size()> error_per_difficulty; ///< RMSE over Pilot::difficulty(), median of the meshes, at each radius
};
inline constexpr std::array<Row, 28> rows{{
    {"guided", 1, 1.0f / 64, 5.6e-07, {0.904, 0.893, 1.033, 0.939, 0.951, 0.980}},
    {"guided", 2, 1.0f / 64, 5.6e-07, {0.639, 0.698, 0.791, 0.736, 0.749, 0.741}},
    {"guided", 3, 1.0f / 64, 5.8e-07, {0.518, 0.548, 0.649, 0.633, 0.613, 0.619}},
    {"guided", 4, 1.0f / 64, 6e-07, {0.507, 0.535, 0.596, 0.563, 0.536, 0.598}},
    {"guided", 6, 1.0f / 64, 6.5e-07, {0.417, 0.475, 0.526, 0.507, 0.456, 0.532}},
    {"guided", 8, 1.0f / 64, 6.2e-07, {0.401, 0.441, 0.457, 0.412, 0.413, 0.477}},
    {"guided", 11, 1.0f / 64, 6.4e-07, {0.345, 0.379, 0.419, 0.380, 0.385, 0.447}},
    {"guided", 16, 1.0f / 64, 6.7e-07, {0.338, 0.361, 0.369, 0.354, 0.328, 0.403}},
    {"guided", 22, 1.0f / 64, 6.9e-07, {0.292, 0.321, 0.333, 0.300, 0.311, 0.345}},
    {"guided", 32, 1.0f / 64, 6.6e-07, {0.258, 0.272, 0.274, 0.260, 0.262, 0.272}},
    {"guided", 45, 1.0f / 64, 6.4e-07, {0.211, 0.239, 0.234, 0.223, 0.222, 0.221}},
    {"guided", 64, 1.0f / 64, 5.7e-07, {0.189, 0.199, 0.197, 0.179, 0.185, 0.179}},
    {"calibrated", 10, 1.0f / 64, 1.4e-07, {0.707, 0.799, 0.858, 0.851, 0.956, 1.321}},
    {"calibrated", 24, 1.0f / 64, 2.1e-07, {0.562, 0.701, 0.926, 0.902, 0.887, 1.184}},
    {"guided", 1, 1.0f / 256, 6e-07, {0.904, 0.910, 0.945, 0.902, 0.970, 0.980}},
    {"guided", 2, 1.0f / 256, 6e-07, {0.639, 0.655, 0.700, 0.705, 0.746, 0.741}},
    {"guided", 3, 1.0f / 256, 6.2e-07, {0.518, 0.521, 0.600, 0.573, 0.620, 0.619}},
    {"guided", 4, 1.0f / 256, 6.2e-07, {0.507, 0.522, 0.569, 0.561, 0.544, 0.598}},
    {"guided", 6, 1.0f / 256, 6.4e-07, {0.417, 0.451, 0.510, 0.493, 0.454, 0.532}},
    {"guided", 8, 1.0f / 256, 6.6e-07, {0.401, 0.425, 0.437, 0.409, 0.410, 0.477}},
    {"guided", 11, 1.0f / 256, 6.8e-07, {0.345, 0.371, 0.399, 0.375, 0.387, 0.447}},
    {"guided", 16, 1.0f / 256, 7e-07, {0.338, 0.357, 0.355, 0.340, 0.337, 0.403}},
    {"guided", 22, 1.0f / 256, 7.2e-07, {0.292, 0.307, 0.320, 0.290, 0.308, 0.345}},
    {"guided", 32, 1.0f / 256, 7e-07, {0.258, 0.267, 0.269, 0.253, 0.261, 0.272}},
    {"guided", 45, 1.0f / 256, 6.8e-07, {0.211, 0.235, 0.229, 0.224, 0.221, 0.221}},
    {"guided", 64, 1.0f / 256, 5.8e-07, {0.189, 0.198, 0.191, 0.182, 0.177, 0.179}},
    {"calibrated", 10, 1.0f / 256, 1.6e-07, {0.707, 0.662, 0.746, 0.838, 0.967, 1.321}},
    {"calibrated", 24, 1.0f / 256, 2.5e-07, {0.562, 0.573, 0.652, 0.772, 0.805, 1.153}},
}};

}
