/// Training of a small network, always the same for the same examples.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace alcove::fit {

struct Layer {
    Eigen::MatrixXf weights;
    Eigen::VectorXf bias;
};

/// Rectified units in all layers but the last.
struct Network {
    std::vector<Layer> layers;

    /// A value a column.
    Eigen::RowVectorXf operator()(const Eigen::MatrixXf& inputs) const;
};

struct TrainingSet {
    Eigen::MatrixXf inputs; ///< a column an example
    Eigen::VectorXf truth;
    Eigen::VectorXf weights; ///< of the examples; their mean is 1
};

/// A network of hidden layers of 16 and 8 units whose value, clamped to [0, 1], is near the truth, and 1 for
/// inputs of 0. The loss is Huber's with its bend at 0.1, so that meshes no probe can tell anything of have
/// little say. P. J. Huber, "Robust estimation of a location parameter" (1964); D. P. Kingma, J. Ba, "Adam: a
/// method for stochastic optimization" (2015).
Network train(const TrainingSet& set);

}
