/// Training examples: the inputs of the estimator, and the ao of exact rays.
#pragma once

#include "alcove/occlusion/methods/calibrated_inputs.h"

#include <Eigen/Core>

#include <filesystem>
#include <vector>

namespace alcove::fit {

/// Radii of the fit, as fractions of the diagonal, in descending order.
inline constexpr std::array radii{0.5f, 0.2f, 0.1f, 0.05f, 0.02f};

/// Examples from the surfels of a mesh at one radius.
struct Examples {
    Eigen::VectorXf truth;
    Eigen::MatrixXf ten, twenty_four; ///< inputs of either network, one column per surfel
};

/// Makes one set per radius, from at most `max_surfels` vertices, evenly chosen in file order. The truth is of `rays`
/// rays per vertex; the grids are those of a bake at that radius.
std::array<Examples, radii.size()> make_examples(const std::filesystem::path& mesh, std::size_t max_surfels, int rays);

}
