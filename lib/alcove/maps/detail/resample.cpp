#include "alcove/maps/detail/resample.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// The weights of successive texels of a row or column. A new texel is their weighted mean.
struct Weights {
    std::size_t first = 0;
    std::vector<float> shares;
};

std::vector<Weights> weights_of(int from, int to) {
    std::vector<Weights> all(static_cast<std::size_t>(to));
    const double step = static_cast<double>(from) / to;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto at = static_cast<double>(i);
        if (from > to) {
            const double begin = at * step, end = std::min((at + 1.0) * step, static_cast<double>(from));
            all[i].first = static_cast<std::size_t>(begin);
            for (std::size_t texel = all[i].first; static_cast<double>(texel) < end; ++texel) {
                const auto left = static_cast<double>(texel);
                const double share = std::min(left + 1.0, end) - std::max(left, begin);
                all[i].shares.push_back(static_cast<float>(share / (end - begin)));
            }
        } else {
            const double place = std::clamp((at + 0.5) * step - 0.5, 0.0, static_cast<double>(from - 1));
            const auto right = static_cast<float>(place - std::floor(place));
            all[i].first = static_cast<std::size_t>(place);
            all[i].shares.push_back(1.0f - right);
            if (right > 0.0f)
                all[i].shares.push_back(right);
        }
    }
    return all;
}

}

std::vector<float> resample(std::span<const float> values, std::size_t channels, MapSize from, MapSize to) {
    if (from == to)
        return {values.begin(), values.end()};
    const std::vector<Weights> columns = weights_of(from.width, to.width), rows = weights_of(from.height, to.height);
    const std::size_t old_row = channels * static_cast<std::size_t>(from.width), new_row = channels * columns.size();
    std::vector<float> result(new_row * rows.size(), 0.0f), mean(old_row);
    for (std::size_t y = 0; y < rows.size(); ++y) {
        std::fill(mean.begin(), mean.end(), 0.0f);
        for (std::size_t k = 0; k < rows[y].shares.size(); ++k) {
            const float* const row = values.data() + (rows[y].first + k) * old_row;
            for (std::size_t i = 0; i < old_row; ++i)
                mean[i] += rows[y].shares[k] * row[i];
        }
        for (std::size_t x = 0; x < columns.size(); ++x)
            for (std::size_t k = 0; k < columns[x].shares.size(); ++k)
                for (std::size_t c = 0; c < channels; ++c)
                    result[y * new_row + x * channels + c] +=
                        columns[x].shares[k] * mean[(columns[x].first + k) * channels + c];
    }
    return result;
}

}
