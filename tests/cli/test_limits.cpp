/// Limits on memory, reading and time.
#include "special_files.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace alcove::test {
namespace {

using Limits = SpecialFiles;

TEST_F(Limits, TakeSizesOnEveryVerb) {
    for (const char* option : {"--max-memory", "--max-read"}) {
        for (const char* size : {"2GB", "500MB", "1.5GiB", "64k", "1e9", "20 mb", "3000000"}) {
            const Outcome outcome = run({"info", "cube.off", option, size});
            EXPECT_EQ(outcome.code, std::string(size).find(' ') == std::string::npos ? done : usage) << size;
        }
        for (const char* size : {"", "GB", "0", "-1GB", "2XB", "nan", "inf", "1,5GB"})
            expect_refusal({"info", "cube.off", option, size}, usage, {option, "takes a size", "1.5GiB"});
        for (const char* verb : {"bake", "voxelize", "render", "measure", "info", "methods"})
            expect_refusal({verb, "cube.off", option, "many"}, usage, {option, "'many'"});
    }
}

TEST_F(Limits, AFileThatIsTooLargeIsRefusedUnread) {
    write("sparse.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::filesystem::resize_file(folder_ / "work/sparse.obj", std::uintmax_t{1} << 40);
    expect_refusals(readings_of("sparse.obj"), {}, {"sparse.obj: is larger than", "--max-read"});
    expect_refusals(readings_of("cube.off"), {"--max-read", "100"},
                    {"cube.off: is larger than 100 bytes", "--max-read"});
    expect_refusal({"info", "cube.off", "--max-memory", "100"}, bad_input, {"larger than 50 bytes", "--max-memory"});
    EXPECT_EQ(run({"info", "cube.off", "--max-read", std::to_string(std::string(cube_off).size())}).code, done);
    write("scene.toml", "[[object]]\nshape = \"mesh\"\nfile = \"cube.off\"\n");
    expect_refusal({"render", "scene.toml", "-o", "out.png", "--max-read", "20"}, bad_input,
                   {"scene.toml", "20 bytes"});
    ASSERT_EQ(run({"voxelize", "cube.off", "-o", "cube.vdb", "--voxel", "5%"}).code, done);
    ASSERT_EQ(run({"render", "cube.off", "-o", "cube.png", "--size", "32x32"}).code, done);
    for (const char* file : {"cube.vdb", "cube.png"})
        expect_refusal({"info", file, "--max-read", "200"}, bad_input, {file, "larger than 200 bytes"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "work/out.png"));
}

TEST_F(Limits, AnEndlessPipeIsReadUpToTheLimit) {
    const std::string pipe = make_pipe("endless.obj");
    std::atomic<bool> over{false};
    std::thread writer([&] {
        const int descriptor = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK); // does not wait for a reader
        const std::string lines(65536, '\n');
        while (!over)
            if (::write(descriptor, lines.data(), lines.size()) < 0)
                ::poll(nullptr, 0, 1); // the pipe is full
        ::close(descriptor);
    });
    expect_refusals(readings_of("endless.obj"), {"--max-read", "3MB"},
                    {"endless.obj: is larger than 3 MB", "--max-read"});
    over = true;
    writer.join();
}

TEST_F(Limits, LessMemoryMakesAGridCoarser) {
    const std::string mesh = real_mesh("elephant.off");
    const auto voxel = [&](const char* memory) {
        const Outcome outcome = run({"bake", mesh, "-o", "out.ply", "--method", "traced", "--rays", "1", "--no-pilot",
                                     "--json", "--max-memory", memory, "--max-read", "1GB"});
        EXPECT_EQ(outcome.code, done) << outcome.err;
        return outcome.json().at("voxel").get<double>();
    };
    EXPECT_GT(voxel("10MB"), 1.5 * voxel("1GB"));
    expect_refusal({"voxelize", mesh, "-o", "out.vdb", "--voxel", "0.1%", "--max-memory", "30MB", "--max-read", "1GB"},
                   bad_input, {"over the limit of 0.03 GB", "--voxel", "--max-memory"});
    // A memory limit that is too small for any grid is no reason to refuse rays on the mesh.
    EXPECT_EQ(run({"bake", "cube.off", "-o", "out.ply", "--method", "exact", "--max-memory", "10kB"}).code, done);
    expect_refusal({"bake", "cube.off", "-o", "out.ply", "--method", "traced", "--max-memory", "10kB"}, bad_input,
                   {"cube.off", "--max-memory"});
}

/// The output is one line, whichever comes first: the refusal or the limit.
TEST_F(Limits, ARefusalAtTheTimeLimitIsOneLine) {
    write("damaged.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    for (int i = 1; i <= 100; ++i) {
        const Outcome outcome = run({"bake", "damaged.off", "-o", "out.ply", "--time-limit", std::to_string(1e-4 * i)});
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        const bool refused = outcome.err.find("damaged.off") != std::string::npos;
        EXPECT_EQ(outcome.code, refused ? bad_input : failure) << outcome.err;
    }
}

}
}
