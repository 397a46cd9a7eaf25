#include "program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove::test {
namespace {

class RenderVerb : public ProgramTest {
  protected:
    /// Renders a small image quickly.
    Outcome draw(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "render");
        for (const char* word : {"--size", "64x48", "--pixel-samples", "1", "--json"})
            arguments.emplace_back(word);
        return run(std::move(arguments));
    }
};

const char* const scene_toml = R"(
[image]
width = 80
height = 60
samples = 2
[camera]
eye = [0, 3, -6]
look_at = [0, 0.7, 0]
[occlusion]
method = "hemisphere"
radius = 0.5
samples = 8
[ground]
[[object]]
shape = "difference"
part = [{ shape = "sphere" }, { shape = "box", translate = [0, 1, 0] }]
[[object]]
shape = "mesh"
file = "cube.off"
translate = [3, 0, 0]
)";

TEST_F(RenderVerb, DrawsAScene) {
    write("cube.off", cube_off);
    write("scene.toml", scene_toml);
    const Outcome drawn = run({"render", "scene.toml", "-o", "a.exr", "--json"});
    ASSERT_EQ(drawn.code, done) << drawn.err;
    const auto result = drawn.json();
    EXPECT_EQ(result["width"], 80);
    EXPECT_EQ(result["height"], 60);
    EXPECT_EQ(result["method"], "hemisphere");
    EXPECT_NEAR(result["radius"].get<double>(), 0.5, 1e-6);
    EXPECT_EQ(result["camera"]["eye"], nlohmann::json::parse("[0.0, 3.0, -6.0]"));
    EXPECT_GT(result["covered_pixels"], 2000);
    EXPECT_GT(result["voxel"], 0.0);
}

TEST_F(RenderVerb, TheCommandLineGoesBeforeTheScene) {
    write("cube.off", cube_off);
    write("scene.toml", scene_toml);
    const Outcome drawn = draw({"scene.toml", "-o", "a.png", "--method", "classic", "--radius", "0.25", "--eye",
                                "0,2,5", "--fov", "30", "--no-ground"});
    ASSERT_EQ(drawn.code, done) << drawn.err;
    const auto result = drawn.json();
    EXPECT_EQ(result["width"], 64);
    EXPECT_EQ(result["method"], "classic");
    EXPECT_NEAR(result["radius"].get<double>(), 0.25, 1e-6);
    EXPECT_EQ(result["camera"]["eye"], nlohmann::json::parse("[0.0, 2.0, 5.0]"));
    EXPECT_NEAR(result["camera"]["fov"].get<double>(), 30.0, 1e-9);
    EXPECT_LT(result["covered_pixels"], 64 * 48 / 2);
}

TEST_F(RenderVerb, ABareMeshStandsOnAGroundUnlessToldOtherwise) {
    write("cube.off", cube_off);
    const Outcome with = draw({"cube.off", "-o", "a.png"}), without = draw({"cube.off", "-o", "b.png", "--no-ground"});
    ASSERT_EQ(with.code, done) << with.err;
    ASSERT_EQ(without.code, done) << without.err;
    EXPECT_GT(with.json()["covered_pixels"], without.json()["covered_pixels"].get<int>() + 200);
}

TEST_F(RenderVerb, WritesThePassesThatAreAskedFor) {
    write("cube.off", cube_off);
    const auto channels = [&](const std::string& file) {
        std::string names;
        const auto listed = run({"info", file, "--json"}).json();
        for (const auto& channel : listed["channels"])
            names += channel["name"].get<std::string>() + " ";
        return names;
    };
    ASSERT_EQ(draw({"cube.off", "-o", "a.exr"}).code, done);
    EXPECT_EQ(channels("a.exr"), "A AO.B AO.G AO.R B G N.X N.Y N.Z R Z ");
    ASSERT_EQ(draw({"cube.off", "-o", "b.exr", "--pass", "depth", "--pass", "object"}).code, done);
    EXPECT_EQ(channels("b.exr"), "A Object.V Z ");
    ASSERT_EQ(draw({"cube.off", "-o", "c.exr", "--pass", "all", "--precision", "float"}).code, done);
    EXPECT_NE(channels("c.exr").find("Convexity.R"), std::string::npos);
    expect_refusal({"render", "cube.off", "-o", "d.exr", "--pass", "depht"}, usage, {"depht", "depth", "shadow"});
    expect_refusal({"render", "cube.off", "-o", "d.png", "--pass", "ao", "--pass", "depth"}, usage, {"one pass"});
    expect_refusal({"render", "cube.off", "-o", "d.exr", "--precision", "double"}, usage, {"half or float"});
}

