/// The errors and costs that the planner chooses by. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// As fractions of the diagonal; 1 stands for all larger radii.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds. Costs per ray are for each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{9.87e-08, 1.04e-07, 1.1e-07, 1.18e-07, 1.25e-07, 1.28e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.070;
inline constexpr double tree_seconds_per_triangle = 2.4e-07;
inline constexpr double seconds_per_grid = 0.00244;
inline constexpr double grid_seconds_per_triangle = 4.31e-07; ///< per voxelized triangle
inline constexpr double clustering_seconds_per_triangle = 8.68e-08; ///< per triangle that clustering removes
inline constexpr double grid_seconds_per_voxel = 1.43e-06; ///< per finest voxel on the surface: area / voxel²
inline constexpr double grid_seconds_of_both = 4.23e-07; ///< per geometric mean of voxelized triangles and such voxels

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as in GridOptions
    double seconds_per_surfel; ///< without its rays
    /// RMSE / Pilot::difficulty(), median over the meshes, at each radius.
    std::array<double, radii.size()> error_per_difficulty;
};
inline constexpr std::array<Row, 30> rows{{
    {"guided", 1, 1.0f / 64, 8.7e-07, {0.717, 0.674, 0.737, 0.693, 0.716, 0.740}},
    {"guided", 2, 1.0f / 64, 8.3e-07, {0.507, 0.592, 0.588, 0.560, 0.572, 0.545}},
    {"guided", 3, 1.0f / 64, 8.5e-07, {0.409, 0.467, 0.506, 0.445, 0.434, 0.455}},
    {"guided", 4, 1.0f / 64, 8.7e-07, {0.430, 0.452, 0.504, 0.452, 0.447, 0.477}},
    {"guided", 6, 1.0f / 64, 8.9e-07, {0.370, 0.413, 0.456, 0.384, 0.405, 0.425}},
    {"guided", 8, 1.0f / 64, 9e-07, {0.343, 0.364, 0.378, 0.378, 0.379, 0.378}},
    {"guided", 11, 1.0f / 64, 9.1e-07, {0.309, 0.333, 0.348, 0.318, 0.299, 0.340}},
    {"guided", 16, 1.0f / 64, 9.1e-07, {0.283, 0.309, 0.327, 0.298, 0.290, 0.313}},
    {"guided", 22, 1.0f / 64, 9.4e-07, {0.261, 0.278, 0.278, 0.274, 0.278, 0.293}},
    {"guided", 32, 1.0f / 64, 8.9e-07, {0.229, 0.235, 0.234, 0.227, 0.235, 0.259}},
    {"guided", 45, 1.0f / 64, 8.6e-07, {0.208, 0.220, 0.211, 0.216, 0.205, 0.212}},
    {"guided", 64, 1.0f / 64, 7e-07, {0.171, 0.181, 0.188, 0.179, 0.173, 0.177}},
    {"calibrated", 13, 1.0f / 64, 3.2e-07, {0.369, 0.460, 0.492, 0.491, 0.554, 0.684}},
    {"calibrated", 38, 1.0f / 64, 5e-07, {0.338, 0.383, 0.390, 0.396, 0.479, 0.510}},
    {"calibrated", 63, 1.0f / 64, 7.1e-07, {0.314, 0.366, 0.376, 0.439, 0.428, 0.515}},
    {"guided", 1, 1.0f / 256, 8.8e-07, {0.717, 0.587, 0.614, 0.633, 0.712, 0.734}},
    {"guided", 2, 1.0f / 256, 8.5e-07, {0.507, 0.555, 0.528, 0.513, 0.559, 0.520}},
    {"guided", 3, 1.0f / 256, 8.7e-07, {0.409, 0.438, 0.431, 0.405, 0.410, 0.458}},
    {"guided", 4, 1.0f / 256, 8.9e-07, {0.430, 0.428, 0.423, 0.440, 0.410, 0.477}},
    {"guided", 6, 1.0f / 256, 9.1e-07, {0.370, 0.387, 0.385, 0.357, 0.405, 0.421}},
    {"guided", 8, 1.0f / 256, 9.2e-07, {0.343, 0.357, 0.349, 0.352, 0.376, 0.391}},
    {"guided", 11, 1.0f / 256, 9.4e-07, {0.309, 0.324, 0.312, 0.291, 0.304, 0.351}},
    {"guided", 16, 1.0f / 256, 9.5e-07, {0.283, 0.293, 0.306, 0.274, 0.283, 0.314}},
    {"guided", 22, 1.0f / 256, 9.6e-07, {0.261, 0.264, 0.276, 0.260, 0.264, 0.296}},
    {"guided", 32, 1.0f / 256, 9.3e-07, {0.229, 0.230, 0.231, 0.213, 0.228, 0.260}},
    {"guided", 45, 1.0f / 256, 8.9e-07, {0.208, 0.211, 0.207, 0.203, 0.202, 0.213}},
    {"guided", 64, 1.0f / 256, 7.5e-07, {0.171, 0.181, 0.179, 0.170, 0.170, 0.175}},
    {"calibrated", 13, 1.0f / 256, 3.4e-07, {0.369, 0.408, 0.475, 0.504, 0.536, 0.696}},
    {"calibrated", 38, 1.0f / 256, 5.3e-07, {0.338, 0.320, 0.382, 0.361, 0.453, 0.515}},
    {"calibrated", 63, 1.0f / 256, 7.5e-07, {0.314, 0.327, 0.342, 0.402, 0.412, 0.518}},
}};

}
