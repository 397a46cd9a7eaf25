#include "alcove/maps/detail/rasterize.h"

#include "alcove/base/detail/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace alcove {
namespace {

constexpr std::int64_t steps = 256; // per texel, of the grid to which UVs are rounded

struct Point {
    std::int64_t x, y;
};

/// Pixel coordinates: y down, the origin at the top left of the tile.
glm::dvec2 pixel_of(const Vec2& uv, const UvTile& tile) {
    return {(double(uv.x) - double(tile.corner.x)) * tile.width,
            (1.0 - (double(uv.y) - double(tile.corner.y))) * tile.height};
}

std::int64_t floor_of_ratio(std::int64_t a, std::int64_t b) {
    const std::int64_t quotient = a / b;
    return quotient - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

std::int64_t ceil_of_ratio(std::int64_t a, std::int64_t b) {
    return -floor_of_ratio(-a, b);
}

/// Columns [begin, end) of a row.
struct Span {
    std::int64_t begin, end;
};

/// Fills the texels of one tile. Runs of texels that are done are skipped, so each of many overlapping triangles costs
/// little more than a visit to its rows.
class Rasterizer {
  public:
    explicit Rasterizer(const UvTile& tile) : tile_(tile) {
        const std::size_t count = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
        owners_.width = tile.width;
        owners_.height = tile.height;
        owners_.triangles.assign(count, no_triangle);
        skips_.assign(count, 0);
    }

    /// Claims the texels whose centres the triangle contains.
    void add_centres(const UvTriangle& uvs, std::uint32_t triangle) {
        std::array<Point, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2 pixel = pixel_of(uvs[k], tile_);
            p[k] = {std::llround(pixel.x * steps), std::llround(pixel.y * steps)};
        }
        const std::int64_t area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
        if (area == 0)
            return;
        if (area < 0)
            std::swap(p[1], p[2]);
        const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
        const std::int64_t first = std::max<std::int64_t>(floor_of_ratio(low, steps) - 1, 0),
                           last = std::min<std::int64_t>(floor_of_ratio(high, steps) + 1, tile_.height - 1);
        for (std::int64_t row = first; row <= last; ++row) {
            Span span{0, tile_.width};
            for (std::size_t k = 0; k < 3; ++k)
                clip(span, p[k], p[(k + 1) % 3], row);
            claim_or_count(row, span, triangle);
        }
    }

    /// Claims all texels that the triangle touches and that are still free. Call after add_centres() for all triangles
    /// and start_borders().
    void add_border(const UvTriangle& uvs, std::uint32_t triangle) {
        std::array<glm::dvec2, 3> p;
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = pixel_of(uvs[k], tile_);
            low = std::min(low, p[k].y);
            high = std::max(high, p[k].y);
        }
        const auto first = static_cast<std::int64_t>(std::clamp(std::floor(low), 0.0, double(tile_.height))),
                   last = static_cast<std::int64_t>(std::clamp(std::floor(high), -1.0, double(tile_.height) - 1.0));
        for (std::int64_t row = first; row <= last; ++row) {
            // The range of x that the triangle covers in the row.
            double least = std::numeric_limits<double>::infinity(), most = -least;
            const double top = static_cast<double>(row), bottom = top + 1.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec2 &a = p[k], &b = p[(k + 1) % 3];
                if (std::max(a.y, b.y) < top || std::min(a.y, b.y) > bottom)
                    continue;
                const auto x_at = [&](double y) {
                    return a.y == b.y ? a.x : a.x + std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0) * (b.x - a.x);
                };
                for (const double x : {x_at(std::clamp(a.y, top, bottom)), x_at(std::clamp(b.y, top, bottom))}) {
                    least = std::min(least, x);
                    most = std::max(most, x);
                }
                if (a.y == b.y) {
                    least = std::min(least, b.x);
                    most = std::max(most, b.x);
                }
            }
            if (least > most)
                continue;
            claim(row,
                  {static_cast<std::int64_t>(std::clamp(std::floor(least), 0.0, double(tile_.width))),
                   static_cast<std::int64_t>(std::clamp(std::floor(most) + 1.0, 0.0, double(tile_.width)))},
                  triangle);
        }
    }

    void start_borders() { std::fill(skips_.begin(), skips_.end(), std::uint16_t{0}); }

    TexelOwners take() { return std::move(owners_); }

  private:
    /// Limits the span to centres on the inner side of an edge from a to b. Centres on an edge belong to the triangle
    /// whose top or left edge it is.
    static void clip(Span& span, const Point& a, const Point& b, std::int64_t row) {
        const std::int64_t dx = b.x - a.x, dy = b.y - a.y, y = row * steps + steps / 2;
        const bool top_or_left = dy < 0 || (dy == 0 && dx > 0);
        // inside: dx (y - a.y) - dy (x - a.x) >= least, x = column * steps + steps / 2
        const std::int64_t least = top_or_left ? 0 : 1, value = dx * (y - a.y) + dy * (a.x - steps / 2) - least;
        if (dy > 0)
            span.end = std::min(span.end, floor_of_ratio(value, dy * steps) + 1);
        else if (dy < 0)
            span.begin = std::max(span.begin, ceil_of_ratio(-value, -dy * steps));
        else if (value < 0)
            span.end = span.begin;
    }

    /// Free texels become the triangle's; texels that are already owned count as overlaps, once each.
    void claim_or_count(std::int64_t row, const Span& span, std::uint32_t triangle) {
        each(row, span, [&](std::size_t texel) {
            if (owners_.triangles[texel] == no_triangle) {
                owners_.triangles[texel] = triangle;
                return false;
            }
            ++owners_.overlaps;
            return true;
        });
    }

    void claim(std::int64_t row, const Span& span, std::uint32_t triangle) {
        each(row, span, [&](std::size_t texel) {
            if (owners_.triangles[texel] == no_triangle)
                owners_.triangles[texel] = triangle;
            return true;
        });
    }

    /// Calls `visit` for each texel of a span, except the texels for which `visit` has returned true before.
    template <class Visit>
    void each(std::int64_t row, const Span& span, const Visit& visit) {
        constexpr std::size_t longest = std::numeric_limits<std::uint16_t>::max();
        const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(tile_.width);
        const std::size_t end = start + static_cast<std::size_t>(std::max(span.end, span.begin));
        std::size_t run = start + static_cast<std::size_t>(span.begin);
        for (std::size_t texel = run; texel < end;) {
            if (skips_[texel] > 0)
                texel += skips_[texel];
            else if (visit(texel))
                skips_[texel++] = 1;
            else
                run = ++texel;
            if (texel > run)
                skips_[run] = static_cast<std::uint16_t>(std::min(texel - run, longest));
        }
    }

    UvTile tile_;
    TexelOwners owners_;
    std::vector<std::uint16_t> skips_; // number of texels from this one on that are done; 0 if this one is not
};

}

