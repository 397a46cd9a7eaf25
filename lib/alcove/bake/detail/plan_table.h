/// The errors and costs that the planner chooses by. Written by build/fit/alcove_fit_plans: do not edit.
#pragma once

#include <array>
#include <string_view>

// clang-format off
namespace alcove::plan_table {

/// As fractions of the diagonal; 1 stands for all larger radii.
inline constexpr std::array radii{0.02, 0.05, 0.1, 0.2, 0.5, 1.0};

/// CPU seconds. Costs per ray are for each radius, among 2^doublings_of_rays triangles.
inline constexpr std::array seconds_per_ray{8.9e-08, 9.57e-08, 1.01e-07, 1.08e-07, 1.12e-07, 1.12e-07};
inline constexpr double doublings_of_rays = 17;
inline constexpr double rays_slower_per_doubling = 0.077;
inline constexpr double tree_seconds_per_triangle = 1.82e-07;
inline constexpr double seconds_per_grid = 0.00159;
inline constexpr double grid_seconds_per_triangle = 4.04e-07; ///< per voxelized triangle
inline constexpr double clustering_seconds_per_triangle = 6.38e-08; ///< per triangle that clustering removes
inline constexpr double grid_seconds_per_voxel = 1.08e-06; ///< per finest voxel on the surface: area / voxel²
inline constexpr double grid_seconds_of_both = 3.62e-07; ///< per geometric mean of voxelized triangles and such voxels

struct Row {
    std::string_view method;
    int samples;
    float largest_voxel;       ///< as in GridOptions
    double seconds_per_surfel; ///< without its rays
    /// RMSE / Pilot::difficulty(), median over the meshes, at each radius.
    std::array<double, radii.size()> error_per_difficulty;
};
inline constexpr std::array<Row, 28> rows{{
    {"guided", 1, 1.0f / 64, 5.6e-07, {0.913, 0.921, 0.969, 0.946, 0.933, 0.985}},
    {"guided", 2, 1.0f / 64, 5.5e-07, {0.651, 0.669, 0.743, 0.709, 0.730, 0.705}},
    {"guided", 3, 1.0f / 64, 5.8e-07, {0.513, 0.552, 0.618, 0.650, 0.570, 0.597}},
    {"guided", 4, 1.0f / 64, 5.8e-07, {0.510, 0.525, 0.591, 0.531, 0.524, 0.583}},
    {"guided", 6, 1.0f / 64, 5.9e-07, {0.422, 0.464, 0.521, 0.510, 0.445, 0.534}},
    {"guided", 8, 1.0f / 64, 6.2e-07, {0.410, 0.444, 0.450, 0.412, 0.376, 0.455}},
    {"guided", 11, 1.0f / 64, 6.5e-07, {0.349, 0.380, 0.420, 0.350, 0.379, 0.422}},
    {"guided", 16, 1.0f / 64, 6.5e-07, {0.340, 0.346, 0.353, 0.327, 0.318, 0.380}},
    {"guided", 22, 1.0f / 64, 6.8e-07, {0.286, 0.313, 0.312, 0.277, 0.296, 0.333}},
    {"guided", 32, 1.0f / 64, 6.4e-07, {0.252, 0.263, 0.280, 0.240, 0.239, 0.259}},
    {"guided", 45, 1.0f / 64, 6.3e-07, {0.215, 0.236, 0.227, 0.217, 0.214, 0.216}},
    {"guided", 64, 1.0f / 64, 5.3e-07, {0.190, 0.187, 0.193, 0.175, 0.171, 0.176}},
    {"calibrated", 10, 1.0f / 64, 1.3e-07, {0.679, 0.796, 0.862, 0.815, 0.911, 1.301}},
    {"calibrated", 24, 1.0f / 64, 2.1e-07, {0.578, 0.695, 0.932, 0.873, 0.854, 1.122}},
    {"guided", 1, 1.0f / 256, 5.8e-07, {0.913, 0.874, 0.904, 0.942, 0.939, 0.985}},
    {"guided", 2, 1.0f / 256, 5.6e-07, {0.651, 0.628, 0.689, 0.710, 0.710, 0.705}},
    {"guided", 3, 1.0f / 256, 5.9e-07, {0.513, 0.523, 0.604, 0.588, 0.577, 0.597}},
    {"guided", 4, 1.0f / 256, 6e-07, {0.510, 0.507, 0.552, 0.536, 0.516, 0.583}},
    {"guided", 6, 1.0f / 256, 6.1e-07, {0.422, 0.454, 0.490, 0.494, 0.446, 0.534}},
    {"guided", 8, 1.0f / 256, 6.4e-07, {0.410, 0.405, 0.416, 0.422, 0.370, 0.455}},
    {"guided", 11, 1.0f / 256, 6.4e-07, {0.349, 0.359, 0.393, 0.347, 0.380, 0.422}},
    {"guided", 16, 1.0f / 256, 6.6e-07, {0.340, 0.337, 0.334, 0.324, 0.321, 0.380}},
    {"guided", 22, 1.0f / 256, 6.8e-07, {0.286, 0.296, 0.292, 0.271, 0.294, 0.333}},
    {"guided", 32, 1.0f / 256, 6.5e-07, {0.252, 0.256, 0.263, 0.238, 0.248, 0.259}},
    {"guided", 45, 1.0f / 256, 6.4e-07, {0.215, 0.232, 0.228, 0.218, 0.213, 0.216}},
    {"guided", 64, 1.0f / 256, 5.3e-07, {0.190, 0.189, 0.189, 0.174, 0.171, 0.176}},
    {"calibrated", 10, 1.0f / 256, 1.5e-07, {0.679, 0.662, 0.716, 0.842, 0.916, 1.301}},
    {"calibrated", 24, 1.0f / 256, 2.5e-07, {0.578, 0.565, 0.616, 0.708, 0.763, 1.131}},
}};

}
