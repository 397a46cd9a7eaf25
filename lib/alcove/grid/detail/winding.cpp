#include "alcove/grid/detail/winding.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace alcove {
namespace {

constexpr std::size_t grain = 8192; // triangles

struct Hit {
    std::uint32_t x, y;
    double z;
    std::uint32_t triangle;
    std::int32_t turn;
};

struct Corner { // on the snapping grid
    std::int64_t x, y;
    double z;
};

/// Twice the area of (a, b, p), positive where p is left of a to b.
std::int64_t left(const Corner& a, const Corner& b, std::int64_t x, std::int64_t y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// The nearest step of the snapping grid. A cast rounds down, as no coordinate is negative, and is faster than a call of
/// llround().
std::int64_t snapped(double coordinate, double scale) {
    constexpr double half_step = 0.5;
    return static_cast<std::int64_t>(coordinate * scale + half_step);
}

/// The cell of the columns that a position is in, as two packed indices. A triangle covers a column only if its corners
/// are in several cells along both axes, as columns on a side of a cell belong to the cell above, like those in owns().
std::uint64_t column_cell(const Vec3d& p, double scale, int shift) {
    const auto cell = [&](double x) { return static_cast<std::uint64_t>(snapped(x, scale) >> shift); };
    return is_finite(p) ? cell(p.x) << 32 | cell(p.y) : 0;
}

/// Exactly one of the two triangles at an edge owns the points on it.
bool owns(const Corner& a, const Corner& b) {
    return b.y > a.y || (b.y == a.y && b.x < a.x);
}

/// The columns of a row that a triangle may cover. For a long triangle, these are far fewer than the columns of its
/// bounding box.
std::pair<std::int64_t, std::int64_t> covered(const Corner (&corners)[3], std::int64_t x, std::int64_t one) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    const auto at = static_cast<double>(x * one);
    for (int k = 0; k < 3; ++k) {
        const Corner &a = corners[k], &b = corners[(k + 1) % 3];
        const auto run = static_cast<double>(b.x - a.x);
        const double t = run != 0.0 ? std::clamp((at - static_cast<double>(a.x)) / run, 0.0, 1.0) : 0.0;
        const double x_there = static_cast<double>(a.x) + t * run;
        if (std::fabs(x_there - at) > 1.0)
            continue;
        const auto y0 = static_cast<double>(a.y), y1 = static_cast<double>(b.y);
        const double y = y0 + t * (y1 - y0);
        least = std::min({least, y, run == 0.0 ? y1 : y});
        most = std::max({most, y, run == 0.0 ? y1 : y});
    }
    const auto step = static_cast<double>(one);
    return {static_cast<std::int64_t>(std::ceil((least - 1.0) / step)),
            static_cast<std::int64_t>(std::floor((most + 1.0) / step))};
}

/// Calls `visit(x, y, z)` for each column through a counterclockwise triangle.
template <class Visit>
void for_each_covered(const Corner& p, const Corner& q, const Corner& r, int shift, Visit&& visit) {
    const std::int64_t one = std::int64_t{1} << shift;
    const auto columns = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
        const auto [low, high] = std::minmax({a, b, c});
        return std::pair{(low + one - 1) >> shift, high >> shift};
    };
    const auto [x0, x1] = columns(p.x, q.x, r.x);
    const auto in_box = columns(p.y, q.y, r.y);
    const bool is_small = in_box.second - in_box.first < 4;
    for (std::int64_t x = x0; x <= x1; ++x) {
        const auto [y0, y1] = is_small ? in_box : covered({p, q, r}, x, one);
        for (std::int64_t y = y0; y <= y1; ++y) {
            const std::int64_t at_p = left(q, r, x * one, y * one), at_q = left(r, p, x * one, y * one),
                               at_r = left(p, q, x * one, y * one);
            if (at_p < 0 || at_q < 0 || at_r < 0 || (at_p == 0 && !owns(q, r)) || (at_q == 0 && !owns(r, p)) ||
                (at_r == 0 && !owns(p, q)))
                continue;
            const double z =
                static_cast<double>(at_p) * p.z + static_cast<double>(at_q) * q.z + static_cast<double>(at_r) * r.z;
            visit(x, y, z / static_cast<double>(at_p + at_q + at_r));
        }
    }
}