TEST_F(RenderVerb, ATurntableGoesOnWhereItWasCutOff) {
    write("cube.off", cube_off);
    const std::vector<std::string> spin{"cube.off", "-o", "spin.png", "--frames", "4", "--no-ground"};
    const Outcome first = draw(spin);
    ASSERT_EQ(first.code, done) << first.err;
    EXPECT_EQ(first.json()["skipped"], 0);
    const std::vector<std::string> all{"cube.off", "spin_0001.png", "spin_0002.png", "spin_0003.png", "spin_0004.png"};
    EXPECT_EQ(files(), all);
    EXPECT_NE(bytes_of("spin_0001.png"), bytes_of("spin_0002.png"));
    const std::string second = bytes_of("spin_0002.png");
    write("spin_0003.png", "kept");
    std::filesystem::remove(folder_ / "work/spin_0002.png");
    const Outcome again = draw(spin);
    EXPECT_EQ(again.json()["skipped"], 3);
    EXPECT_EQ(bytes_of("spin_0002.png"), second);
    EXPECT_EQ(bytes_of("spin_0003.png"), "kept");
    EXPECT_EQ(draw(spin).json()["skipped"], 4);
    expect_refusal({"render", "cube.off", "-o", "spin.png", "--frames", "0"}, usage, {"--frames"});
}

TEST_F(RenderVerb, DrawsByTheMethodsOfPicturesToo) {
    write("cube.off", cube_off);
    for (const std::string method : {"screen_space", "march_steps"}) {
        const Outcome drawn = draw({"cube.off", "-o", "a.png", "--method", method});
        ASSERT_EQ(drawn.code, done) << drawn.err;
        EXPECT_EQ(drawn.json()["method"], method);
    }
    EXPECT_EQ(draw({"cube.off", "-o", "a.png", "--method", "screen_space", "--samples", "8", "--set", "blur=1"}).code,
              done);
    expect_refusal({"render", "cube.off", "-o", "a.png", "--method", "screen_space", "--set", "blur=3"}, usage,
                   {"blur", "0 to 2"});
    expect_refusal({"render", "cube.off", "-o", "a.png", "--method", "screenspace"}, usage,
                   {"screenspace", "screen_space"});
    expect_refusal({"bake", "cube.off", "-o", "a.ply", "--method", "screen_space"}, usage, {"screen_space"});
}

TEST_F(RenderVerb, DrawsByRaysOnTheTriangles) {
    write("cube.off", cube_off);
    for (const std::string method : {"exact", "guided"})
        EXPECT_EQ(draw({"cube.off", "-o", "a.png", "--method", method, "--rays", "2"}).code, done) << method;
    EXPECT_EQ(draw({"cube.off", "-o", "b.png", "--normals", "field"}).code, done);
    expect_refusal({"render", "cube.off", "-o", "b.png", "--normals", "smooth"}, usage, {"--normals", "smooth"});
    write("painted.toml", "[[object]]\nshape = \"mesh\"\nfile = \"cube.off\"\npainted = true\n");
    expect_refusal({"render", "painted.toml", "-o", "b.png"}, bad_input, {"painted", "no vertex colours"});
}

TEST_F(RenderVerb, ShowsTheColoursOfAMeshUnlessToldOtherwise) {
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                             "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n";
    write("red.ply", head + "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n");
    write("plain.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const auto picture = [&](const std::string& file, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{file, "-o", "a.png"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome drawn = draw(arguments);
        EXPECT_EQ(drawn.code, done) << drawn.err;
        EXPECT_EQ(drawn.err, "");
        return bytes_of("a.png");
    };
    const std::string plain = picture("plain.off", {});
    EXPECT_NE(picture("red.ply", {}), plain);
    EXPECT_EQ(picture("red.ply", {}), picture("red.ply", {"--color", "own"}));
    EXPECT_EQ(picture("red.ply", {"--color", "none"}), plain);
    write("red.toml", "[[object]]\nshape = \"mesh\"\nfile = \"red.ply\"\ncolor = \"own\"\n");
    expect_refusal({"render", "red.toml", "-o", "a.png", "--color", "none"}, usage, {"--color", "red.toml"});
    expect_refusal({"render", "red.ply", "-o", "a.png", "--color", "ao"}, usage, {"--color", "own or none", "'ao'"});
}

TEST_F(RenderVerb, DoesNotShowTheAoOfABakeAsColour) {
    write("cube.off", cube_off);
    for (const char* const baked : {"baked.ply", "baked.obj"}) {
        ASSERT_EQ(run({"bake", "cube.off", "-o", baked, "--ground"}).code, done);
        const Outcome drawn = draw({baked, "-o", "a.png"});
        ASSERT_EQ(drawn.code, done);
        EXPECT_NE(drawn.err.find("ao of an earlier bake"), std::string::npos) << baked << drawn.err;
        EXPECT_EQ(draw({baked, "-o", "a.png", "--color", "none"}).err, "");
    }
}

TEST_F(RenderVerb, FilesOfASceneAreFoundFromItsFolder) {
    std::filesystem::create_directory(folder_ / "work/sub");
    write("sub/cube.off", cube_off);
    write("sub/scene.toml", "[[object]]\nshape = \"mesh\"\nfile = \"cube.off\"\n");
    EXPECT_EQ(draw({"sub/scene.toml", "-o", "a.png"}).code, done);
}

