#include "alcove/maps/detail/padding.h"

#include "alcove/base/parallel.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace alcove {
namespace {

constexpr std::int64_t far = std::numeric_limits<std::int32_t>::max();

/// For each texel, the row of the nearest covered texel in its column; -1 if the column has none.
std::vector<std::int32_t> nearest_rows(std::span<const std::uint8_t> covered, std::size_t width, std::size_t height) {
    std::vector<std::int32_t> rows(covered.size());
    std::vector<std::int32_t> last(width, -1);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            if (covered[y * width + x])
                last[x] = static_cast<std::int32_t>(y);
            rows[y * width + x] = last[x];
        }
    std::fill(last.begin(), last.end(), -1);
    for (std::size_t y = height; y-- > 0;)
        for (std::size_t x = 0; x < width; ++x) {
            std::int32_t& above = rows[y * width + x];
            if (covered[y * width + x])
                last[x] = static_cast<std::int32_t>(y);
            const auto row = static_cast<std::int32_t>(y);
            if (last[x] >= 0 && (above < 0 || last[x] - row < row - above))
                above = last[x];
        }
    return rows;
}

/// The lower envelope of the parabolas (x − i)² + heights[i].
class Envelope {
  public:
    explicit Envelope(std::size_t width) : sites_(width), starts_(width) {}

    /// Calls `visit(x, site)` for each x, where `site` is the lowest parabola at x. If all heights are `far`, `visit`
    /// is not called.
    template <class Visit>
    void each(std::span<const std::int64_t> heights, const Visit& visit) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < heights.size(); ++i) {
            if (heights[i] == far)
                continue;
            double start = 0.0;
            while (count > 0) {
                start = crossing(heights, sites_[count - 1], i);
                if (start > starts_[count - 1])
                    break;
                --count;
            }
            sites_[count] = i;
            starts_[count] = start;
            ++count;
        }
        for (std::size_t x = 0, k = 0; count > 0 && x < heights.size(); ++x) {
            while (k + 1 < count && starts_[k + 1] < static_cast<double>(x))
                ++k;
            visit(x, sites_[k]);
        }
    }

  private:
    static double crossing(std::span<const std::int64_t> heights, std::size_t a, std::size_t b) {
        const auto left = static_cast<double>(a), right = static_cast<double>(b);
        return (static_cast<double>(heights[b]) + right * right - static_cast<double>(heights[a]) - left * left) /
               (2.0 * (right - left));
    }

    std::vector<std::size_t> sites_;
    std::vector<double> starts_; // x from which a site is the lowest
};

}

std::vector<std::uint32_t> nearest_covered(std::span<const std::uint8_t> covered, int width, int height, int margin) {
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    const std::int64_t most = 2 * std::int64_t{margin} * margin;
    std::vector<std::uint32_t> nearest(covered.size());
    std::iota(nearest.begin(), nearest.end(), 0u);
    if (margin == 0)
        return nearest;
    const std::vector<std::int32_t> row_of = nearest_rows(covered, columns, rows);
    parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
        Envelope envelope(columns);
        std::vector<std::int64_t> heights;
        for (std::size_t y = begin; y < end; ++y) {
            const std::uint8_t* const is_covered = covered.data() + y * columns;
            const auto height_at = [&](std::size_t x) {
                const std::int64_t row = row_of[y * columns + x], away = row - static_cast<std::int64_t>(y);
                return row < 0 || away * away > most ? far : away * away;
            };
            for (std::size_t x = 0; x < columns; ++x) {
                if (is_covered[x])
                    continue;
                // A run of uncovered texels, and the covered texels at its ends. No covered texel beyond these ends is
                // nearer.
                const std::size_t first = x - (x > 0);
                heights.assign(x - first, 0);
                bool is_near = x > first;
                for (; x < columns && !is_covered[x]; ++x) {
                    heights.push_back(height_at(x));
                    is_near = is_near || heights.back() != far;
                }
                if (x < columns)
                    heights.push_back(0);
                else if (!is_near)
                    continue;
                envelope.each(heights, [&](std::size_t at, std::size_t site) {
                    const std::int64_t across = static_cast<std::int64_t>(at) - static_cast<std::int64_t>(site);
                    if (!is_covered[first + at] && across * across + heights[site] <= most)
                        nearest[y * columns + first + at] = static_cast<std::uint32_t>(
                            static_cast<std::size_t>(row_of[y * columns + first + site]) * columns + first + site);
                });
            }
        }
    });
    return nearest;
}

}
