#include "alcove/measure/detail/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace alcove {
namespace {

constexpr double width = 860, height = 460;
constexpr double left = 74, right = 660, top = 16, bottom = 408;

constexpr std::array colors{"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#e07b00", "#17a2b8", "#8c564b"};

std::string marker(std::size_t style, double x, double y) {
    const std::string_view color = colors[style % colors.size()];
    switch (style / colors.size() % 3) {
    case 0:
        return fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4.5" fill="{}"/>)", x, y, color);
    case 1:
        return fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="8" height="8" fill="{}"/>)", x - 4, y - 4, color);
    default:
        return fmt::format(R"(<path d="M{:.1f} {:.1f}l5 9h-10z" fill="{}"/>)", x, y - 5, color);
    }
}

/// Maps values to coordinates, logarithmically.
class Axis {
  public:
    Axis(double low, double high, double from, double to)
        : low_(std::log10(low)), high_(std::log10(high)), from_(from), to_(to) {
        const double margin = std::max(0.06 * (high_ - low_), 0.12);
        low_ -= margin;
        high_ += margin;
    }

    double at(double value) const { return from_ + (std::log10(value) - low_) / (high_ - low_) * (to_ - from_); }

    /// 1, 2 and 5 times the powers of ten; only the powers of ten on axes of more than two decades.
    std::vector<double> ticks() const {
        std::vector<double> ticks;
        for (int e = static_cast<int>(std::floor(low_)); e <= high_; ++e)
            for (const int m : {1, 2, 5}) {
                const double tick = m * std::pow(10.0, e);
                if (std::log10(tick) >= low_ && std::log10(tick) <= high_ && (m == 1 || high_ - low_ < 2.2))
                    ticks.push_back(tick);
            }
        return ticks;
    }

  private:
    double low_, high_, from_, to_;
};

struct Place {
    double x, y, width;

    bool overlaps(const Place& other) const {
        return x < other.x + other.width && other.x < x + width && std::fabs(y - other.y) < 11.0;
    }
};

/// Places labels next to, above or below their points; omits labels that do not fit.
class Labels {
  public:
    void keep_free(double x, double y) { taken_.push_back({x - 5, y, 10}); }

    std::string place(double x, double y, const std::string& text) {
        const double length = 6.4 * static_cast<double>(text.size());
        for (const Place& place :
             {Place{x + 8, y + 4, length}, Place{x - 8 - length, y + 4, length}, Place{x - length / 2, y - 9, length},
              Place{x - length / 2, y + 17, length}, Place{x + 6, y - 8, length}, Place{x + 6, y + 15, length}}) {
            const bool inside = place.x > left && place.x + length < right && place.y > top + 8 && place.y < bottom;
            // The middle of a label is above its baseline.
            const Place middle{place.x, place.y - 4, length};
            if (!inside ||
                std::any_of(taken_.begin(), taken_.end(), [&](const Place& t) { return t.overlaps(middle); }))
                continue;
            taken_.push_back(middle);
            return fmt::format(
                R"(<text x="{:.1f}" y="{:.1f}" paint-order="stroke" stroke="#fff" stroke-width="3">{}</text>)", place.x,
                place.y, escaped(text));
        }
        return "";
    }

  private:
    std::vector<Place> taken_;
};

