#include "program.h"

#include <fmt/format.h>

namespace alcove::test {
namespace {

struct Verb {
    std::string name;
    std::vector<std::string> options;
};

const std::vector<Verb> verbs{
    {"bake",
     {"--radius",     "--quality", "--error",    "--via",    "--strict",     "--method", "--samples",        "--rays",
      "--seed",       "--normals", "--sign",     "--voxel",  "--write-grid", "--color",  "--color-encoding", "--grid",
      "--adaptivity", "--self",    "--occluder", "--ground", "--up",         "--weld"}},
    {"voxelize", {"--voxel", "--band", "--radius"}},
    {"render",
     {"--size", "--method", "--radius", "--pass", "--eye", "--look-at", "--up", "--fov", "--pixel-samples",
      "--no-ground", "--no-shadow", "--precision", "--frames", "--normals"}},
    {"measure", {"--radius", "--voxel", "--methods", "--report"}},
    {"info", {}},
};

using Program = ProgramTest;

TEST_F(Program, SaysItsVersion) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"--version"}, {"bake", "--version"}, {"info", "--version"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done);
        EXPECT_TRUE(outcome.out.starts_with("alcove " ALCOVE_VERSION)) << outcome.out;
        EXPECT_EQ(outcome.err, "");
    }
}

TEST_F(Program, HelpNamesEveryVerbAndOptionAndGivesExamples) {
    const Outcome overview = run({"--help"});
    EXPECT_EQ(overview.code, done);
    EXPECT_NE(overview.out.find("alcove bake "), std::string::npos);
    for (const Verb& verb : verbs) {
        SCOPED_TRACE(verb.name);
        EXPECT_NE(overview.out.find("\n  " + verb.name + " "), std::string::npos) << overview.out;
        const Outcome help = run({verb.name, "--help"});
        EXPECT_EQ(help.code, done);
        EXPECT_EQ(help.err, "");
        EXPECT_NE(help.out.find("alcove " + verb.name + " "), std::string::npos);
        EXPECT_NE(help.out.find("xample"), std::string::npos) << help.out;
        std::vector<std::string> options = verb.options;
        options.insert(options.end(), {"--threads", "--json", "--progress", "--time-limit", "--max-memory",
                                       "--max-read", "--quiet", "--help", "--version"});
        for (const std::string& option : options)
            EXPECT_NE(help.out.find(option + " "), std::string::npos) << option << " is not in " << help.out;
    }
}

TEST_F(Program, AsksForAVerbAndNamesTheNearest) {
    expect_refusal({}, usage, {"a verb is needed: bake", "alcove --help"});
    expect_refusal({"frobnicate"}, usage, {"no verb 'frobnicate'", "bake", "info"});
    expect_refusal({"bkae", "a.ply"}, usage, {"no verb 'bkae'", "did you mean bake?"});
    expect_refusal({"--frobnicate"}, usage, {"--frobnicate", "name a verb"});
    expect_refusal({"--threads", "2", "bake", "a.ply", "-o", "b.ply"}, usage, {"--threads", "after the verb"});
}

TEST_F(Program, NamesTheNearestOption) {
    write("cube.off", cube_off);
    expect_refusal({"bake", "cube.off", "-o", "b.ply", "--raduis", "0.1"}, usage,
                   {"no option --raduis", "did you mean --radius?", "alcove bake --help"});
    expect_refusal({"bake", "cube.off", "-o", "b.ply", "--raduis=0.1"}, usage, {"did you mean --radius?"});
    expect_refusal({"bake", "cube.off", "--outptu", "b.ply"}, usage, {"did you mean --output?"});
    expect_refusal({"info", "cube.off", "--jsno"}, usage, {"did you mean --json?"});
    expect_refusal({"bake", "cube.off", "-o", "b.ply", "--method", "guide"}, usage, {"did you mean guided?"});
    expect_refusal({"bake", "cube.off", "-o", "b.ply", "--method", "thickness"}, usage, {"--attributes thickness"});
    expect_refusal({"help", "bake"}, usage, {"alcove bake --help"});
    const Outcome far = run({"bake", "cube.off", "-o", "b.ply", "--zzzzzzzz"});
    EXPECT_EQ(far.code, usage);
    EXPECT_EQ(far.err.find("did you mean"), std::string::npos);
    EXPECT_EQ(files(), std::vector<std::string>{"cube.off"});
}

TEST_F(Program, SaysWhatIsMissingOrTooMuch) {
    expect_refusal({"bake"}, usage, {"input is required"});
    expect_refusal({"info"}, usage, {"file is required"});
    expect_refusal({"bake", "a.ply"}, usage, {"--output is required"});
    expect_refusal({"bake", "a.ply", "b.ply"}, usage, {"--output is required"});
    expect_refusal({"info", "a.ply", "c.ply"}, usage, {"unexpected argument 'c.ply'"});
    expect_refusal({"bake", "a.ply", "-o", "b.ply", "--radius"}, usage, {"--radius needs a value"});
    expect_refusal({"bake", "a.ply", "-o", "b.ply", "--radius", "1", "--radius", "2"}, usage,
                   {"--radius", "more than once"});
}

