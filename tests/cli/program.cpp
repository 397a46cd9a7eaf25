#include "program.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include <fcntl.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace alcove::test {

const char* const cube_off = "OFF\n8 6 0\n"
                             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                             "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 0 4 7 3\n";

std::string real_mesh(const std::string& name) {
    return std::string(ALCOVE_REAL_MESHES) + "/" + name;
}

Outcome ProgramTest::run(std::vector<std::string> arguments) const {
    return finish(start(std::move(arguments)));
}

Outcome ProgramTest::run_until(std::vector<std::string> arguments, int signal, int milliseconds) const {
    const pid_t child = start(std::move(arguments));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(child, signal);
    return finish(child);
}

Outcome ProgramTest::run_until_part(std::vector<std::string> arguments, int signal) const {
    const pid_t child = start(std::move(arguments));
    const auto is_part = [](const std::string& name) { return name.starts_with(".alcove-"); };
    for (siginfo_t ended{}; ended.si_pid == 0;) {
        const std::vector<std::string> there = files();
        if (std::any_of(there.begin(), there.end(), is_part)) {
            ::kill(child, signal);
            break;
        }
        ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOHANG | WNOWAIT);
    }
    return finish(child);
}

pid_t ProgramTest::start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), ALCOVE_PROGRAM);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (std::string& argument : arguments)
        words.push_back(argument.data());
    words.push_back(nullptr);
    const std::string work = folder_ / "work", out = folder_ / "out", err = folder_ / "err";

    const pid_t child = ::fork();
    if (child == 0) {
        // Only async-signal-safe calls between fork and exec.
        ::close(STDIN_FILENO);
        const int output = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int errors = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(output, STDOUT_FILENO);
        ::dup2(errors, STDERR_FILENO);
        if (max_file_size_ > 0) {
            const rlimit limit{max_file_size_, max_file_size_};
            ::setrlimit(RLIMIT_FSIZE, &limit);
        }
        if (max_memory_ > 0) {
            const rlimit limit{max_memory_, max_memory_};
            ::setrlimit(RLIMIT_AS, &limit);
        }
        ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
        if (::chdir(work.c_str()) == 0)
            ::execv(words.front(), words.data());
        ::_exit(127);
    }
    return child;
}

Outcome ProgramTest::finish(pid_t child) const {
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), alcove::bytes_of(folder_ / "out"),
            alcove::bytes_of(folder_ / "err")};
}

void ProgramTest::expect_refusal(const std::vector<std::string>& arguments, int code,
                                 const std::vector<std::string>& parts) const {
    std::string line = "alcove";
    for (const std::string& argument : arguments)
        line += " '" + argument + "'";
    SCOPED_TRACE(line);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("alcove: ") && outcome.err.ends_with("\n")) << outcome.err;
    for (const std::string& part : parts)
        EXPECT_NE(outcome.err.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.err;
}

std::string ProgramTest::write(const std::string& name, std::string_view bytes) const {
    std::ofstream output(folder_ / "work" / name, std::ios::binary);
    output.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return name;
}

std::string ProgramTest::bytes_of(const std::string& name) const {
    return alcove::bytes_of(folder_ / "work" / name);
}

std::vector<std::string> ProgramTest::files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "work"))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}
