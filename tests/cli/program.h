/// Runs the built program as users do: in its own process and its own folder.
#pragma once

#include "scratch_folder.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace alcove::test {

struct Outcome {
    int code = -1; ///< exit code; minus the signal that ended the program
    std::string out, err;

    nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// Each test runs the program in a new folder, removed at the end.
class ProgramTest : public testing::Test {
  protected:
    ProgramTest() { std::filesystem::create_directory(folder_ / "work"); }

    /// Runs the program with stdin closed and stdout and stderr not terminals. File permissions apply even to root.
    Outcome run(std::vector<std::string> arguments) const;

    /// Like run(), but sends `signal` after `milliseconds` if the program is still running.
    Outcome run_until(std::vector<std::string> arguments, int signal, int milliseconds) const;

    /// Like run(), but sends `signal` as soon as part of an output file exists.
    Outcome run_until_part(std::vector<std::string> arguments, int signal) const;

    /// Expects the exit code `code`, nothing on stdout, and one line on stderr that contains all of `parts`.
    void expect_refusal(const std::vector<std::string>& arguments, int code,
                        const std::vector<std::string>& parts) const;

    std::string write(const std::string& name, std::string_view bytes) const; ///< returns the name
    std::string bytes_of(const std::string& name) const;
    std::vector<std::string> files() const; ///< of the folder, sorted

    const ScratchFolder folder_;
    std::size_t max_memory_ = 0; ///< bytes of address space for the program; 0: no limit
    std::size_t max_file_size_ =
        0; ///< bytes that the program may write to a file, to simulate a full disk; 0: no limit

  private:
    pid_t start(std::vector<std::string> arguments) const;
    Outcome finish(pid_t child) const;
};

enum ExitCode { done = 0, failure = 1, usage = 2, bad_input = 3 };

/// A cube of six quads in a corner of the scene, as OFF.
extern const char* const cube_off;

/// A mesh of the archive that tools/setup.sh unpacks.
std::string real_mesh(const std::string& name);

}
