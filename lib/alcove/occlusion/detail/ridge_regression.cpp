#include "alcove/occlusion/detail/ridge_regression.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace alcove {
namespace {

constexpr std::size_t run = 64, min_runs = 64, max_runs = 256;
constexpr double ridge = 1e-3; // per value; the mean square of each term is of the order of 1

}

void RidgeRegression::predict(std::span<const float* const> features, std::size_t begin, std::size_t end,
                              float* values) const {
    for (std::size_t at = begin; at < end; at += run) {
        const std::size_t lanes = std::min(run, end - at);
        std::fill_n(values + at, lanes, weights[0]);
        for (std::size_t i = 0; i < features.size(); ++i)
            for (std::size_t k = 0; k < lanes; ++k)
                values[at + k] += weights[i + 1] * features[i][at + k];
    }
}

RidgeRegression fit_linear_model(std::span<const float* const> features, std::span<const float> values,
                                 std::size_t count) {
    const std::size_t runs = (count + run - 1) / run, used = std::min(runs, std::clamp(runs / 4, min_runs, max_runs));
    const auto terms = static_cast<Eigen::Index>(features.size() + 1);
    using Array = Eigen::Array<float, run, 1>;
    Eigen::MatrixXf block = Eigen::MatrixXf::Zero(run, terms);
    Eigen::MatrixXf products(terms, terms);
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
    double total = 0.0;
    for (std::size_t u = 0; u < used; ++u) {
        const std::size_t begin = u * runs / used * run, lanes = std::min(run, count - begin);
        const auto column = [&](const float* from) {
            Array array = Array::Zero();
            std::copy_n(from + begin, lanes, array.data());
            return array;
        };
        block.col(0).setZero();
        block.col(0).head(static_cast<Eigen::Index>(lanes)).setOnes();
        for (Eigen::Index term = 1; term < terms; ++term)
            block.col(term) = column(features[static_cast<std::size_t>(term - 1)]);
        products.setZero();
        products.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
        normal += products.cast<double>();
        right += (block.transpose() * column(values.data()).matrix()).cast<double>();
        total += static_cast<double>(lanes);
    }
    normal.diagonal().tail(terms - 1).array() += ridge * total;
    const Eigen::VectorXd solution = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    RidgeRegression model;
    for (const double weight : solution)
        model.weights.push_back(static_cast<float>(weight));
    return model;
}

}
