/// Inputs and outputs that are links, pipes or devices.
#pragma once

#include "program.h"

#include <sys/stat.h>

namespace alcove::test {

class SpecialFiles : public ProgramTest {
  protected:
    SpecialFiles() { write("cube.off", cube_off); }

    void link(const std::string& target, const std::string& name) const {
        std::filesystem::create_symlink(target, folder_ / "work" / name);
    }
    /// Makes a named pipe. Returns its full path.
    std::string make_pipe(const std::string& name) const {
        EXPECT_EQ(::mkfifo((folder_ / "work" / name).c_str(), 0600), 0);
        return folder_ / "work" / name;
    }
    /// One run of each verb that reads a mesh, with `mesh` as input.
    static std::vector<std::vector<std::string>> readings_of(const std::string& mesh) {
        return {{"info", mesh},
                {"bake", mesh, "-o", "out.ply"},
                {"bake", "cube.off", "--occluder", mesh, "-o", "out.ply"},
                {"voxelize", mesh, "-o", "out.vdb"},
                {"render", mesh, "-o", "out.png"},
                {"measure", mesh}};
    }
    /// Expects that each run, with `more` appended to its arguments, ends with exit code 3.
    void expect_refusals(const std::vector<std::vector<std::string>>& runs, const std::vector<std::string>& more,
                         const std::vector<std::string>& parts) const {
        for (std::vector<std::string> arguments : runs) {
            arguments.insert(arguments.end(), more.begin(), more.end());
            expect_refusal(arguments, bad_input, parts);
        }
    }
};

}
