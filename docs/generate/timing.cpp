#include "timing.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>

namespace alcove::docs {
namespace {

double process_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string read_all(int descriptor) {
    std::string text;
    std::array<char, 4096> part{};
    for (ssize_t got = 0; (got = ::read(descriptor, part.data(), part.size())) > 0;)
        text.append(part.data(), static_cast<std::size_t>(got));
    ::close(descriptor);
    return text;
}

}

double warm_cpu_seconds_of(const std::function<void()>& work) {
    work();
    const double begin = process_seconds();
    work();
    return process_seconds() - begin;
}

std::vector<double> medians(const std::vector<std::function<double()>>& timers, int rounds) {
    std::vector<std::vector<double>> times_of(timers.size());
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < timers.size(); ++i)
            times_of[i].push_back(timers[i]());
    std::vector<double> result;
    result.reserve(times_of.size());
    for (std::vector<double>& times : times_of) {
        std::sort(times.begin(), times.end());
        result.push_back(times[times.size() / 2]);
    }
    return result;
}

Run run(const std::vector<std::string>& command) {
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const std::string& argument : command)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::runtime_error("cannot create a pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    const auto begin = std::chrono::steady_clock::now();
    pid_t child = 0;
    const int failed = posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    Run result;
    result.output = read_all(ends[0]);
    int status = 1;
    rusage usage{};
    if (failed != 0 || ::wait4(child, &status, 0, &usage) != child || status != 0)
        throw std::runtime_error(command[0] + " failed");
    result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    return result;
}

}
