#include "program.h"

namespace alcove::test {
namespace {

struct Damage {
    std::string name, bytes;
    std::vector<std::string> message_parts;
};

std::string binary_stl_cut_short() {
    std::string bytes(84, '\0');
    bytes[80] = 100; // number of triangles in the header
    return bytes + std::string(50, 'x');
}

const std::vector<Damage>& damages() {
    static const std::vector<Damage> all{
        {"cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n", {"cut.ply", "line"}},
        {"cut_rows.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 1000000\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\nabc",
         {"cut_rows.ply"}},
        {"index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", {"index.off", "line 6"}},
        {"word.obj", "v 0 0 0\nv 1 0 x\nv 0 1 0\nf 1 2 3\n", {"word.obj", "line 2"}},
        {"cut.stl", binary_stl_cut_short(), {"cut.stl"}},
        {"points.obj", "v 0 0 0\nv 1 0 0\n", {"points.obj", "no faces"}},
        {"empty.off", "", {"empty.off", "empty"}},
        {"prose.txt", "It was a dark and stormy night.\n", {"prose.txt", "PLY, OBJ, OFF, STL and glTF"}},
    };
    return all;
}

using Inputs = ProgramTest;

TEST_F(Inputs, DamagedOnesAreRefusedByNameAndPlace) {
    for (const Damage& damage : damages()) {
        write(damage.name, damage.bytes);
        expect_refusal({"bake", damage.name, "-o", "b.ply"}, bad_input, damage.message_parts);
        expect_refusal({"voxelize", damage.name, "-o", "b.vdb"}, bad_input, damage.message_parts);
        expect_refusal({"info", damage.name}, bad_input, damage.message_parts);
        expect_refusal({"info", damage.name, "--json"}, bad_input, damage.message_parts);
    }
    EXPECT_EQ(files().size(), damages().size());
}

TEST_F(Inputs, TooFewPointsAreRefused) {
    write("points.ply",
          "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
          "end_header\n0 0 0\n1 1 1\n");
    expect_refusal({"bake", "points.ply", "-o", "b.ply"}, bad_input,
                   {"points.ply", "fewer than three different points"});
    expect_refusal({"voxelize", "points.ply", "-o", "b.vdb"}, bad_input, {"points.ply", "fewer than three"});
    EXPECT_EQ(run({"info", "points.ply"}).code, done);
}

TEST_F(Inputs, MissingOnesAndFoldersAreRefused) {
    std::filesystem::create_directory(folder_ / "work/folder.ply");
    std::filesystem::create_directory(folder_ / "work/folder.vdb");
    for (const char* name : {"none.ply", "folder.ply"}) {
        expect_refusal({"bake", name, "-o", "b.ply"}, bad_input, {name});
        expect_refusal({"voxelize", name, "-o", "b.vdb"}, bad_input, {name});
        expect_refusal({"info", name}, bad_input, {name});
    }
    for (const char* name : {"none.vdb", "folder.vdb"})
        expect_refusal({"info", name}, bad_input, {name});
}

TEST_F(Inputs, AMeshWithoutAreaIsRefusedByEveryMethod) {
    write("flat.off", "OFF\n4 2 0\n0 0 0\n0.1 0.1 0.1\n0.3 0.3 0.3\n0.7 0.7 0.7\n3 0 1 2\n3 1 2 3\n");
    write("point.off", "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n");
    for (const std::string file : {"flat.off", "point.off"}) {
        for (const char* method : {"exact", "traced", "classic", "guided", "calibrated"})
            expect_refusal({"bake", file, "-o", "out.ply", "--method", method}, bad_input, {file, "area"});
        for (const char* via : {"grid", "auto", "mesh"})
            expect_refusal({"bake", file, "-o", "out.ply", "--via", via}, bad_input, {file, "area"});
        expect_refusal({"bake", file, "-o", "out.ply", "--self"}, bad_input, {file, "area"});
    }
}

TEST_F(Inputs, ATooFineVoxelIsRefusedWithOneThatFits) {
    write("cube.off", cube_off);
    expect_refusal({"bake", "cube.off", "-o", "b.ply", "--voxel", "1e-9"}, bad_input,
                   {"cube.off", "GB", "--voxel", "--max-memory"});
}

TEST_F(Inputs, ALineBreakInANameStaysOneLine) {
    expect_refusal({"info", "two\nlines.ply"}, bad_input, {"two?lines.ply"});
}

TEST_F(Inputs, ControlCharactersOfNamesDoNotReachTheTerminal) {
    const std::string file = "a\x1b]0;pwn\x07\xc2\x9b.ply";
    write(file, "ply\nformat ascii 1.0\ncomment \x1b[2J\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nproperty float \x1b]0;pwn\x07\nproperty float \xc2\x9b"
                "31m\x7f\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                "0 0 0 1 1\n1 0 0 1 1\n0 1 0 1 1\n3 0 1 2\nrest\x1b\n");
    const auto is_plain = [](const std::string& text) {
        return text.find_first_of("\x1b\x07\x7f") == std::string::npos && text.find("\xc2\x9b") == std::string::npos;
    };
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"info", file},
                                                      {"info", file, "--json"},
                                                      {"bake", file, "-o", "\x1b.ply"},
                                                      {"bake", file, "-o", "\x1b.obj"},
                                                      {"bake", file, "-o", "\x1b.ply", "--json"},
                                                      {"voxelize", file, "-o", "\x1b.vdb"},
                                                      {"render", file, "-o", "\x1b.png", "--size", "8x8"},
                                                      {"measure", file, "--methods", "exact:16"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done) << outcome.err;
        EXPECT_TRUE(is_plain(outcome.out)) << arguments[0] << ": " << outcome.out;
        EXPECT_TRUE(is_plain(outcome.err)) << arguments[0] << ": " << outcome.err;
    }
    EXPECT_EQ(run({"info", file, "--json"}).json().at("elements").at(0).at("properties").at(3).at("name"),
              "\x1b]0;pwn\x07");
}

TEST_F(Inputs, DamagedImagesAndGridsAreRefused) {
    write("image.exr", std::string("\x76\x2f\x31\x01", 4) + "rest");
    expect_refusal({"info", "image.exr"}, bad_input, {"image.exr", "not a readable EXR or PNG image"});
    write("damaged.vdb", "no grid at all");
    expect_refusal({"info", "damaged.vdb"}, bad_input, {"damaged.vdb"});
}

TEST_F(Inputs, NamesMayHoldSpacesAndAnyLetters) {
    for (const char* name : {"two words.off", "W\xc3\xbcrfel \xe7\xab\x8b\xe6\x96\xb9.off", "-minus.off"}) {
        write(name, cube_off);
        const std::string input = std::string("./") + name, output = std::string("./") + name + ".ply";
        const Outcome baked = run({"bake", input, "-o", output, "--method", "classic", "--json"});
        EXPECT_EQ(baked.code, done) << baked.err;
        EXPECT_EQ(baked.json().at("input"), input);
        const Outcome described = run({"info", output, "--json"});
        EXPECT_EQ(described.code, done) << described.err;
        EXPECT_EQ(described.json().at("vertices"), 8);
    }
}

}
}