std::string frame_of_axes(const Chart& chart, const Axis& x, const Axis& y) {
    std::string text;
    for (const double tick : x.ticks())
        text += fmt::format(R"(<path d="M{0:.1f} {1}V{2}" stroke="#ddd"/>)"
                            R"(<text x="{0:.1f}" y="{3}" text-anchor="middle">{4:.5g}</text>)",
                            x.at(tick), top, bottom, bottom + 16, tick);
    for (const double tick : y.ticks())
        text += fmt::format(
            R"(<path d="M{1} {0:.1f}H{2}" stroke="#ddd"/><text x="{3}" y="{4:.1f}" text-anchor="end">{5:.5g}</text>)",
            y.at(tick), left, right, left - 6, y.at(tick) + 4, tick);
    text += fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="none" stroke="#888"/>)", left, top,
                        right - left, bottom - top);
    text += fmt::format(R"(<text x="{}" y="{}" text-anchor="middle" font-size="13">{}</text>)", (left + right) / 2,
                        height - 12, escaped(chart.x_title));
    text +=
        fmt::format(R"(<text transform='translate(18 {}) rotate(-90)' text-anchor="middle" font-size="13">{}</text>)",
                    (top + bottom) / 2, escaped(chart.y_title));
    return text;
}

}

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text)
        switch (c) {
        case '&':
            safe += "&amp;";
            break;
        case '<':
            safe += "&lt;";
            break;
        case '>':
            safe += "&gt;";
            break;
        case '"':
            safe += "&quot;";
            break;
        default:
            safe += c;
        }
    return safe;
}

std::string svg(const Chart& chart) {
    std::vector<double> xs, ys;
    const auto drawn = [&](double value) { return std::max(value, chart.smallest); };
    for (const ChartSeries& series : chart.series)
        for (const ChartPoint& point : series.points) {
            xs.push_back(drawn(point.x));
            ys.push_back(drawn(point.y));
        }
    if (xs.empty())
        return "";
    const auto [x_low, x_high] = std::minmax_element(xs.begin(), xs.end());
    const auto [y_low, y_high] = std::minmax_element(ys.begin(), ys.end());
    const Axis x(*x_low, *x_high, left, right), y(*y_low, *y_high, bottom, top);

    std::string text =
        fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" )"
                    R"(font-family="sans-serif" font-size="11" fill="#222">)",
                    width, height);
    text += frame_of_axes(chart, x, y);
    if (!chart.front.empty()) {
        std::string path;
        for (const auto& [cost, error] : chart.front) {
            const double to_x = x.at(drawn(cost)), to_y = y.at(drawn(error));
            path +=
                path.empty() ? fmt::format("M{:.1f} {:.1f}", to_x, to_y) : fmt::format("H{:.1f}V{:.1f}", to_x, to_y);
        }
        text += fmt::format(R"(<path d="{}H{}" fill="none" stroke="#222" stroke-width="1.5" stroke-dasharray="5 3"/>)",
                            path, right);
    }

    Labels labels;
    std::string markers, names, legend;
    double line = top + 10;
    const auto add_to_legend = [&](const std::string& sign, const std::string& name) {
        legend += fmt::format(R"({}<text x="{}" y="{}">{}</text>)", sign, right + 32, line + 4, escaped(name));
        line += 19;
    };
    if (!chart.front.empty())
        add_to_legend(fmt::format(R"(<path d="M{} {}h20" stroke="#222" stroke-width="1.5" stroke-dasharray="5 3"/>)",
                                  right + 8, line),
                      "Pareto front");
    for (const ChartSeries& series : chart.series) {
        std::string path;
        for (const ChartPoint& point : series.points) {
            const double at_x = x.at(drawn(point.x)), at_y = y.at(drawn(point.y));
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", at_x, at_y);
            markers += fmt::format("<g>{}<title>{}</title></g>", marker(series.style, at_x, at_y), escaped(point.note));
            labels.keep_free(at_x, at_y);
        }
        if (series.joined && series.points.size() > 1)
            text += fmt::format(R"(<path d="{}" fill="none" stroke="{}" opacity="0.6"/>)", path,
                                colors[series.style % colors.size()]);
        if (!series.name.empty())
            add_to_legend(marker(series.style, right + 18, line), series.name);
    }
    for (const ChartSeries& series : chart.series)
        for (const ChartPoint& point : series.points)
            if (!point.label.empty())
                names += labels.place(x.at(drawn(point.x)), y.at(drawn(point.y)), point.label);
    return text + markers + names + legend + "</svg>\n";
}

}