double extent_of(std::span<const Vec3d> positions) {
    double extent = 1.0;
    for (const Vec3d& p : positions)
        if (is_finite(p))
            extent = std::max({extent, p.x, p.y});
    return extent;
}

}

WindingColumns::WindingColumns(std::span<const Vec3d> positions, std::span<const Triangle> triangles)
    : WindingColumns(positions, triangles, extent_of(positions)) {}

WindingColumns::WindingColumns(std::span<const Vec3d> positions, std::span<const Triangle> triangles, double extent) {
    // Twice the product of two differences stays below 2^63.
    const int shift = 29 - std::ilogb(extent);
    const double scale = std::ldexp(1.0, shift);

    HugeVector<std::uint64_t> cells(positions.size());
    parallel_for(positions.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            cells[v] = column_cell(positions[v], scale, shift);
    });

    std::vector<std::vector<Hit>> hits((triangles.size() + grain - 1) / grain);
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::vector<Hit>& out = hits[begin / grain];
        for (std::size_t t = begin; t < end; ++t) {
            prefetch_corners(triangles, t, cells.data());
            const auto& [a, b, c] = triangles[t];
            const std::uint64_t differing = (cells[a] ^ cells[b]) | (cells[a] ^ cells[c]);
            const std::uint64_t along_x = differing >> 32, along_y = differing & 0xffffffff;
            if (((along_x - 1) | (along_y - 1)) >> 63) // one is 0; a single branch is mispredicted less often
                continue;
            const auto corner = [&](const Vec3d& at) {
                return Corner{snapped(at.x, scale), snapped(at.y, scale), at.z};
            };
            Corner p = corner(positions[a]), q = corner(positions[b]), r = corner(positions[c]);
            const std::int64_t area = left(p, q, r.x, r.y);
            if (area == 0)
                continue;
            if (area < 0)
                std::swap(q, r);
            // Going up, the solid begins at faces that point down.
            const std::int32_t turn = area < 0 ? 1 : -1;
            for_each_covered(p, q, r, shift, [&](std::int64_t x, std::int64_t y, double z) {
                out.push_back({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), z,
                               static_cast<std::uint32_t>(t), turn});
            });
        }
    });

    row_begin_.assign(static_cast<std::size_t>(extent) + 3, 0);
    for (const auto& block : hits)
        for (const Hit& hit : block)
            ++row_begin_[hit.x + 1];
    std::partial_sum(row_begin_.begin(), row_begin_.end(), row_begin_.begin());
    crossings_.resize(row_begin_.back());
    std::vector<std::size_t> next(row_begin_.begin(), row_begin_.end() - 1);
    for (const auto& block : hits)
        for (const Hit& hit : block)
            crossings_[next[hit.x]++] = {hit.z, hit.y, hit.triangle, hit.turn};
    parallel_for(row_begin_.size() - 1, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t x = begin; x < end; ++x)
            std::sort(crossings_.begin() + static_cast<std::ptrdiff_t>(row_begin_[x]),
                      crossings_.begin() + static_cast<std::ptrdiff_t>(row_begin_[x + 1]),
                      [](const Crossing& a, const Crossing& b) {
                          return a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : a.triangle < b.triangle;
                      });
    });
}

template <class Visit>
void WindingColumns::for_each_column(Visit&& visit) const {
    for (std::size_t x = 0; x + 1 < row_begin_.size(); ++x)
        for (std::size_t begin = row_begin_[x], end = begin; begin < row_begin_[x + 1]; begin = end) {
            while (end < row_begin_[x + 1] && crossings_[end].y == crossings_[begin].y)
                ++end;
            visit(std::span(crossings_).subspan(begin, end - begin));
        }
}

