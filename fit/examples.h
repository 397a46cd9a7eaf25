/// What the network is to learn: the inputs of the estimator, and the ao of exact rays.
#pragma once

#include "alcove/occlusion/methods/calibrated_inputs.h"

#include <Eigen/Core>

#include <filesystem>
#include <vector>

namespace alcove::fit {

/// Radii that are fitted, in parts of the diagonal D, falling.
inline constexpr std::array radii{0.5f, 0.2f, 0.1f, 0.05f, 0.02f};

/// Surfels of a mesh, seen at one radius.
struct Examples {
    Eigen::VectorXf truth;
    Eigen::MatrixXf ten, twenty_four; ///< inputs of either network, a column a surfel
};

/// At most `surfels` vertices, evenly from the file's order, and `rays` rays each for the truth; the grids are
/// those of a bake at that radius. One set a radius.
std::array<Examples, radii.size()> make_examples(const std::filesystem::path& mesh, std::size_t surfels,
                                                 int rays);

}