TEST_F(Program, RefusesBadLengthsBeforeItReadsAnything) {
    for (const char* length : {"-1", "abc", "nan", "0", "-inf", "10 %", "1e", "%", "5%%", "5px"}) {
        expect_refusal({"bake", "none.ply", "-o", "b.ply", "--radius", length}, usage,
                       {"--radius", fmt::format("'{}'", length), "10%"});
        expect_refusal({"voxelize", "none.ply", "-o", "b.vdb", "--voxel", length}, usage,
                       {"--voxel", fmt::format("'{}'", length), "0.5%"});
    }
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--radius", "10vx"}, usage, {"--radius", "--voxel"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--voxel", "2vx"}, usage, {"--voxel"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--voxel", "inf"}, usage, {"--voxel"});
}

TEST_F(Program, RefusesBadNumbersAndWordsBeforeItReadsAnything) {
    for (const char* number : {"-1", "abc", "1.5", "99999999999", "nan"})
        expect_refusal({"bake", "none.ply", "-o", "b.ply", "--threads", number}, usage,
                       {"--threads", "whole number", fmt::format("'{}'", number)});
    const std::vector<std::vector<std::string>> of_methods{
        {"--samples", "x"}, {"--rays", "0.5"}, {"--set", "rays"}, {"--set", "rays=x"}};
    for (const auto& option : of_methods)
        expect_refusal({"bake", "none.ply", "-o", "b.ply", "--method", "traced", option[0], option[1]}, usage,
                       {option[0], option[1]});
    for (const char* rays : {"0", "99999999"})
        expect_refusal({"bake", "none.ply", "-o", "b.ply", "--method", "traced", "--rays", rays}, usage,
                       {"rays of traced", rays});
    const std::vector<std::vector<std::string>> wrong{
        {"--attributes", "a0"}, {"--seed", "-1"},      {"--quality", "best"}, {"--via", "rays"},
        {"--sign", "both"},     {"--normals", "none"}, {"--color", "red"},    {"--color-encoding", "linear"},
        {"--progress", "loud"}};
    for (const auto& option : wrong)
        expect_refusal({"bake", "none.ply", "-o", "b.ply", option[0], option[1]}, usage, {option[0], option[1]});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--error", "1%"}, usage, {"--error takes a number, not '1%'"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--seed", "-1"}, usage,
                   {"--seed takes a whole number from 0 to 4294967295, not '-1'"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--tessellate", "3vx"}, usage,
                   {"--tessellate takes auto, 0.2", "not '3vx'"});
    expect_refusal({"bake", "none.vdb", "-o", "b.ply", "--adaptivity", "2"}, usage,
                   {"--adaptivity takes a number from 0 to 1, not 2"});
    expect_refusal({"render", "none.ply", "-o", "b.png", "--pixel-samples", "0"}, usage,
                   {"--pixel-samples takes a number from 1 to 1024, not 0"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--rays", "9"}, usage, {"--rays needs --method"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--up", "0,0,1"}, usage, {"--up needs --ground"});
    expect_refusal({"measure", "none.ply", "--report", "b.pdf"}, usage, {"b.pdf", ".html"});
    expect_refusal({"render", "none.ply", "-o", "b.png", "--precision", "float"}, usage, {"--precision", ".exr"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--error", "0.1", "--quality", "fine"}, usage,
                   {"--error", "--quality", "cannot be combined"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--method", "classic", "--samples", "-3"}, usage,
                   {"samples of classic", "-3"});
    expect_refusal({"voxelize", "none.ply", "-o", "b.vdb", "--band", "1"}, usage, {"--band", "1"});
    expect_refusal({"bake", "none.ply", "-o", "b.ply", "--method", "clasic"}, usage,
                   {"no method 'clasic'", "classic", "traced"});
}

TEST_F(Program, RefusesAnUnknownOutputBeforeItReadsAnything) {
    for (const char* name : {"b.jpg", "b.off", "b.stl", "b", "b.ply.bak"})
        expect_refusal({"bake", "none.ply", "-o", name}, usage, {name, ".ply, .obj, .glb or .gltf"});
    expect_refusal({"voxelize", "none.ply", "-o", "b.ply"}, usage, {"b.ply", ".vdb"});
    expect_refusal({"render", "none.ply", "-o", "b.jpg"}, usage, {"b.jpg", ".exr or .png"});
    EXPECT_TRUE(files().empty());
}

TEST_F(Program, TellsWhereNothingCanBeWrittenBeforeItReadsAnything) {
    expect_refusal({"bake", "none.ply", "-o", "no/such/b.ply"}, failure, {"no/such/b.ply"});
    std::filesystem::create_directory(folder_ / "work/b.ply");
    expect_refusal({"bake", "none.ply", "-o", "b.ply"}, failure, {"b.ply", "folder"});
    std::filesystem::create_directory(folder_ / "work/locked");
    std::filesystem::permissions(folder_ / "work/locked", std::filesystem::perms::owner_read);
    expect_refusal({"bake", "none.ply", "-o", "locked/b.ply"}, failure, {"locked/b.ply"});
    std::filesystem::permissions(folder_ / "work/locked", std::filesystem::perms::owner_all);
}

}
}
