/// Measures the wall-clock time of stages.
#pragma once

#include <chrono>

namespace alcove {

class Stopwatch {
  public:
    /// Seconds since the last call, or since construction in the first call.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}
