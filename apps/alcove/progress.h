/// Progress on stderr, with the time that is left, for work of over a second.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

namespace alcove::cli {

enum class ProgressMode { automatic, bar, plain, none };

/// Whether a bar stands in the last line of stderr, and what clears it: for those who end the program.
inline std::atomic<bool> bar_is_shown{false};
inline constexpr std::string_view clear_bar = "\r\033[K";

/// One meter a phase of the work. `automatic` draws a bar on a terminal and is silent elsewhere.
class ProgressMeter {
  public:
    ProgressMeter(ProgressMode mode, std::string label);
    ~ProgressMeter();
    ProgressMeter(const ProgressMeter&) = delete;
    ProgressMeter& operator=(const ProgressMeter&) = delete;

    void operator()(double done);

  private:
    using Clock = std::chrono::steady_clock;
    ProgressMode mode_;
    std::string label_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_shown_ = start_;
};

}
