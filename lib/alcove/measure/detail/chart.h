/// Scatter charts with logarithmic axes, as inline SVG.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

struct ChartPoint {
    double x = 0.0, y = 0.0;
    std::string label; ///< printed next to the point
    std::string note;  ///< tooltip
};

struct ChartSeries {
    std::string name;      ///< in the legend; may be empty
    std::size_t style = 0; ///< colour and marker
    bool joined = false;   ///< connect the points with a line, in order
    std::vector<ChartPoint> points{};
};

struct Chart {
    std::string x_title, y_title;
    std::vector<ChartSeries> series{};
    std::vector<std::pair<double, double>> front{}; ///< drawn as a staircase; y falls as x grows
    double smallest = 1e-5;                         ///< > 0; smaller values are drawn at this value
};

/// An <svg> element with a legend; an empty string if there are no points.
std::string svg(const Chart& chart);

/// Escapes the special characters of HTML.
std::string escaped(std::string_view text);

}
