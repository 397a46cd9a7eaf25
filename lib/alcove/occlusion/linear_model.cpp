#include "alcove/occlusion/linear_model.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>

namespace alcove {
namespace {

constexpr std::size_t run = 64, most_runs = 1024;
constexpr double ridge = 1e-4; // of each feature's mean square, which is of the order of 1

}

void LinearModel::predict(std::span<const std::vector<float>> features, std::size_t begin, std::size_t end,
                          float* values) const {
    std::fill(values + begin, values + end, constant);
    for (std::size_t k = 0; k < weights.size(); ++k)
        for (std::size_t i = begin; i < end; ++i)
            values[i] += weights[k] * features[k][i];
}

LinearModel fit_linear_model(std::span<const std::vector<float>> features, std::span<const float> values,
                             std::size_t count) {
    const std::size_t runs = (count + run - 1) / run, used = std::min(runs, most_runs);
    const auto size = static_cast<Eigen::Index>(features.size() + 1);
    const auto column = [&](Eigen::Index k, std::size_t i) {
        return k == 0 ? 1.0f : features[static_cast<std::size_t>(k - 1)][i];
    };
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    double total = 0.0;
    for (std::size_t u = 0; u < used; ++u) {
        const std::size_t begin = u * runs / used * run, end = std::min(begin + run, count);
        total += static_cast<double>(end - begin);
        for (Eigen::Index a = 0; a < size; ++a) {
            for (Eigen::Index b = 0; b <= a; ++b) {
                float sum = 0.0f;
                for (std::size_t i = begin; i < end; ++i)
                    sum += column(a, i) * column(b, i);
                normal(a, b) += sum;
            }
            float sum = 0.0f;
            for (std::size_t i = begin; i < end; ++i)
                sum += column(a, i) * values[i];
            right(a) += sum;
        }
    }
    normal.diagonal().tail(size - 1).array() += ridge * total;
    const Eigen::VectorXd solution = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    LinearModel model{static_cast<float>(solution(0)), {}};
    for (Eigen::Index k = 1; k < size; ++k)
        model.weights.push_back(static_cast<float>(solution(k)));
    return model;
}

}
