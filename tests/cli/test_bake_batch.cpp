/// Several inputs in one run, and the planner's defaults.
#include "baked.h"
#include "program.h"
#include "shapes.h"

#include "alcove/bake/bake.h"
#include "alcove/mesh/files.h"

#include <sstream>

namespace alcove::test {
namespace {

class BakeBatch : public ProgramTest {
  protected:
    void write_sphere(const std::string& name, int level = 3) const {
        std::filesystem::create_directories((folder_ / "work" / name).parent_path());
        write_mesh(sphere_mesh(level), folder_ / "work" / name);
    }
    std::string text_of(const std::string& name) const { return bytes_of(name); }
};

TEST_F(BakeBatch, OneOutputPerInputWithTheBytesOfSingleRuns) {
    write_sphere("a.ply");
    write_sphere("b.obj", 2);
    write("cube.off", cube_off);
    const Outcome outcome = run({"bake", "a.ply", "b.obj", "cube.off", "-o", "baked/", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    std::istringstream lines(outcome.out);
    std::vector<std::string> inputs;
    for (std::string line; std::getline(lines, line);)
        inputs.push_back(nlohmann::json::parse(line).at("input"));
    EXPECT_EQ(inputs, (std::vector<std::string>{"a.ply", "b.obj", "cube.off"}));
    for (const auto& [input, output] :
         {std::pair("a.ply", "a.ply"), std::pair("b.obj", "b.obj"), std::pair("cube.off", "cube.ply")}) {
        ASSERT_EQ(run({"bake", input, "-o", std::string("single_") + output}).code, done);
        EXPECT_EQ(text_of(std::string("baked/") + output), text_of(std::string("single_") + output)) << input;
    }
}

TEST_F(BakeBatch, AFailureDoesNotStopTheOthers) {
    write_sphere("a.ply");
    write("broken.off", "OFF\n3 1 0\n0 0 0\n");
    write("cube.off", cube_off);
    const Outcome outcome = run({"bake", "a.ply", "broken.off", "none.stl", "cube.off", "-o", "baked/"});
    EXPECT_EQ(outcome.code, bad_input);
    EXPECT_NE(outcome.err.find("alcove: broken.off"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("alcove: none.stl"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("2 of 4 inputs failed"), std::string::npos) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "work/baked/a.ply"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "work/baked/cube.ply"));
}

TEST_F(BakeBatch, WarningsNameTheirInput) {
    write_sphere("a.ply");
    write("lost.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n");
    const Outcome outcome = run({"bake", "a.ply", "lost.obj", "-o", "baked/"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_NE(outcome.err.find("warning: lost.obj: 1 of 4 vertices"), std::string::npos) << outcome.err;
}

TEST_F(BakeBatch, EqualNamesGetTheirFoldersInFront) {
    write_sphere("left/part.ply");
    write_sphere("right/part.ply", 2);
    ASSERT_EQ(run({"bake", "left/part.ply", "right/part.ply", "-o", "baked/", "--quiet"}).code, done);
    EXPECT_EQ(read_mesh(folder_ / "work/baked/left_part.ply").vertex_count(), sphere_mesh(3).vertex_count());
    EXPECT_EQ(read_mesh(folder_ / "work/baked/right_part.ply").vertex_count(), sphere_mesh(2).vertex_count());
    expect_refusal({"bake", "left/part.ply", "left/part.ply", "-o", "baked/"}, usage, {"left/part.ply is given twice"});
}

TEST_F(BakeBatch, NoOutputReplacesAnInput) {
    write_sphere("in/a.ply");
    write_sphere("in/b.ply");
    const std::string before = text_of("in/a.ply");
    expect_refusal({"bake", "in/a.ply", "in/b.ply", "-o", "in/"}, usage, {"in/a.ply", "replace"});
    EXPECT_EQ(text_of("in/a.ply"), before);
    expect_refusal({"bake", "in/a.ply", "in/b.ply", "-o", "out.ply"}, usage, {"2 inputs", "folder"});
    expect_refusal({"bake", "in/a.ply", "in/b.ply", "-o", "out/", "--write-grid", "g.vdb"}, usage, {"--write-grid"});
}

TEST_F(BakeBatch, TheProgramWritesTheBytesOfTheLibrary) {
    const std::string input = real_mesh("elephant.off");
    ASSERT_EQ(run({"bake", input, "-o", "program.ply"}).code, done);
    auto mesh = alcove::read_mesh(input);
    const auto baked = alcove::bake(mesh, {.radius = "10%", .quality = alcove::Quality::good});
    alcove::add(mesh, baked);
    alcove::write_mesh(mesh, folder_ / "work/library.ply");
    EXPECT_EQ(text_of("library.ply"), text_of("program.ply"));
}

TEST_F(BakeBatch, TheDefaultMeetsAnRmseOfTwoHundredthsThroughTheGrid) {
    const Outcome outcome = run({"bake", real_mesh("elephant.off"), "-o", "a.ply", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_LE(outcome.json().at("estimated_rmse"), 0.02);
    EXPECT_GT(outcome.json().at("levels"), 0);
    EXPECT_TRUE(outcome.json().at("reason").is_null());
    const Outcome rays = run({"bake", real_mesh("elephant.off"), "-o", "a.ply", "--json", "--via", "mesh"});
    EXPECT_EQ(rays.json().at("method"), "exact");
    const Outcome fine = run({"bake", real_mesh("elephant.off"), "-o", "a.ply", "--json", "--quality", "fine"});
    EXPECT_LE(fine.json().at("estimated_rmse"), 0.005);
}

TEST_F(BakeBatch, StrictWritesNothingWhereTheErrorIsMissed) {
    const std::string mesh = real_mesh("elephant.off");
    const Outcome missed =
        run({"bake", mesh, "-o", "a.ply", "--method", "classic", "--error", "0.01", "--strict", "--quiet"});
    EXPECT_EQ(missed.code, failure);
    EXPECT_NE(missed.err.find("misses the error target of 0.01"), std::string::npos) << missed.err;
    EXPECT_TRUE(files().empty());
    EXPECT_EQ(run({"bake", mesh, "-o", "a.ply", "--strict"}).code, done);
    expect_refusal({"bake", mesh, "-o", "b.ply", "--strict", "--method", "classic"}, usage, {"--strict", "--error"});
    expect_refusal({"bake", mesh, "-o", "b.ply", "--quality", "fine", "--error", "0.01"}, usage,
                   {"--error", "--quality"});
    expect_refusal({"bake", mesh, "-o", "b.ply", "--rays", "8"}, usage, {"--rays", "--method"});
}

}
}
