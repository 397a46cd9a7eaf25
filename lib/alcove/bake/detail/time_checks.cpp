#include "alcove/bake/detail/time_checks.h"

#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/parallel.h"

#include <fmt/format.h>

#include <vector>

namespace alcove {

void check_time(const Deadline& deadline, std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                const Occluders& occluders, const MethodChoice& choice, Settings settings, ChannelSet wanted) {
    constexpr std::size_t max_batches = 64, min_stride = 8;
    constexpr int max_samples = 1024; // per surfel in a trial; the time is proportional to this number
    constexpr double certain = 2.0;   // factor above or below the limit
    if (!deadline.is_set())
        return;
    // Without labels, the trial omits the fit. The fit would take longer than the trial, and its time does not grow
    // with the number of surfels.
    settings.labels.reset();
    double samples_left_out = 1.0;
    if (choice.samples > max_samples) {
        settings.parameters.emplace_back(parameter_of(choice.method->samples_are), max_samples);
        samples_left_out = static_cast<double>(choice.samples) / max_samples;
    }
    const std::size_t batches = order.size() / SurfelBatch::capacity;
    double seconds = 0.0; // for all surfels
    for (std::size_t count = 2; count <= max_batches && count * min_stride <= batches; count *= 2) {
        std::vector<Surfel> some;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t batch = (2 * k + 1) * batches / (2 * count);
            for (std::size_t i = 0; i < SurfelBatch::capacity; ++i)
                some.push_back(surfels[order[batch * SurfelBatch::capacity + i]]);
        }
        const double part = shared_seconds_of([&] { evaluate(some, occluders, *choice.method, settings, wanted); });
        seconds = part * samples_left_out * static_cast<double>(order.size()) / static_cast<double>(some.size());
        if (certain * seconds < deadline.left() || seconds > certain * clearly_late * deadline.left())
            break;
    }
    deadline.check(seconds, [&](double share) -> std::string {
        const int fewer = static_cast<int>(share * choice.samples);
        if (fewer >= 1)
            return fmt::format("--{} {}", parameter_of(choice.method->samples_are), fewer);
        return choice.method->name == "calibrated" ? "" : "--method calibrated";
    });
}

void check_time(const Deadline& deadline, const Plan& plan, const PlanRequest& request, const Pilot& pilot) {
    deadline.check(plan.seconds / static_cast<double>(thread_count()), [&](double share) -> std::string {
        for (PlanRequest other = request; const double error : {0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.1}) {
            other.error = error;
            other.exact_rays = 0;
            if (error > request.error && Planner(other, pilot).expected().seconds < share * plan.seconds)
                return fmt::format("--error {}", error);
        }
        return "";
    });
}

}
