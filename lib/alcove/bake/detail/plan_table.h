/// The errors and costs that the planner chooses by. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// As fractions of the diagonal; 1 stands for all larger radii.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds. The cost per ray is given for each radius, for rays shot at a mesh of 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{9.91e-08, 1.06e-07, 1.1e-07, 1.24e-07, 1.27e-07, 1.29e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.070;
inline constexpr double tree_seconds_per_triangle = 2.46e-07;
inline constexpr double seconds_per_grid = 0.00256;
inline constexpr double grid_seconds_per_triangle = 4.3e-07; ///< per voxelized triangle
inline constexpr double clustering_seconds_per_triangle = 8.51e-08; ///< per triangle that clustering removes
inline constexpr double grid_seconds_per_voxel = 1.49e-06; ///< per finest voxel on the surface: area / voxel²
inline constexpr double grid_seconds_of_both = 4.56e-07; ///< per geometric mean of voxelized triangles and such voxels

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as in GridOptions
    double seconds_per_surfel; ///< without its rays
    /// RMSE / Pilot::difficulty(), median over the meshes, at each radius.
    std::array<double, radii.size()> error_per_difficulty;
};
inline constexpr std::array<Row, 30> rows{{
    {"guided", 1, 1.0f / 64, 8.9e-07, {0.739, 0.722, 0.737, 0.743, 0.748, 0.775}},
    {"guided", 2, 1.0f / 64, 8.5e-07, {0.580, 0.599, 0.642, 0.585, 0.640, 0.668}},
    {"guided", 3, 1.0f / 64, 8.8e-07, {0.431, 0.467, 0.515, 0.455, 0.470, 0.484}},
    {"guided", 4, 1.0f / 64, 9e-07, {0.430, 0.452, 0.500, 0.449, 0.447, 0.473}},
    {"guided", 6, 1.0f / 64, 9.1e-07, {0.389, 0.421, 0.464, 0.391, 0.409, 0.396}},
    {"guided", 8, 1.0f / 64, 9.4e-07, {0.349, 0.377, 0.383, 0.355, 0.380, 0.378}},
    {"guided", 11, 1.0f / 64, 9.6e-07, {0.322, 0.344, 0.359, 0.330, 0.329, 0.340}},
    {"guided", 16, 1.0f / 64, 9.7e-07, {0.292, 0.312, 0.342, 0.315, 0.295, 0.324}},
    {"guided", 22, 1.0f / 64, 9.9e-07, {0.269, 0.278, 0.285, 0.276, 0.247, 0.271}},
    {"guided", 32, 1.0f / 64, 9.6e-07, {0.235, 0.236, 0.245, 0.228, 0.218, 0.226}},
    {"guided", 45, 1.0f / 64, 9.1e-07, {0.209, 0.220, 0.212, 0.216, 0.197, 0.200}},
    {"guided", 64, 1.0f / 64, 7.9e-07, {0.172, 0.182, 0.183, 0.180, 0.162, 0.168}},
    {"calibrated", 13, 1.0f / 64, 2.1e-07, {0.404, 0.460, 0.492, 0.497, 0.533, 0.684}},
    {"calibrated", 38, 1.0f / 64, 4e-07, {0.348, 0.392, 0.392, 0.416, 0.479, 0.520}},
    {"calibrated", 63, 1.0f / 64, 6e-07, {0.318, 0.373, 0.397, 0.433, 0.424, 0.511}},
    {"guided", 1, 1.0f / 256, 9.3e-07, {0.739, 0.633, 0.618, 0.643, 0.740, 0.787}},
    {"guided", 2, 1.0f / 256, 8.9e-07, {0.580, 0.555, 0.540, 0.533, 0.617, 0.641}},
    {"guided", 3, 1.0f / 256, 9.1e-07, {0.431, 0.437, 0.451, 0.433, 0.477, 0.471}},
    {"guided", 4, 1.0f / 256, 9.1e-07, {0.430, 0.430, 0.445, 0.432, 0.436, 0.480}},
    {"guided", 6, 1.0f / 256, 9.4e-07, {0.389, 0.396, 0.408, 0.352, 0.404, 0.406}},
    {"guided", 8, 1.0f / 256, 9.6e-07, {0.349, 0.369, 0.364, 0.332, 0.380, 0.396}},
    {"guided", 11, 1.0f / 256, 9.8e-07, {0.322, 0.325, 0.321, 0.293, 0.306, 0.351}},
    {"guided", 16, 1.0f / 256, 9.9e-07, {0.292, 0.299, 0.320, 0.275, 0.286, 0.314}},
    {"guided", 22, 1.0f / 256, 1e-06, {0.269, 0.264, 0.279, 0.254, 0.253, 0.275}},
    {"guided", 32, 1.0f / 256, 9.8e-07, {0.235, 0.230, 0.243, 0.220, 0.228, 0.230}},
    {"guided", 45, 1.0f / 256, 9.6e-07, {0.209, 0.212, 0.213, 0.196, 0.200, 0.200}},
    {"guided", 64, 1.0f / 256, 8e-07, {0.172, 0.181, 0.184, 0.170, 0.161, 0.169}},
    {"calibrated", 13, 1.0f / 256, 2.2e-07, {0.404, 0.412, 0.475, 0.533, 0.536, 0.694}},
    {"calibrated", 38, 1.0f / 256, 4.3e-07, {0.348, 0.341, 0.326, 0.386, 0.464, 0.519}},
    {"calibrated", 63, 1.0f / 256, 6.3e-07, {0.318, 0.319, 0.319, 0.375, 0.426, 0.518}},
}};

}
