/// Deterministic training of a small network.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace alcove::fit {

struct Layer {
    Eigen::MatrixXf weights;
    Eigen::VectorXf bias;
};

/// Rectified linear units (Nair and Hinton 2010) in all layers except the last.
struct Network {
    std::vector<Layer> layers;

    /// One value per column of inputs.
    Eigen::RowVectorXf operator()(const Eigen::MatrixXf& inputs) const;
};

struct TrainingSet {
    Eigen::MatrixXf inputs; ///< one column per example
    Eigen::VectorXf truth;
    Eigen::VectorXf weights; ///< of the examples, with a mean of 1
};

/// Trains a network with hidden layers of 16 and 8 units. Its value, clamped to [0, 1], approximates the truth, and is
/// 1 for inputs of 0. The loss is quadratic below 0.1 and linear above (Huber 1964), to limit the influence of meshes
/// whose occlusion the probes cannot predict. The optimizer is Adam (Kingma and Ba 2015).
Network train(const TrainingSet& set);

}
