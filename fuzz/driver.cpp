// Runs a target without a fuzzer: on the given files, then on random mutations of them.
//
//     fuzz_NAME ROUNDS SEED FILE|FOLDER...
//
// An input that crashes, or takes more than two seconds or 512 MB, is saved as fuzz_NAME.failed in the working folder.
// A folder that does not exist counts as empty.
#include "alcove/base/detail/memory.h"
#include "mutations.h"

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr int max_seconds = 2;
constexpr std::size_t max_bytes = std::size_t{512} << 20;

std::string failure_file; ///< where an input that fails is saved
std::string current;      ///< the input that is being run

/// Async-signal-safe.
[[noreturn]] void save_and_exit(const char* reason) {
    const int file = ::open(failure_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    const bool saved = ::write(file, current.data(), current.size()) == static_cast<ssize_t>(current.size());
    for (const char* part :
         {reason, saved ? "; input saved as " : "; input cannot be saved as ", failure_file.c_str(), "\n"})
        if (::write(STDERR_FILENO, part, std::strlen(part)) < 0)
            break;
    ::_exit(1);
}

void on_signal(int number) {
    save_and_exit(number == SIGALRM ? "an input takes more than two seconds" : "an input crashes the program");
}

/// Handlers run on a stack of their own, in case an input overflows the normal one.
void handle_signals() {
    static std::array<char, 1 << 16> stack;
    const stack_t own{stack.data(), 0, stack.size()};
    ::sigaltstack(&own, nullptr);
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_ONSTACK;
    for (const int number : {SIGALRM, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL})
        ::sigaction(number, &action, nullptr);
}

void set_alarm(int seconds) {
    const itimerval time{{0, 0}, {seconds, 0}};
    ::setitimer(ITIMER_REAL, &time, nullptr);
}

void run(std::string bytes) {
    current = std::move(bytes);
    alcove::forget_peak_resident_bytes();
    const std::size_t before = alcove::peak_resident_bytes();
    set_alarm(max_seconds);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(current.data()), current.size());
    set_alarm(0);
    if (alcove::peak_resident_bytes() > before + max_bytes)
        save_and_exit("an input takes more than 512 MB");
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream input(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(input), {}};
}

/// The contents of the given files and of those in the given folders, sorted by path.
std::vector<std::string> inputs_of(char** begin, char** end) {
    std::vector<std::filesystem::path> files;
    for (; begin != end; ++begin)
        if (std::filesystem::is_regular_file(*begin))
            files.emplace_back(*begin);
        else if (std::filesystem::is_directory(*begin))
            for (const auto& entry : std::filesystem::directory_iterator(*begin))
                files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<std::string> inputs;
    std::transform(files.begin(), files.end(), std::back_inserter(inputs), bytes_of);
    return inputs;
}

}

int main(int count, char** arguments) {
    if (count < 4) {
        std::fprintf(stderr, "usage: %s ROUNDS SEED FILE|FOLDER...\n", arguments[0]);
        return 2;
    }
    const unsigned long rounds = std::strtoul(arguments[1], nullptr, 10),
                        seed = std::strtoul(arguments[2], nullptr, 10);
    const std::vector<std::string> inputs = inputs_of(arguments + 3, arguments + count);
    if (inputs.empty()) {
        std::fprintf(stderr, "%s: no inputs\n", arguments[0]);
        return 2;
    }
    failure_file = std::filesystem::path(arguments[0]).filename().string() + ".failed";
    handle_signals();

    std::printf("%zu inputs, %lu mutations, seed %lu\n", inputs.size(), rounds, seed);
    std::fflush(stdout);
    for (const std::string& input : inputs)
        run(input);
    alcove::fuzz::Random random(seed);
    for (unsigned long round = 0; round < rounds; ++round)
        run(alcove::fuzz::mutated(inputs[random() % inputs.size()], inputs, random));
    return 0;
}
