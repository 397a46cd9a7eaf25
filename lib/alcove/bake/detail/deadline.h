/// A time limit that refuses work that would clearly exceed it.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace alcove {

class Deadline {
  public:
    /// Starts now; empty: no limit.
    explicit Deadline(std::optional<double> seconds) : seconds_(seconds) {}

    bool is_set() const { return seconds_.has_value(); }
    /// Remaining wall-clock seconds, at least 0. \pre is_set()
    double left() const;

    /// Returns options that reduce the work to the fraction `share`, in (0, 1), such as "--rays 20"; empty if no option
    /// does.
    using Remedy = std::function<std::string(double share)>;
    /// \throw TimeLimitError if `seconds`, an estimate, exceeds `clearly_late` times the remaining time. The factor
    /// allows for the inexactness of the estimate.
    void check(double seconds, const Remedy& remedy) const;

  private:
    using Clock = std::chrono::steady_clock;
    std::optional<double> seconds_;
    Clock::time_point start_ = Clock::now();
};

inline constexpr double clearly_late = 2.0; ///< factor on the remaining time

/// Runs `work`. \return its CPU seconds (of the whole process) divided by the number of threads.
double shared_seconds_of(const std::function<void()>& work);

}
