#include "time_estimate.h"

#include "ending.h"

#include "alcove/base/parallel.h"
#include "alcove/occlusion/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace alcove::cli {
namespace {

constexpr double clearly_late = 2.0;
constexpr double cautious = 0.8; // share of the time that a remedy uses

/// Wall-clock seconds that some work would take, were it shared by all threads, as its CPU time tells.
double shared_seconds_of(const std::function<void()>& work) {
    const std::clock_t begin = std::clock();
    work();
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / static_cast<double>(thread_count());
}

/// Two digits, upwards.
double rounded_up(double seconds) {
    const double unit = std::pow(10.0, std::floor(std::log10(seconds)) - 1.0);
    return std::ceil(seconds / unit) * unit;
}

/// What to ask for instead, as "--rays 20", given how much of the work fits, in (0, 1); empty where nothing helps.
using Remedy = std::function<std::string(double share)>;

void refuse_if_late(double seconds, const Remedy& remedy) {
    const std::optional<TimeLimit> limit = time_limit();
    if (!limit || seconds <= clearly_late * limit->left)
        return;
    const std::string instead = remedy(cautious * limit->left / seconds);
    throw OutOfTime(
        fmt::format("this takes about {:g} s more, and of --time-limit {:.2g} s are left: {}allow {:g} s",
                    rounded_up(seconds), limit->left, instead.empty() ? "" : "use " + instead + ", or ",
                    rounded_up(limit->seconds - limit->left + clearly_late * seconds)));
}

}

void refuse_late_bake(std::span<const Surfel> surfels, const Occluders& occluders, const Method& method,
                      const Settings& settings, ChannelSet wanted) {
    constexpr std::size_t most_batches = 64, least_stride = 8;
    constexpr double surely = 2.0; // beyond this side of what is late, and of what is in time
    const std::optional<TimeLimit> limit = time_limit();
    if (!limit)
        return;
    const std::vector<std::uint32_t> order = spatial_order(surfels);
    const std::size_t batches = order.size() / SurfelBatch::capacity;
    double seconds = 0.0; // of all
    for (std::size_t count = 2; count <= most_batches && count * least_stride <= batches; count *= 2) {
        std::vector<Surfel> some;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t batch = (2 * k + 1) * batches / (2 * count);
            for (std::size_t i = 0; i < SurfelBatch::capacity; ++i)
                some.push_back(surfels[order[batch * SurfelBatch::capacity + i]]);
        }
        const double part =
            shared_seconds_of([&] { bake_channels(some, occluders, method, settings, wanted); });
        seconds = part * static_cast<double>(order.size()) / static_cast<double>(some.size());
        if (surely * seconds < limit->left || seconds > surely * clearly_late * limit->left)
            break;
    }
    refuse_if_late(seconds, [&](double share) -> std::string {
        const int samples = choice_of(method, settings).samples;
        const int fewer = static_cast<int>(share * samples);
        if (fewer >= 1)
            return fmt::format("--{} {}", method.has_parameter("rays") ? "rays" : "samples", fewer);
        return method.name == "calibrated" ? "" : "--method calibrated";
    });
}

void refuse_late_plan(const Plan& plan, const PlanRequest& request, const Pilot& pilot) {
    const double threads = static_cast<double>(thread_count());
    refuse_if_late(plan.seconds / threads, [&](double share) -> std::string {
        for (PlanRequest other = request; const double error : {0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.1}) {
            other.error = error;
            if (error > request.error && Planner(other, pilot).next().seconds < share * plan.seconds)
                return fmt::format("--error {}", error);
        }
        return "";
    });
}

void refuse_late_picture(ImageSize size, const std::function<void(ImageSize)>& draw) {
    if (!time_limit())
        return;
    const auto pixels = [](const ImageSize& of) { return static_cast<double>(of.width) * of.height; };
    const auto scaled = [&](double by) {
        return ImageSize{std::max(static_cast<int>(by * size.width), 1),
                         std::max(static_cast<int>(by * size.height), 1)};
    };
    // What takes the same time in any size is no part of the difference.
    const ImageSize small = scaled(1.0 / 16.0), smaller = scaled(1.0 / 64.0);
    const double less = shared_seconds_of([&] { draw(smaller); });
    const double more = shared_seconds_of([&] { draw(small); });
    const double a_pixel = (more - less) / std::max(pixels(small) - pixels(smaller), 1.0);
    refuse_if_late(a_pixel * pixels(size), [&](double share) -> std::string {
        constexpr double worth_a_look = 0.1;
        const double side = std::sqrt(share);
        if (side < worth_a_look)
            return "fewer samples and a smaller --size";
        const ImageSize fits = scaled(side);
        return fmt::format("--size {}x{}", fits.width, fits.height);
    });
}

}
