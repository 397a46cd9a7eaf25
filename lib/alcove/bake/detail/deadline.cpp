#include "alcove/bake/detail/deadline.h"

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace alcove {
namespace {

/// Rounds up to two significant digits.
double rounded_up(double seconds) {
    const double unit = std::pow(10.0, std::floor(std::log10(seconds)) - 1.0);
    return std::ceil(seconds / unit) * unit;
}

}

double Deadline::left() const {
    return std::max(*seconds_ - std::chrono::duration<double>(Clock::now() - start_).count(), 0.0);
}

void Deadline::check(double seconds, const Remedy& remedy) const {
    constexpr double cautious = 0.8; // share of the remaining time that a remedy may use
    if (!is_set() || seconds <= clearly_late * left())
        return;
    const std::string instead = remedy(cautious * left() / seconds);
    throw TimeLimitError(
        fmt::format("the rest takes about {:g} s, but --time-limit leaves {:.2g} s: {}raise --time-limit by {:g} s",
                    rounded_up(seconds), left(), instead.empty() ? "" : "use " + instead + ", or ",
                    rounded_up(clearly_late * seconds)));
}

double shared_seconds_of(const std::function<void()>& work) {
    const std::clock_t begin = std::clock();
    work();
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / static_cast<double>(thread_count());
}

}