TexelOwners rasterize(std::span<const UvTriangle> triangles, const UvTile& tile) {
    Rasterizer rasterizer(tile);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        rasterizer.add_centres(triangles[t], t);
    rasterizer.start_borders();
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        rasterizer.add_border(triangles[t], t);
    return rasterizer.take();
}

Vec3d weights_at(const UvTriangle& triangle, const UvTile& tile, std::size_t texel) {
    const auto column = static_cast<double>(texel % static_cast<std::size_t>(tile.width)),
               row = static_cast<double>(texel / static_cast<std::size_t>(tile.width));
    const Vec3d centre(column + 0.5, row + 0.5, 0.0);
    std::array<Vec3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = Vec3d(pixel_of(triangle[k], tile), 0.0);
    const auto area = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    };
    const double per_area = 1.0 / area(p[0], p[1], p[2]);
    const auto at = [&](const Vec3d& point) {
        return per_area * Vec3d(area(p[1], p[2], point), area(p[2], p[0], point), area(p[0], p[1], point));
    };
    const Vec3d inside = at(centre);
    if (inside.x >= 0.0 && inside.y >= 0.0 && inside.z >= 0.0)
        return inside;
    const Vec3d weights = glm::max(at(centre - closest_on_triangle(p[0], p[1], p[2], centre).offset), 0.0);
    return weights / (weights.x + weights.y + weights.z);
}

}
