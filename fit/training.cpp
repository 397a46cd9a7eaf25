#include "training.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace alcove::fit {
namespace {

constexpr int epochs = 30;
constexpr Eigen::Index batch = 256;
constexpr float learning_rate = 4e-3f, min_learning_rate = 1e-5f;
constexpr float huber_threshold = 0.1f;

/// The optimizer Adam for one parameter matrix (Kingma and Ba 2015).
template <class M>
class Adam {
  public:
    explicit Adam(const M& like) : mean_(M::Zero(like.rows(), like.cols())), square_(mean_) {}

    void step(M& value, const M& gradient, float rate, int steps_before) {
        constexpr float mean_decay = 0.9f, square_decay = 0.999f;
        mean_ = mean_decay * mean_ + (1.0f - mean_decay) * gradient;
        square_ = square_decay * square_ + (1.0f - square_decay) * gradient.cwiseAbs2();
        const auto steps = static_cast<float>(steps_before + 1);
        const float mean_scale = 1.0f / (1.0f - std::pow(mean_decay, steps));
        const float square_scale = 1.0f / (1.0f - std::pow(square_decay, steps));
        value.array() -= rate * mean_scale * mean_.array() / ((square_scale * square_.array()).sqrt() + 1e-8f);
    }

  private:
    M mean_, square_;
};

struct LayerAdam {
    Adam<Eigen::MatrixXf> weights;
    Adam<Eigen::VectorXf> bias;
};

Network random_network(Eigen::Index inputs, std::mt19937& random) {
    std::normal_distribution<float> normal;
    const std::vector<Eigen::Index> units{inputs, 16, 8, 1};
    Network network;
    for (std::size_t l = 0; l + 1 < units.size(); ++l) {
        const float spread = std::sqrt(2.0f / static_cast<float>(units[l]));
        Layer layer;
        layer.weights = Eigen::MatrixXf::NullaryExpr(units[l + 1], units[l], [&] { return spread * normal(random); });
        layer.bias = Eigen::VectorXf::NullaryExpr(units[l + 1], [&] { return 0.1f * normal(random); });
        network.layers.push_back(std::move(layer));
    }
    return network;
}

/// The values of every layer, starting with the inputs.
std::vector<Eigen::MatrixXf> values_of(const Network& network, const Eigen::MatrixXf& inputs) {
    std::vector<Eigen::MatrixXf> values{inputs};
    for (std::size_t l = 0; l < network.layers.size(); ++l) {
        const Layer& layer = network.layers[l];
        Eigen::MatrixXf next = (layer.weights * values.back()).colwise() + layer.bias;
        if (l + 1 < network.layers.size())
            next = next.cwiseMax(0.0f);
        values.push_back(std::move(next));
    }
    return values;
}

/// Derivative of the Huber loss of the clamped value; the gradient passes through the clamp unless the clamped value is
/// correct.
float slope(float value, float truth) {
    return std::clamp(2.0f * (std::clamp(value, 0.0f, 1.0f) - truth), -2.0f * huber_threshold, 2.0f * huber_threshold);
}

}

Eigen::RowVectorXf Network::operator()(const Eigen::MatrixXf& inputs) const {
    return values_of(*this, inputs).back();
}

Network train(const TrainingSet& set) {
    std::mt19937 random(1);
    Network network = random_network(set.inputs.rows(), random);
    std::vector<LayerAdam> adam;
    for (const Layer& layer : network.layers)
        adam.push_back({Adam(layer.weights), Adam(layer.bias)});
    std::vector<Eigen::Index> order(static_cast<std::size_t>(set.truth.size()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});

    const auto batches = static_cast<int>(set.truth.size() / batch), steps = epochs * batches;
    // The last column stays 0: these are the inputs over a plane, whose value is subtracted from all others.
    Eigen::MatrixXf inputs = Eigen::MatrixXf::Zero(set.inputs.rows(), batch + 1);
    for (int step = 0; step < steps; ++step) {
        if (step % batches == 0)
            std::shuffle(order.begin(), order.end(), random);
        const Eigen::Index* chosen = order.data() + step % batches * batch;
        for (Eigen::Index k = 0; k < batch; ++k)
            inputs.col(k) = set.inputs.col(chosen[k]);
        const std::vector<Eigen::MatrixXf> values = values_of(network, inputs);
        Eigen::MatrixXf gradient(1, batch + 1);
        for (Eigen::Index k = 0; k < batch; ++k) {
            const float value = 1.0f + values.back()(0, k) - values.back()(0, batch);
            gradient(0, k) = slope(value, set.truth[chosen[k]]) * set.weights[chosen[k]] / static_cast<float>(batch);
        }
        gradient(0, batch) = -gradient.leftCols(batch).sum();

        const float progress = static_cast<float>(step) / static_cast<float>(steps);
        const float rate =
            std::max(0.5f * learning_rate * (1.0f + std::cos(std::numbers::pi_v<float> * progress)), min_learning_rate);
        for (std::size_t l = network.layers.size(); l-- > 0;) {
            Layer& layer = network.layers[l];
            const Eigen::MatrixXf by_weights = gradient * values[l].transpose();
            const Eigen::VectorXf by_bias = gradient.rowwise().sum();
            if (l > 0)
                gradient = (values[l].array() > 0.0f).select(layer.weights.transpose() * gradient, 0.0f).eval();
            adam[l].weights.step(layer.weights, by_weights, rate, step);
            adam[l].bias.step(layer.bias, by_bias, rate, step);
        }
    }
    const Eigen::MatrixXf plane = Eigen::MatrixXf::Zero(set.inputs.rows(), 1);
    network.layers.back().bias[0] += 1.0f - network(plane)(0);
    return network;
}

}
