/// Scatter charts with logarithmic axes, as inline SVG.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

struct ChartPoint {
    double x = 0.0, y = 0.0;
    std::string label; ///< beside the point
    std::string note;  ///< shown while the pointer rests on it
};

struct ChartSeries {
    std::string name;      ///< in the legend; may be empty
    std::size_t style = 0; ///< colour and marker
    bool joined = false;   ///< by a line, in order
    std::vector<ChartPoint> points{};
};

struct Chart {
    std::string x_title, y_title;
    std::vector<ChartSeries> series{};
    std::vector<std::pair<double, double>> front{}; ///< drawn as a staircase: y falls as x grows
    double smallest = 1e-5;                         ///< > 0; lower values are drawn there
};

/// An <svg> element with a legend; empty text where there is no point.
std::string svg(const Chart& chart);

/// The text with what HTML gives a meaning to written as entities.
std::string escaped(std::string_view text);

}
