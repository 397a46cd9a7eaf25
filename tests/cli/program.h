/// The built program as its users meet it: run in a process of its own, in a folder of its own.
#pragma once

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

/// A new folder for each test, in which the program runs; removed at the end.
class ProgramTest : public testing::Test {
  protected:
    ProgramTest();
    ~ProgramTest() override;

    /// stdin is closed, stdout and stderr are no terminals; permissions of files bind root too.
    Outcome run(std::vector<std::string> arguments) const;

    /// The same, ended by a signal some milliseconds after it began, if it is not done by then.
    Outcome run_until(std::vector<std::string> arguments, int signal, int milliseconds) const;

    /// The same, ended by a signal as soon as part of a file is there.
    Outcome run_until_part(std::vector<std::string> arguments, int signal) const;

    /// Expects that exit code, nothing on stdout, and one line on stderr that holds all of `parts`.
    void expect_refusal(const std::vector<std::string>& arguments, int code,
                        const std::vector<std::string>& parts) const;

    std::string write(const std::string& name, std::string_view bytes) const; ///< gives the name back
    std::string bytes_of(const std::string& name) const;
    std::vector<std::string> files() const; ///< of the folder, sorted

    std::filesystem::path folder_;
    std::size_t most_memory_ = 0;  ///< bytes of address space for the program; 0: any number
    std::size_t largest_file_ = 0; ///< bytes a program may put in a file, as on a full disk; 0: any number

  private:
    pid_t start(std::vector<std::string> arguments) const;
    Outcome finish(pid_t child) const;
};

enum ExitCode { done = 0, failure = 1, usage = 2, bad_input = 3 };

/// A cube of six quads, standing in a corner of the scene, as OFF.
extern const char* const cube_off;

/// A mesh of the archive that setup unpacks.
std::string real_mesh(const std::string& name);

}
