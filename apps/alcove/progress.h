/// Shows progress and the remaining time on stderr, for work that takes more than a second.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

namespace alcove::cli {

enum class ProgressMode { automatic, bar, plain, none };

/// Whether the last line of stderr is a progress bar, and the text that clears it; for code that ends the program.
inline std::atomic<bool> bar_is_shown{false};
inline constexpr std::string_view clear_bar = "\r\033[K";

/// Shows the progress of one phase at a time. `automatic` draws a bar on a terminal and is silent elsewhere.
class ProgressMeter {
  public:
    ProgressMeter(ProgressMode mode, std::string label);
    ~ProgressMeter();
    ProgressMeter(const ProgressMeter&) = delete;
    ProgressMeter& operator=(const ProgressMeter&) = delete;

    /// Shows `done`, in [0, 1]. A new label restarts the time estimate.
    void show(std::string_view label, double done);
    void operator()(double done);
    /// Clears the bar, so that a line can be printed to stderr.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    ProgressMode mode_;
    std::string label_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_shown_ = start_;
};

}
