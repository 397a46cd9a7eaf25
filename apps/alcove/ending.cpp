#include "ending.h"

#include "progress.h"

#include "alcove/base/detail/atomic_file.h"

#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

namespace alcove::cli {
namespace {

std::array<char, 200> late{}; // what to say when time is up: a handler may not format it

using Clock = std::chrono::steady_clock;
std::optional<std::pair<Clock::time_point, double>> limited; // since when, and to how many seconds

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigfillset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

extern "C" void on_interrupt(int signal) {
    remove_unfinished_files();
    // Whoever started the program is to see what ended it.
    handle(signal, SIG_DFL);
    sigset_t unblocked;
    sigemptyset(&unblocked);
    sigaddset(&unblocked, signal);
    ::pthread_sigmask(SIG_UNBLOCK, &unblocked, nullptr);
    (void)::raise(signal);
}

/// The last words of the program: nothing is destroyed any more, and nothing allocated.
[[noreturn]] void give_up(const char* words) {
    remove_unfinished_files();
    for (const char* part : {bar_is_shown ? clear_bar.data() : "", "alcove: ", words, "\n"})
        if (::write(STDERR_FILENO, part, std::strlen(part)) < 0)
            break;
    ::_exit(1);
}

extern "C" void on_alarm(int) {
    give_up(late.data());
}

[[noreturn]] void on_terminate() {
    try {
        if (const std::exception_ptr thrown = std::current_exception())
            std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        give_up(out_of_memory);
    } catch (...) {
        give_up("a library gave up where nothing could be mended");
    }
    give_up("ended for no reason that is known");
}

}

void end_cleanly() {
    for (const int signal :
         {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU, SIGSEGV, SIGBUS, SIGILL, SIGFPE}) {
        struct sigaction before {};
        ::sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_DFL) // else ignored, as under nohup, or a sanitizer's
            handle(signal, on_interrupt);
    }
    handle(SIGXFSZ, SIG_IGN);
    std::set_terminate(on_terminate);
}

void limit_time(double seconds) {
    limited.emplace(Clock::now(), seconds);
    std::snprintf(
        late.data(), late.size(),
        "stopped after the %g s of --time-limit: allow more, or ask for less (fewer --rays, a larger "
        "--error or --voxel, a smaller --size)",
        seconds);
    handle(SIGALRM, on_alarm);
    const double whole = std::floor(seconds);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(whole);
    timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole));
    if (timer.it_value.tv_sec == 0 && timer.it_value.tv_usec == 0)
        timer.it_value.tv_usec = 1;
    ::setitimer(ITIMER_REAL, &timer, nullptr);
}

std::optional<TimeLimit> time_limit() {
    if (!limited)
        return {};
    const auto& [since, seconds] = *limited;
    const double gone = std::chrono::duration<double>(Clock::now() - since).count();
    return TimeLimit{seconds, std::max(seconds - gone, 0.0)};
}

}
