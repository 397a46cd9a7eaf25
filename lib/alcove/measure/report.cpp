#include "alcove/measure/report.h"

#include "alcove/measure/detail/chart.h"
#include "alcove/measure/detail/heat_map.h"
#include "alcove/measure/detail/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace alcove {
namespace {

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Ambient occlusion: error and cost</title>
<style>
body { font: 15px/1.45 sans-serif; color: #222; max-width: 1100px; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; font-size: 13px; margin: 1em 0 }
th, td { padding: 3px 9px; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap }
th { cursor: pointer; border-bottom: 2px solid #888; vertical-align: bottom }
td:first-child, th:first-child { text-align: left }
tr.front td:first-child { font-weight: bold }
figure { display: inline-block; margin: 0 8px 12px 0 } figcaption { font-size: 13px }
</style></head><body>
<h1>Ambient occlusion: error and cost</h1>
)";

constexpr std::string_view introduction =
    R"(<p>The reference is 1,024 exact rays per vertex, whose own error is about 0.003. The table gives the RMSE, the
bias (positive: too open), the 99th percentile of the differences and the largest difference. The standard deviation
of the reference is the RMSE of the best constant guess. Times are CPU seconds of the process, summed over all threads,
for one pass over all vertices. They include building the grid and the BVH for methods that need them. Each is built
once, and its time counts for every method that uses it. <code>map()</code> calls and rays are per vertex. Lengths are
relative to the diagonal of the mesh. Methods on the Pareto front are bold in the table: no cheaper method has a
smaller error. Click on a heading to sort by it.</p>
)";

constexpr std::string_view tail = R"(<script>
for (const heading of document.querySelectorAll('th')) heading.onclick = () => {
    const column = heading.cellIndex, body = heading.closest('table').tBodies[0];
    const key = row => row.cells[column].dataset.v ?? row.cells[column].textContent;
    const order = (a, b) => column ? key(a) - key(b) : key(a).localeCompare(key(b));
    const rows = [...body.rows].sort(order);
    if (rows.every((row, i) => row === body.rows[i])) rows.reverse();
    body.append(...rows);
};
</script></body></html>
)";

using Group = std::vector<const Measurement*>;

/// Groups measurements by the value of `what`.
template <class F>
auto grouped_by(const Group& group, const F& what) {
    std::map<std::decay_t<decltype(what(*group.front()))>, Group> groups;
    for (const Measurement* m : group)
        groups[what(*m)].push_back(m);
    return groups;
}

std::string percent(double length) {
    return std::isinf(length) ? "inf" : fmt::format("{:.3g} %", 100.0 * length);
}

std::string note_of(const Measurement& m) {
    return fmt::format("{}: RMSE {:.4f}, {:.3g} s{}", m.label(), m.error.rmse, m.seconds(),
                       m.voxel > 0.0f ? ", voxel " + percent(m.voxel) : "");
}

using Cost = double (*)(const Measurement&);

double total(const Measurement& m) {
    return m.seconds();
}

double occlusion(const Measurement& m) {
    return m.occlusion_seconds;
}

std::vector<std::size_t> front_of(const Group& group, Cost cost) {
    std::vector<CostAndError> choices;
    choices.reserve(group.size());
    for (const Measurement* m : group)
        choices.push_back({cost(*m), m->error.rmse});
    return pareto_front(choices);
}

Group with_grid(const Group& group) {
    Group gridded;
    std::copy_if(group.begin(), group.end(), std::back_inserter(gridded),
                 [](const Measurement* m) { return m->voxel > 0.0f; });
    return gridded;
}

class Page {
  public:
    explicit Page(std::span<const Measurement> measurements) {
        for (const Measurement& m : measurements) {
            all_.push_back(&m);
            if (std::find(meshes_.begin(), meshes_.end(), m.mesh) == meshes_.end())
                meshes_.push_back(m.mesh);
            styles_.try_emplace(m.method, styles_.size());
        }
    }

