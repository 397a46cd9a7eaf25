/// However a run ends, the output file is either the unchanged old one or a complete new one.
#include "program.h"

#include <chrono>
#include <csignal>
#include <sstream>

namespace alcove::test {
namespace {

/// A verb with its arguments, except the name of the output.
struct Job {
    const char* name;
    std::vector<std::string> arguments; ///< a few seconds of work
    std::string output;                 ///< appended to the arguments, the last of which is an option

    friend void PrintTo(const Job& job, std::ostream* out) { *out << job.name; }
};

std::vector<Job> jobs() {
    const std::string mesh = real_mesh("armadillo.off");
    return {
        {"BakePly", {"bake", mesh, "--method", "traced", "--rays", "2048", "-o"}, "out.ply"},
        {"BakeObj", {"bake", mesh, "--method", "traced", "--rays", "2048", "-o"}, "out.obj"},
        {"WriteGrid", {"bake", mesh, "--voxel", "0.15%", "-o", "other.ply", "--write-grid"}, "out.vdb"},
        {"Voxelize", {"voxelize", mesh, "--voxel", "0.1%", "-o"}, "out.vdb"},
        {"RenderExr", {"render", mesh, "--size", "1600x1200", "--method", "traced", "--rays", "256", "-o"}, "out.exr"},
        {"RenderPng", {"render", mesh, "--size", "1600x1200", "--method", "traced", "--rays", "256", "-o"}, "out.png"},
        {"MeasureReport", {"measure", mesh, "--report"}, "out.html"}};
}

class Faults : public ProgramTest, public testing::WithParamInterface<Job> {
  protected:
    Faults() { write(GetParam().output, old_); }
    std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = GetParam().arguments;
        all.push_back(GetParam().output);
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Arguments of the same verb for less work.
    std::vector<std::string> quick_arguments(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = arguments(more);
        for (std::string& word : all)
            word = word == "2048" || word == "256" ? "1" : word == "1600x1200" ? "320x240" : word;
        return all;
    }
    void expect_untouched() const {
        EXPECT_TRUE(bytes_of(GetParam().output) == old_);
        expect_no_parts();
    }
    void expect_no_parts() const {
        for (const std::string& file : files())
            EXPECT_FALSE(file.starts_with(".alcove-")) << file;
    }
    /// An output path that cannot be written is detected before any work.
    void expect_failure_at_once() const {
        const Outcome outcome = run(arguments({"--time-limit", "1"}));
        EXPECT_EQ(outcome.code, failure) << outcome.err;
        EXPECT_NE(outcome.err.find(": cannot be written: Permission denied"), std::string::npos) << outcome.err;
        expect_one_line(outcome);
        expect_untouched();
    }
    static void expect_one_line(const Outcome& outcome) {
        std::size_t errors = 0;
        std::istringstream lines(outcome.err);
        for (std::string line; std::getline(lines, line);)
            errors += line.starts_with("alcove: ") && !line.starts_with("alcove: warning");
        EXPECT_EQ(errors, 1u) << outcome.err;
    }

    const std::string old_ = "what was there before\n";
};

TEST_P(Faults, FullDisk) {
    max_file_size_ = 4096;
    const Outcome outcome = run(quick_arguments());
    EXPECT_EQ(outcome.code, failure) << outcome.err;
    expect_one_line(outcome);
    expect_untouched();
}

TEST_P(Faults, TimeIsUp) {
    for (const char* seconds : {"0.001", "0.2", "0.4"}) {
        const Outcome outcome = run(arguments({"--time-limit", seconds}));
        EXPECT_EQ(outcome.code, failure) << outcome.err; // failed or refused
        expect_one_line(outcome);
        EXPECT_NE(outcome.err.find("--time-limit"), std::string::npos) << outcome.err;
        expect_untouched();
    }
}

TEST_P(Faults, Interrupted) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const auto begin = std::chrono::steady_clock::now();
        constexpr int milliseconds = 300;
        const Outcome outcome = run_until(arguments(), signal, milliseconds);
        EXPECT_EQ(outcome.code, -signal) << outcome.err;
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(milliseconds + 1000));
        expect_untouched();
    }
}

/// A signal after the file was renamed into place leaves the new file.
TEST_P(Faults, InterruptedWhileItWrites) {
    for (const int signal : {SIGINT, SIGTERM}) {
        const Outcome outcome = run_until_part(quick_arguments(), signal);
        if (outcome.code == done) // before the signal arrived
            continue;
        EXPECT_EQ(outcome.code, -signal) << outcome.err;
        expect_no_parts();
        EXPECT_GE(bytes_of(GetParam().output).size(), old_.size());
    }
}

/// SIGKILL allows no cleanup: the partial file stays next to the old one.
TEST_P(Faults, Killed) {
    EXPECT_EQ(run_until(arguments(), SIGKILL, 300).code, -SIGKILL);
    EXPECT_TRUE(bytes_of(GetParam().output) == old_);
}

/// If memory suffices, the run succeeds.
TEST_P(Faults, LittleMemory) {
    if (GetParam().output == "out.html")
        GTEST_SKIP() << "a report is always complete and states what did not fit in memory";
    int refused = 0;
    for (const std::size_t megabytes : {160, 180, 200, 230, 260}) {
        max_memory_ = megabytes << 20;
        const Outcome outcome = run(quick_arguments({"--threads", "1"}));
        if (outcome.code == done)
            break;
        ++refused;
        // c-blosc 1.21 does not check whether allocations succeeded.
        if (outcome.code != -SIGSEGV || GetParam().output != "out.vdb") {
            EXPECT_TRUE(outcome.code == failure || outcome.code == bad_input) << megabytes << ": " << outcome.code;
            expect_one_line(outcome);
        }
        expect_untouched();
    }
    EXPECT_GT(refused, 0);
}

TEST_P(Faults, ReadOnlyFile) {
    std::filesystem::permissions(folder_ / "work" / GetParam().output, std::filesystem::perms::owner_read);
    expect_failure_at_once();
}

TEST_P(Faults, ReadOnlyFolder) {
    using std::filesystem::perms;
    std::filesystem::permissions(folder_ / "work", perms::owner_read | perms::owner_exec);
    expect_failure_at_once();
    std::filesystem::permissions(folder_ / "work", perms::owner_all);
}

TEST_P(Faults, OutputIsAFolder) {
    std::filesystem::remove(folder_ / "work" / GetParam().output);
    std::filesystem::create_directory(folder_ / "work" / GetParam().output);
    const std::vector<std::string> before = files();
    const Outcome outcome = run(arguments());
    EXPECT_EQ(outcome.code, failure) << outcome.err;
    EXPECT_NE(outcome.err.find("folder"), std::string::npos) << outcome.err;
    EXPECT_EQ(files(), before);
}

INSTANTIATE_TEST_SUITE_P(Jobs, Faults, testing::ValuesIn(jobs()),
                         [](const auto& job) { return std::string(job.param.name); });

}
}
