/// Inputs and outputs that are not ordinary files, or cannot be read.
#include "special_files.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <thread>

namespace alcove::test {
namespace {

TEST_F(SpecialFiles, APipeIsReadLikeAFile) {
    const std::string pipe = make_pipe("pipe.off");
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"info", "pipe.off"}, {"bake", "pipe.off", "-o", "out.ply"}}) {
        std::thread writer([&] {
            int descriptor = -1;
            for (int i = 0; i < 5000 && descriptor < 0; ++i) { // until there is a reader
                descriptor = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK);
                ::poll(nullptr, 0, 1);
            }
            const std::string text = cube_off;
            EXPECT_EQ(::write(descriptor, text.data(), text.size()), static_cast<ssize_t>(text.size()));
            ::close(descriptor);
        });
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done) << outcome.err;
        writer.join();
    }
}

/// The memory of a process is a regular file whose first page cannot be read, however often one tries.
TEST_F(SpecialFiles, AFileThatCannotBeReadIsRefusedAtOnce) {
    for (const char* name : {"unreadable.ply", "unreadable.vdb", "unreadable.toml", "unreadable.png"})
        link("/proc/self/mem", name);
    write("names.toml", "[[object]]\nshape = \"mesh\"\nfile = \"/proc/self/mem\"\n");
    write("names_grid.toml", "[[object]]\nshape = \"vdb\"\nfile = \"unreadable.vdb\"\n");
    expect_refusals(readings_of("unreadable.ply"), {}, {"unreadable.ply: cannot be read: Input/output error"});
    expect_refusals({{"info", "unreadable.vdb"},
                     {"info", "unreadable.png"},
                     {"bake", "unreadable.vdb", "-o", "out.ply"},
                     {"bake", "cube.off", "--grid", "unreadable.vdb", "-o", "out.ply"},
                     {"render", "unreadable.vdb", "-o", "out.png"},
                     {"render", "unreadable.toml", "-o", "out.png"},
                     {"render", "names.toml", "-o", "out.png"},
                     {"render", "names_grid.toml", "-o", "out.png"}},
                    {}, {"cannot be read: Input/output error"});
}

/// A library opens these files by itself, so they cannot be pipes, and nothing waits for a writer.
TEST_F(SpecialFiles, GridsAndImagesMustBeFiles) {
    make_pipe("pipe.vdb");
    make_pipe("pipe.png");
    link("/dev/zero", "device.vdb");
    link("/dev/zero", "device.exr");
    link("loop.vdb", "loop.vdb");
    for (const std::string file : {"pipe.vdb", "pipe.png"})
        expect_refusal({"info", file}, bad_input, {file + ": is a pipe"});
    for (const std::string file : {"device.vdb", "device.exr"})
        expect_refusal({"info", file}, bad_input, {file + ": is a device"});
    expect_refusals({{"bake", "pipe.vdb", "-o", "out.ply"},
                     {"bake", "cube.off", "--grid", "pipe.vdb", "-o", "out.ply"},
                     {"render", "pipe.vdb", "-o", "out.png"}},
                    {}, {"pipe.vdb: is a pipe"});
    expect_refusal({"info", "loop.vdb"}, bad_input, {"loop.vdb: cannot be opened: Too many levels of symbolic links"});
}

TEST_F(SpecialFiles, OutputsMustBeFilesOrLinksToFiles) {
    const std::vector<std::vector<std::string>> runs{
        {"bake", "cube.off", "-o", "out.ply"},
        {"bake", "cube.off", "-o", "out.obj"},
        {"bake", "cube.off", "-o", "other.ply", "--write-grid", "out.vdb"},
        {"voxelize", "cube.off", "-o", "out.vdb"},
        {"render", "cube.off", "--size", "32x32", "-o", "out.png"},
        {"render", "cube.off", "--size", "32x32", "-o", "out.exr"},
        {"measure", "cube.off", "--methods", "classic", "--report", "out.html"},
        {"measure", "cube.off", "--methods", "classic", "--json", "out.json"},
    };
    for (const std::vector<std::string>& arguments : runs) {
        const std::string& output = arguments.back();
        const std::filesystem::path file = folder_ / "work" / output;
        link("missing", output);
        expect_refusal(arguments, bad_input, {output + ": is a link to missing"});
        EXPECT_TRUE(std::filesystem::is_symlink(file));
        std::filesystem::remove(file);
        link(output, output);
        expect_refusal(arguments, bad_input, {output + ": is a link that leads back to itself"});
        std::filesystem::remove(file);
        link("/dev/null", output);
        expect_refusal(arguments, bad_input, {output + ": is a device"});
        std::filesystem::remove(file);
        make_pipe(output);
        expect_refusal(arguments, bad_input, {output + ": is a pipe"});
        std::filesystem::remove(file);
        if (output == "out.json")
            continue; // it would be read
        link("real", output);
        write("real", "old");
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done) << outcome.err;
        EXPECT_TRUE(std::filesystem::is_symlink(file));
        EXPECT_NE(bytes_of("real"), "old");
        std::filesystem::remove(file);
        std::filesystem::remove(folder_ / "work/other.ply");
    }
    EXPECT_EQ(files(), (std::vector<std::string>{"cube.off", "real"}));
}

}
}