    std::string text() const {
        std::string text = fmt::format("{}{}", head, introduction);
        if (meshes_.size() > 1)
            text += together();
        for (const std::string& mesh : meshes_) {
            Group group;
            std::copy_if(all_.begin(), all_.end(), std::back_inserter(group),
                         [&](const Measurement* m) { return m->mesh == mesh; });
            text +=
                fmt::format("<h2>{}</h2>\n<p>{} vertices, {} triangles; compared at {} vertices.</p>\n", escaped(mesh),
                            group.front()->vertices, group.front()->triangles, group.front()->error.count);
            text += charts(group);
            for (const auto& [radius, same] : grouped_by(group, radius_of))
                text += table(same) + pictures(same);
        }
        return text + std::string(tail);
    }

    std::string chart() const { return times(all_, total, "CPU seconds, total"); }

  private:
    static float radius_of(const Measurement& m) { return m.radius; }
    static float voxel_of(const Measurement& m) { return m.voxel; }
    static float asked_voxel_of(const Measurement& m) { return m.asked_voxel; }

    /// Charts of all meshes combined, for settings that were measured on every mesh.
    std::string together() const {
        std::vector<Measurement> sums;
        const auto settings = [](const Measurement& m) {
            return std::tuple(m.method, m.samples, m.radius, m.asked_voxel);
        };
        for (const auto& [key, same] : grouped_by(all_, settings)) {
            if (same.size() < meshes_.size())
                continue;
            Measurement sum = *same.front();
            sum.grid_seconds = sum.tree_seconds = sum.occlusion_seconds = 0.0;
            double squares = 0.0;
            for (const Measurement* m : same) {
                squares += m->error.rmse * m->error.rmse;
                sum.grid_seconds += m->grid_seconds + m->tree_seconds;
                sum.occlusion_seconds += m->occlusion_seconds;
            }
            sum.error.rmse = std::sqrt(squares / static_cast<double>(same.size()));
            sums.push_back(std::move(sum));
        }
        Group group;
        for (const Measurement& sum : sums)
            group.push_back(&sum);
        return fmt::format("<h2>All {} meshes</h2>\n<p>The root mean square of their RMSEs, and the sum of their "
                           "seconds.</p>\n{}",
                           meshes_.size(), charts(group));
    }

    std::string charts(const Group& group) const {
        std::string text;
        for (const auto& [radius, same] : grouped_by(group, radius_of))
            text += fmt::format("<h3>Error and time at a radius of {}</h3>\n{}{}", percent(radius),
                                times(same, total, "CPU seconds, total"),
                                times(same, occlusion, "CPU seconds, occlusion only"));
        const Group gridded = with_grid(group);
        if (grouped_by(gridded, asked_voxel_of).size() > 1)
            for (const auto& [radius, same] : grouped_by(gridded, radius_of))
                text += fmt::format("<h3>Error and voxel at a radius of {}</h3>\n{}", percent(radius),
                                    lines(same, "voxel, % of the diagonal", voxel_of));
        if (grouped_by(group, radius_of).size() > 1)
            for (const auto& [voxel, same] : grouped_by(group, asked_voxel_of))
                text += fmt::format("<h3>Error and radius, {}</h3>\n{}",
                                    voxel > 0.0f ? "voxel " + percent(voxel) : "automatic voxel",
                                    lines(same, "radius, % of the diagonal", radius_of));
        return text;
    }

    /// A chart of error against seconds. Lines connect the points of a method that differ only in the sample count.
    std::string times(const Group& group, Cost cost, const std::string& title) const {
        Chart chart{.x_title = title, .y_title = "RMSE"};
        const std::vector<std::size_t> front = front_of(group, cost);
        for (const std::size_t i : front)
            chart.front.emplace_back(cost(*group[i]), group[i]->error.rmse);
        const bool many_voxels = grouped_by(with_grid(group), asked_voxel_of).size() > 1;
        for (const auto& [method, own] : grouped_by(group, [](const Measurement& m) { return m.method; }))
            for (const auto& [voxel, same] : grouped_by(own, voxel_of)) {
                const bool named = same.front()->voxel == own.front()->voxel;
                ChartSeries series = series_of(*same.front(), named ? method : "");
                const std::string suffix = many_voxels && voxel > 0.0f ? ", " + percent(voxel) : "";
                Group sorted = same;
                std::sort(sorted.begin(), sorted.end(),
                          [](const auto* a, const auto* b) { return a->samples < b->samples; });
                for (const Measurement* m : sorted)
                    series.points.push_back({cost(*m), m->error.rmse, m->label() + suffix, note_of(*m)});
                chart.series.push_back(std::move(series));
            }
        return svg(chart);
    }