TEST_F(RenderVerb, AnEmptyPictureSaysWhatMadeItSo) {
    write("cube.off", cube_off);
    const std::vector<std::string> quick{"-o", "a.png", "--no-ground", "--method", "none"};
    const auto warning = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), quick.begin(), quick.end());
        const Outcome drawn = draw(arguments);
        EXPECT_EQ(drawn.code, done) << drawn.err;
        return drawn.err;
    };
    EXPECT_NE(warning({"cube.off", "--eye", "99,0,0", "--look-at", "100,0,0"}).find("leave out --eye"),
              std::string::npos);
    write("away.toml", "[camera]\neye = [99, 0, 0]\nlook_at = [100, 0, 0]\n[[object]]\nshape = \"box\"\n");
    EXPECT_NE(warning({"away.toml"}).find("leave out eye and look_at of [camera]"), std::string::npos);
    write("specks.toml",
          "[[object]]\nshape = \"sphere\"\nradius = 1e-4\n[[object]]\nshape = \"sphere\"\nradius = 1e-4\n"
          "translate = [100, 7, 3]\n");
    const std::string specks = warning({"specks.toml"});
    EXPECT_NE(specks.find("smaller than a pixel"), std::string::npos) << specks;
    EXPECT_EQ(specks.find("leave out"), std::string::npos) << specks;
}

TEST_F(RenderVerb, WrongScenesAreNamedWithTheMend) {
    write("typo.toml", "[[object]]\nshape = \"sphere\"\nradus = 2\n");
    expect_refusal({"render", "typo.toml", "-o", "a.png"}, bad_input, {"typo.toml:3", "radus", "radius"});
    write("lost.toml", "[[object]]\nshape = \"mesh\"\nfile = \"lost.ply\"\n");
    expect_refusal({"render", "lost.toml", "-o", "a.png"}, bad_input, {"lost.ply", "cannot be opened"});
    write("open.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    write("cut.toml", "[[object]]\nshape = \"difference\"\npart = [{ shape = \"box\" }, { shape = \"mesh\", file = "
                      "\"open.off\" }]\n");
    expect_refusal({"render", "cut.toml", "-o", "a.png"}, bad_input, {"part 2 (mesh)", "is open", "solid"});
    write("cube.toml", "[[object]]\nshape = \"box\"\n");
    expect_refusal({"render", "cube.toml", "-o", "a.png", "--voxel", "1%"}, usage, {"--voxel", "cube.toml"});
    expect_refusal({"render", "cube.toml", "-o", "a.png", "--size", "4x"}, usage, {"--size", "1280x720"});
    // The memory of the image method counts; the check comes before any file is read.
    std::vector<std::string> large{"render",     "none.off",     "-o",  "a.png",    "--size",
                                   "14000x8000", "--max-memory", "4GB", "--method", "classic"};
    expect_refusal(large, bad_input, {"none.off"});
    large.back() = "screen_space";
    expect_refusal(large, usage, {"14000x8000", "6.27 GB", "4 GB", "smaller --size", "--max-memory"});
    expect_refusal({"render", "cube.toml", "-o", "a.png", "--pixel-samples", "0"}, usage, {"--pixel-samples"});
    const std::vector<std::string> left = files();
    EXPECT_EQ(std::count(left.begin(), left.end(), "a.png"), 0);
}

/// An upright plate on the ground, rotated, as high as it is wide.
std::string plate_off(double thickness) {
    std::string text = "OFF\n8 6 0\n";
    for (int i = 0; i < 8; ++i) {
        const double x = i % 2, y = i / 2 % 2, z = (i / 4) * thickness, cosine = 0.8, sine = 0.6;
        text += fmt::format("{} {} {}\n", cosine * x - sine * z, y, sine * x + cosine * z);
    }
    return text + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
}

TEST_F(RenderVerb, WarnsOfWallsWithHolesAndNamesTheVoxelThatMendsThem) {
    const double voxel = std::sqrt(2.0) / 256.0;
    const auto draw_plate = [&](double thickness, const std::vector<std::string>& more = {}) {
        write("plate.off", plate_off(thickness));
        std::vector<std::string> arguments{"plate.off", "-o", "a.png", "--method", "none", "--no-ground"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return draw(arguments);
    };
    const Outcome whole = draw_plate(3.0 * voxel), holed = draw_plate(0.4 * voxel);
    EXPECT_EQ(whole.err, "");
    EXPECT_LT(holed.json().at("covered_pixels"), 0.9 * whole.json().at("covered_pixels").get<double>());
    const std::string use = "and have holes: use a voxel of ";
    const std::size_t at = holed.err.find(use);
    ASSERT_NE(at, std::string::npos) << holed.err;
    const std::string suggested = holed.err.substr(at + use.size(), holed.err.find('%', at) + 1 - at - use.size());
    const Outcome fixed = draw_plate(0.4 * voxel, {"--voxel", suggested});
    EXPECT_EQ(fixed.err, "");
    EXPECT_GT(fixed.json().at("covered_pixels"), 0.95 * whole.json().at("covered_pixels").get<double>());
    EXPECT_EQ(draw({real_mesh("reference_tetrahedron.off"), "-o", "a.png", "--method", "none"}).err, "")
        << "edges are not walls";
}

}
}
