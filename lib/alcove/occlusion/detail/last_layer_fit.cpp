#include "alcove/occlusion/detail/last_layer_fit.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace alcove {

LastLayerFit::LastLayerFit(const RingNetwork::LastLayer& trained)
    : trained_(trained), products_(trained.size() * trained.size(), 0.0), errors_(trained.size(), 0.0) {}

void LastLayerFit::add(const RingNetwork::Hidden& h, std::span<const float> ao) {
    for (std::size_t k = 0; k < ao.size(); ++k) {
        double value = 1.0;
        for (std::size_t i = 0; i < h.size(); ++i)
            value += double(trained_[i]) * h[i][k];
        // Errors that the clamp removes do not count.
        const double error = double(ao[k]) - std::clamp(value, 0.0, 1.0);
        for (std::size_t i = 0; i < h.size(); ++i) {
            errors_[i] += h[i][k] * error;
            for (std::size_t j = 0; j < h.size(); ++j)
                products_[i * h.size() + j] += double(h[i][k]) * h[j][k];
        }
    }
}

RingNetwork::LastLayer LastLayerFit::layer() const {
    constexpr double ridge = 1.0; // tuned on scans and parts, with 250 to 2,000 examples
    constexpr auto n = static_cast<Eigen::Index>(RingNetwork::hidden);
    Eigen::MatrixXd matrix = Eigen::Map<const Eigen::MatrixXd>(products_.data(), n, n);
    matrix.diagonal().array() += ridge;
    const Eigen::VectorXd change = matrix.ldlt().solve(Eigen::Map<const Eigen::VectorXd>(errors_.data(), n));
    RingNetwork::LastLayer layer = trained_;
    for (std::size_t i = 0; i < layer.size(); ++i)
        layer[i] += static_cast<float>(change[static_cast<Eigen::Index>(i)]);
    return layer;
}

}