    /// A chart of error against a length, with one line per method and sample count.
    std::string lines(const Group& group, const std::string& title, float (*length)(const Measurement&)) const {
        Chart chart{.x_title = title, .y_title = "RMSE"};
        for (const auto& [label, same] : grouped_by(group, [](const Measurement& m) { return m.label(); })) {
            ChartSeries series = series_of(*same.front(), label);
            for (const auto& [x, at] : grouped_by(same, length))
                if (!std::isinf(x))
                    series.points.push_back({100.0 * x, at.front()->error.rmse, "", note_of(*at.front())});
            if (!series.points.empty())
                series.points.back().label = label;
            chart.series.push_back(std::move(series));
        }
        return svg(chart);
    }

    ChartSeries series_of(const Measurement& m, const std::string& name) const {
        return {.name = name, .style = styles_.at(m.method), .joined = true};
    }

    static std::string table(const Group& group) {
        const std::vector<std::size_t> front = front_of(group, total);
        std::vector<std::size_t> order(group.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return group[a]->error.rmse < group[b]->error.rmse; });
        std::string text =
            fmt::format("<table><caption>Radius {}; standard deviation of the reference {:.4f}</caption>\n<thead><tr>",
                        percent(group.front()->radius), group.front()->error.deviation);
        for (const std::string_view heading :
             {"method", "voxel, %", "RMSE", "bias", "99 %", "max", "grid, s", "BVH, s", "occlusion, s", "total, s",
              "map() calls", "rays", "grid, MB", "peak RSS, MB"})
            text += fmt::format("<th>{}</th>", heading);
        text += "</tr></thead>\n<tbody>\n";
        for (const std::size_t i : order) {
            const Measurement& m = *group[i];
            const bool best = std::find(front.begin(), front.end(), i) != front.end();
            text += fmt::format("<tr{}><td>{}</td>", best ? R"( class="front")" : "", escaped(m.label()));
            text += fmt::format("<td>{:.3g}</td><td>{:.4f}</td><td>{:+.4f}</td><td>{:.4f}</td><td>{:.4f}</td>",
                                100.0 * m.voxel, m.error.rmse, m.error.bias, m.error.percentile_99, m.error.max);
            for (const double seconds : {m.grid_seconds, m.tree_seconds, m.occlusion_seconds, m.seconds()})
                text += fmt::format("<td>{:.4g}</td>", seconds);
            text +=
                fmt::format("<td>{:.4g}</td><td>{:.4g}</td><td>{:.1f}</td><td>{:.1f}</td></tr>\n", m.map_calls, m.rays,
                            static_cast<double>(m.grid_bytes) / 1e6, static_cast<double>(m.peak_rss_bytes) / 1e6);
        }
        return text + "</tbody></table>\n";
    }

    static std::string pictures(const Group& group) {
        std::string text;
        for (const Measurement* m : group)
            if (!m->picture.empty())
                text += fmt::format(R"(<figure><img width="320" height="240" alt="errors of {0}" src="{1}">)"
                                    R"(<figcaption>{0}{2}: {3:.4f}</figcaption></figure>)"
                                    "\n",
                                    escaped(m->label()), m->picture,
                                    m->voxel > 0.0f ? ", voxel " + percent(m->voxel) : "", m->error.rmse);
        if (text.empty())
            return "";
        return fmt::format("<h3>Error images at a radius of {}</h3>\n<p>The absolute difference, from white (0) "
                           "through orange and red to black ({} and above).</p>\n{}",
                           percent(group.front()->radius), largest_drawn_error, text);
    }

    Group all_;
    std::vector<std::string> meshes_;
    std::map<std::string, std::size_t> styles_;
};

}

std::string report(std::span<const Measurement> measurements) {
    return Page(measurements).text();
}

std::string chart_of_times(std::span<const Measurement> measurements) {
    return Page(measurements).chart();
}

}
