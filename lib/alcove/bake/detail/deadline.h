/// A time limit. Refuses work that would clearly exceed it.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace alcove {

class Deadline {
  public:
    /// The time starts now. If `seconds` is empty, there is no limit.
    explicit Deadline(std::optional<double> seconds) : seconds_(seconds) {}

    bool is_set() const { return seconds_.has_value(); }
    /// Remaining wall-clock seconds, at least 0. \pre is_set()
    double left() const;

    /// Returns options that reduce the work to the fraction `share`, in (0, 1), such as "--rays 20"; empty if no option
    /// does this.
    using Remedy = std::function<std::string(double share)>;
    /// \throw TimeLimitError if `seconds`, an estimate, exceeds `clearly_late` times the remaining time. The factor
    /// allows for errors in the estimate. The message contains the remedy.
    void check(double seconds, const Remedy& remedy) const;

  private:
    using Clock = std::chrono::steady_clock;
    std::optional<double> seconds_;
    Clock::time_point start_ = Clock::now();
};

inline constexpr double clearly_late = 2.0; ///< see Deadline::check()

/// Runs `work`. \return the CPU seconds that the process spent meanwhile, divided by the number of threads.
double shared_seconds_of(const std::function<void()>& work);

}