double WindingColumns::leaking() const {
    std::size_t columns = 0, leaks = 0;
    for_each_column([&](std::span<const Crossing> column) {
        int winding = 0;
        for (const Crossing& c : column)
            winding += c.turn;
        ++columns;
        leaks += winding != 0;
    });
    return columns == 0 ? 0.0 : static_cast<double>(leaks) / static_cast<double>(columns);
}

bool WindingColumns::overlapping() const {
    bool found = false;
    for_each_column([&](std::span<const Crossing> column) {
        int winding = 0;
        for (const Crossing& c : column) {
            winding += c.turn;
            found = found || winding < 0 || winding > 1;
        }
    });
    return found;
}

bool WindingColumns::hollow() const {
    constexpr double tolerance = 1e-6; // voxels
    bool found = false;
    for_each_column([&](std::span<const Crossing> column) {
        int winding = 0;
        for (std::size_t i = 0; i + 1 < column.size(); ++i) {
            winding += column[i].turn;
            found = found || (winding > 0 && column[i + 1].z - column[i].z > tolerance);
        }
    });
    return !found && !crossings_.empty();
}

double WindingColumns::in_air() const {
    std::size_t found = 0;
    for_each_column([&](std::span<const Crossing> column) {
        int winding = 0;
        for (const Crossing& c : column) {
            const int before = winding;
            winding += c.turn;
            found += before < 1 && winding < 1;
        }
    });
    return crossings_.empty() ? 0.0 : static_cast<double>(found) / static_cast<double>(crossings_.size());
}

void WindingColumns::for_each_crossing(const std::function<void(std::uint32_t, bool)>& visit) const {
    for_each_column([&](std::span<const Crossing> column) {
        int winding = 0;
        for (const Crossing& c : column) {
            const int before = winding;
            winding += c.turn;
            visit(c.triangle, (before < 1) != (winding < 1));
        }
    });
}

/// The first crossing at or after column `y`, by exponential search: cheap if it is near `begin`.
std::vector<WindingColumns::Crossing>::const_iterator
WindingColumns::column_from(std::vector<Crossing>::const_iterator begin, std::vector<Crossing>::const_iterator end,
                            std::uint32_t y) {
    std::ptrdiff_t step = 4;
    while (step < end - begin && begin[step].y < y) {
        begin += step;
        step *= 2;
    }
    return std::lower_bound(begin, begin + std::min(step, end - begin), y,
                            [](const Crossing& c, std::uint32_t v) { return c.y < v; });
}

std::array<std::uint8_t, brick_rows> WindingColumns::inside(const Block& brick) const {
    std::array<std::uint8_t, brick_rows> rows{};
    for (int i = 0; i < brick_size; ++i) {
        const auto x = static_cast<std::size_t>(brick.low.x + i) * static_cast<std::size_t>(brick.stride);
        if (x + 1 >= row_begin_.size())
            break;
        const auto row_end = crossings_.begin() + static_cast<std::ptrdiff_t>(row_begin_[x + 1]);
        auto at = crossings_.begin() + static_cast<std::ptrdiff_t>(row_begin_[x]);
        for (int j = 0; j < brick_size; ++j) {
            const auto y = static_cast<std::uint32_t>((brick.low.y + j) * brick.stride);
            at = column_from(at, row_end, y);
            int above = 0;
            for (auto c = at; c != row_end && c->y == y; ++c)
                above -= c->turn;
            int below = 0;
            std::uint8_t& row = rows[static_cast<std::size_t>(i) * brick_size + static_cast<std::size_t>(j)];
            for (int k = 0; k < brick_size; ++k) {
                const double z = double(brick.low.z + k) * brick.stride;
                for (; at != row_end && at->y == y && at->z <= z; ++at) {
                    below += at->turn;
                    above += at->turn;
                }
                if (below >= 1 && above >= 1)
                    row |= static_cast<std::uint8_t>(1u << k);
            }
        }
    }
    return rows;
}

}
