#include "progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

namespace alcove::cli {
namespace {

constexpr double quiet_seconds = 1.0;

}

ProgressMeter::ProgressMeter(ProgressMode mode, std::string label) : mode_(mode), label_(std::move(label)) {
    if (mode_ == ProgressMode::automatic)
        mode_ = isatty(STDERR_FILENO) ? ProgressMode::bar : ProgressMode::none;
}

ProgressMeter::~ProgressMeter() {
    clear();
}

void ProgressMeter::show(std::string_view label, double done) {
    if (label != label_) {
        label_ = label;
        start_ = last_shown_ = Clock::now();
    }
    (*this)(done);
}

void ProgressMeter::clear() {
    if (bar_is_shown)
        std::fputs(clear_bar.data(), stderr);
    bar_is_shown = false;
}

void ProgressMeter::operator()(double done) {
    if (mode_ == ProgressMode::none)
        return;
    const auto now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double since = std::chrono::duration<double>(now - last_shown_).count();
    if (elapsed < quiet_seconds || done >= 1.0 || since < (mode_ == ProgressMode::bar ? 0.1 : 1.0))
        return;
    last_shown_ = now;
    bar_is_shown = mode_ == ProgressMode::bar;
    const std::string left =
        done > 0.0 ? fmt::format("{:.0f} s left", elapsed / done * (1.0 - done)) : std::string("estimating");
    if (mode_ == ProgressMode::bar) {
        constexpr int width = 30;
        const int filled = static_cast<int>(done * width);
        std::fputs(fmt::format("{}{:<12} [{:#<{}}{:<{}}] {:3.0f} %  {}", clear_bar, label_, "", filled, "",
                               width - filled, 100.0 * done, left)
                       .c_str(),
                   stderr);
        std::fflush(stderr);
    } else {
        std::fputs(fmt::format("{}: {:.0f} %, {}\n", label_, 100.0 * done, left).c_str(), stderr);
    }
}

}
