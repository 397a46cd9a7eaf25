#include "alcove/bake/detail/error_figures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace alcove {

ErrorFigures compare(std::span<const float> values, std::span<const float> truth) {
    assert(values.size() == truth.size());
    ErrorFigures figures;
    figures.count = truth.size();
    if (truth.empty())
        return figures;
    const auto count = static_cast<double>(truth.size());
    std::vector<double> sizes;
    sizes.reserve(truth.size());
    double squares = 0.0, sum = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double error = double(values[i]) - double(truth[i]);
        sizes.push_back(std::fabs(error));
        squares += error * error;
        sum += error;
        mean += truth[i];
    }
    mean /= count;
    double spread = 0.0;
    for (const float t : truth)
        spread += (t - mean) * (t - mean);
    std::sort(sizes.begin(), sizes.end());
    figures.rmse = std::sqrt(squares / count);
    figures.bias = sum / count;
    figures.percentile_99 = sizes[(99 * sizes.size() + 99) / 100 - 1];
    figures.max = sizes.back();
    figures.deviation = std::sqrt(spread / count);
    return figures;
}

}
