#include "ending.h"

#include "progress.h"

#include "alcove/base/detail/atomic_file.h"

#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
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

std::array<char, 200> time_limit_message{}; // formatted in advance: signal handlers must not format

std::atomic<bool> ends{false}; // whether the last line is being or has been printed

using Clock = std::chrono::steady_clock;
std::optional<std::pair<Clock::time_point, double>> time_limit; // its start and length

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigfillset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

extern "C" void on_interrupt(int signal) {
    remove_unfinished_files();
    // Raise the signal again, so that the parent process sees it.
    handle(signal, SIG_DFL);
    sigset_t unblocked;
    sigemptyset(&unblocked);
    sigaddset(&unblocked, signal);
    ::pthread_sigmask(SIG_UNBLOCK, &unblocked, nullptr);
    (void)::raise(signal);
}

/// Removes unfinished files, prints the message if it is to be the last line, and exits. Neither runs destructors nor
/// allocates memory.
[[noreturn]] void exit_with(const char* message, bool is_last_line) {
    remove_unfinished_files();
    if (is_last_line)
        for (const char* part : {bar_is_shown ? clear_bar.data() : "", "alcove: ", message, "\n"})
            if (::write(STDERR_FILENO, part, std::strlen(part)) < 0)
                break;
    ::_exit(1);
}

extern "C" void on_alarm(int) {
    if (!ends.exchange(true)) // else the program is about to end with its own exit code
        exit_with(time_limit_message.data(), true);
}

[[noreturn]] void on_terminate() {
    try {
        if (const std::exception_ptr thrown = std::current_exception())
            std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        exit_with(out_of_memory, !ends.exchange(true));
    } catch (...) {
        exit_with("a library failed with an exception that cannot be handled", !ends.exchange(true));
    }
    exit_with("terminated for an unknown reason", !ends.exchange(true));
}

}

void end_cleanly() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU, SIGSEGV, SIGBUS, SIGILL, SIGFPE}) {
        struct sigaction before {};
        ::sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_DFL) // else ignored, as under nohup, or handled by a sanitizer
            handle(signal, on_interrupt);
    }
    handle(SIGXFSZ, SIG_IGN);
    std::set_terminate(on_terminate);
}

void begin_to_end() {
    while (ends.exchange(true))
        ::pause();
}

void limit_time(double seconds) {
    time_limit.emplace(Clock::now(), seconds);
    std::snprintf(time_limit_message.data(), time_limit_message.size(),
                  "stopped after the %g s of --time-limit: allow more, or request less work", seconds);
    handle(SIGALRM, on_alarm);
    const double whole = std::floor(seconds);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(whole);
    timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole));
    if (timer.it_value.tv_sec == 0 && timer.it_value.tv_usec == 0)
        timer.it_value.tv_usec = 1;
    ::setitimer(ITIMER_REAL, &timer, nullptr);
}

std::optional<double> seconds_left() {
    if (!time_limit)
        return {};
    const auto& [since, seconds] = *time_limit;
    return std::max(seconds - std::chrono::duration<double>(Clock::now() - since).count(), 0.0);
}

}
