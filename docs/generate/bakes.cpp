#include "bakes.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <initializer_list>

namespace alcove::docs {
namespace {

constexpr float compared_radius = 0.1f;
constexpr std::array voxel_counts{64, 80, 96, 128, 256}; // along the diagonal

std::filesystem::path baked_path(const std::filesystem::path& file) {
    return std::filesystem::path(file).replace_extension(".baked.ply");
}

}

std::string Choice::text() const {
    return voxel > 0.0f ? fmt::format("{}, voxel 1/{:.0f}", method.label(), 1.0f / voxel) : method.label();
}

Bake bake_once(const std::filesystem::path& file, const Choice& choice, double radius) {
    std::vector<std::string> command{ALCOVE_PROGRAM,
                                     "bake",
                                     file,
                                     "-o",
                                     baked_path(file),
                                     "--threads",
                                     "1",
                                     "--no-pilot",
                                     "--json",
                                     "--method",
                                     std::string(choice.method.method->name),
                                     "--radius",
                                     fmt::format("{}%", 100.0 * radius)};
    if (choice.method.samples > 0) {
        command.emplace_back("--" + std::string(parameter_of(choice.method.method->samples_are)));
        command.push_back(fmt::format("{}", choice.method.samples));
    }
    if (choice.voxel > 0.0f) {
        command.emplace_back("--voxel");
        command.push_back(fmt::format("{:.9g}%", 100.0 * double(choice.voxel)));
    }
    const Run done = run(command);
    const auto report = nlohmann::json::parse(done.output);
    Bake bake{choice, done.cpu_seconds, {}, report.at("peak_rss_bytes")};
    double start = done.wall_seconds;
    for (const char* phase : {"read", "grid", "occlusion", "write"})
        start -= bake.phases[phase] = report.at("seconds").at(phase);
    bake.phases["start"] = start;
    return bake;
}

Bake bake_median(const std::filesystem::path& file, const Choice& choice, double radius) {
    std::array<Bake, 3> bakes;
    for (Bake& bake : bakes)
        bake = bake_once(file, choice, radius);
    std::sort(bakes.begin(), bakes.end(), [](const Bake& a, const Bake& b) { return a.seconds < b.seconds; });
    return bakes[1];
}

std::string outcome_of(const Run& bake) {
    const auto report = nlohmann::json::parse(bake.output);
    const std::string samples =
        report.at("samples").is_null() ? "" : fmt::format(":{}", report.at("samples").get<int>());
    return fmt::format("{:.1f} CPU seconds and {:.1f} GB of peak memory. The planner chose {}{}, with an "
                       "estimated RMSE of {:.3f}",
                       bake.cpu_seconds, report.at("peak_rss_bytes").get<double>() / 1e9,
                       report.at("method").get<std::string>(), samples, report.at("estimated_rmse").get<double>());
}

MeasuredChoices::MeasuredChoices(const std::filesystem::path& file)
    : file_(file), mesh_(file.string(), read_mesh(file)), truth_(make_truth(mesh_, compared_radius)) {
    for (const int count : voxel_counts) {
        const float voxel = 1.0f / static_cast<float>(count);
        grids_.emplace(voxel, build_grid(mesh_, compared_radius, voxel));
    }
}

double MeasuredChoices::rmse(const MethodChoice& choice, float voxel) const {
    return measure(mesh_, truth_, voxel > 0.0f ? &grids_.at(voxel) : nullptr, choice).error.rmse;
}

/// The least number of rays that meets the error, to within about 2 %.
int MeasuredChoices::rays_for(double error) const {
    int too_few = 1, enough = 2;
    while (rmse(choose(find_method("exact"), enough), 0.0f) > error)
        too_few = enough, enough *= 2;
    while (enough - too_few > std::max(1, enough / 50)) {
        const int middle = (too_few + enough) / 2;
        (rmse(choose(find_method("exact"), middle), 0.0f) <= error ? enough : too_few) = middle;
    }
    return enough;
}

Comparison MeasuredChoices::compare(double error) const {
    const int rays = rays_for(error);
    const MethodChoice exact = choose(find_method("exact"), rays);
    const double plain_rmse = rmse(exact, 0.0f);
    std::vector<Bake> candidates{{{exact, 0.0f, plain_rmse}}};
    const auto add = [&](std::string_view method, std::initializer_list<int> samples) {
        for (const auto& [voxel, grid] : grids_)
            for (const int count : samples) { // in order of cost
                const MethodChoice choice = choose(find_method(method), count);
                if (const double found = rmse(choice, voxel); found <= error) {
                    candidates.push_back({{choice, voxel, found}});
                    break;
                }
            }
    };
    add("calibrated", {13, 38, 63});
    add("guided", {1, 2, 3, 4, 6, 8, 16, 32, 64});
    for (Bake& candidate : candidates)
        candidate = bake_once(file_, candidate.choice, compared_radius);
    const Bake& cheapest = *std::min_element(candidates.begin(), candidates.end(),
                                             [](const Bake& a, const Bake& b) { return a.seconds < b.seconds; });
    std::vector<Bake> ours;
    const auto t = medians({[&] {
                                ours.push_back(bake_once(file_, cheapest.choice, compared_radius));
                                return ours.back().seconds;
                            },
                            [&] {
                                return run({ALCOVE_PROGRAM, "bake", file_, "-o", baked_path(file_), "--threads", "1",
                                            "--error", fmt::format("{}", error), "--json"})
                                    .cpu_seconds;
                            },
                            [&] {
                                return run({ALCOVE_PLAIN_BAKER, file_, baked_path(file_),
                                            fmt::format("{}", compared_radius), fmt::format("{}", rays)})
                                    .cpu_seconds;
                            }});
    const auto median = std::find_if(ours.begin(), ours.end(), [&](const Bake& bake) { return bake.seconds == t[0]; });
    return {*median, t[1], rays, plain_rmse, t[2]};
}

}
