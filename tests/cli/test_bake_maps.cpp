/// Texture maps as output of the program.
#include "program.h"
#include "shapes.h"

#include "alcove/mesh/files.h"
#include "alcove/render/image.h"

#include <fmt/format.h>

#include <array>

namespace alcove::test {
namespace {

class BakeMaps : public ProgramTest {
  protected:
    /// A box with hard edges, each of whose six sides has a cell of the texture.
    void write_box(const std::string& file, const Vec2& shift = Vec2(0.0f)) const {
        Mesh box = box_mesh(Vec3d(1.0), 1);
        for (std::size_t f = 0; f < box.face_count(); ++f)
            for (const Vec2& uv : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)})
                box.corner_uvs.push_back((Vec2(f % 3, f / 3) + 0.05f + 0.9f * uv) / 3.0f + shift);
        write_mesh(box, folder_ / ("work/" + file));
    }
};

TEST_F(BakeMaps, PngOfABox) {
    write_box("box.obj");
    const Outcome outcome = run({"bake", "box.obj", "-o", "a.png", "--size", "64x32", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const auto json = outcome.json();
    EXPECT_EQ(json.at("size"), (std::vector<int>{64, 32}));
    EXPECT_GT(json.at("texels").get<int>(), 64 * 32 / 3);
    EXPECT_EQ(json.at("overlaps"), 0);
    EXPECT_LE(json.at("estimated_rmse").get<double>(), 0.02);
    const ImageSummary image = summarize_image(folder_ / "work/a.png");
    EXPECT_EQ(image.width, 64);
    EXPECT_EQ(image.height, 32);
    EXPECT_EQ(image.channels.size(), 1u);
}

TEST_F(BakeMaps, HardEdgesOfAnObjAreOpenInAMapAndWarnedAboutAtVertices) {
    std::string obj;
    for (int i = 0; i < 8; ++i)
        obj += fmt::format("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2);
    obj += "vt 0 0\nvt 0.3 0\nvt 0.3 0.3\nvt 0 0.3\n";
    const std::array<std::array<int, 4>, 6> sides{
        {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}}};
    for (int side = 0; side < 6; ++side)
        for (const int sign : {-1, 1})
            if ((side % 2 == 1) == (sign == 1))
                obj += fmt::format("vn {} {} {}\n", side / 2 == 0 ? sign : 0, side / 2 == 1 ? sign : 0,
                                   side / 2 == 2 ? sign : 0);
    for (std::size_t side = 0; side < 6; ++side) {
        obj += "f";
        for (std::size_t k = 0; k < 4; ++k)
            obj += fmt::format(" {}/{}/{}", sides[side][k], k + 1, side + 1);
        obj += "\n";
    }
    write("box.obj", obj);
    const Outcome map = run({"bake", "box.obj", "-o", "a.png", "--size", "64", "--method", "exact"});
    ASSERT_EQ(map.code, done) << map.err;
    EXPECT_EQ(map.err.find("hard edges"), std::string::npos);
    const Outcome vertices = run({"bake", "box.obj", "-o", "a.ply"});
    EXPECT_NE(vertices.err.find("8 vertices have several normals (hard edges) but store one value"), std::string::npos)
        << vertices.err;
    EXPECT_NE(vertices.err.find("split the vertices there"), std::string::npos);
}

TEST_F(BakeMaps, AttributesAndTilesHaveFilesOfTheirOwn) {
    write_box("box.obj", Vec2(1, 0));
    ASSERT_EQ(
        run({"bake", "box.obj", "-o", "m.<UDIM>.png", "--size", "32", "--attributes", "ao,thickness", "--depth", "16"})
            .code,
        done);
    EXPECT_EQ(summarize_image(folder_ / "work/m.1002.png").channels[0].type, "16 bits");
    EXPECT_EQ(summarize_image(folder_ / "work/m_thickness.1002.png").width, 32);
    ASSERT_EQ(run({"bake", "box.obj", "-o", "m.<UDIM>.exr", "--size", "32", "--attributes", "ao,bent_normal"}).code,
              done);
    EXPECT_GE(summarize_image(folder_ / "work/m.1002.exr").channels.size(), 10u);
    const Outcome outside = run({"bake", "box.obj", "-o", "a.png", "--size", "32"});
    EXPECT_EQ(outside.code, bad_input);
    EXPECT_NE(outside.err.find("no face covers a texel"), std::string::npos) << outside.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "work/a.png"));
}

TEST_F(BakeMaps, PackedAttributesAreBakedTogether) {
    write_box("box.obj");
    ASSERT_EQ(run({"bake", "box.obj", "-o", "p.png", "--size", "32", "--pack", "ao,thickness,convexity"}).code, done);
    EXPECT_EQ(summarize_image(folder_ / "work/p.png").channels.size(), 3u);
    EXPECT_EQ(run({"bake", "box.obj", "-o", "p.png", "--pack", "ao,shine"}).code, usage);
    EXPECT_EQ(run({"bake", "box.obj", "-o", "p.png", "--pack", "ao,bent_normal"}).code, usage);
}

TEST_F(BakeMaps, AHighMeshIsBakedIntoTheUvsOfALowOne) {
    write_box("low.obj");
    write_mesh(box_mesh(Vec3d(1.01), 20), folder_ / "work/high.ply");
    const Outcome outcome = run({"bake", "low.obj", "--high", "high.ply", "-o", "a.png", "--size", "64", "--attributes",
                                 "ao,normal,height,object", "--miss-mask", "miss.png", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_GT(outcome.json().at("reach").get<double>(), 0.01);
    EXPECT_EQ(outcome.json().at("misses"), 0);
    for (const char* name : {"a.png", "a_normal.png", "a_height.png", "a_object.png", "miss.png"})
        EXPECT_EQ(summarize_image(folder_ / (std::string("work/") + name)).width, 64) << name;
    EXPECT_EQ(run({"bake", "low.obj", "-o", "a.png", "--attributes", "normal"}).code, usage);
    for (const char* mask : {"b.png", "b_normal.png", "m.exr", "m.<UDIM>.png"})
        EXPECT_EQ(run({"bake", "low.obj", "--high", "high.ply", "-o", "b.png", "--miss-mask", mask}).code, usage)
            << mask;
    EXPECT_EQ(run({"bake", "low.obj", "-o", "b.png", "--miss-mask", "m.png"}).code, usage);
    EXPECT_EQ(run({"bake", "low.obj", "--high", "high.ply", "-o", "b.png", "--miss-mask", "no/m.png"}).code, failure);
    EXPECT_EQ(run({"bake", "low.obj", "--high", "high.ply", "-o", "b.png", "--reach", "inf"}).code, usage);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "work/b.png"));
    EXPECT_EQ(run({"bake", "low.obj", "-o", "a.png", "--reach", "0.1"}).code, usage);
    EXPECT_EQ(run({"bake", "low.obj", "-o", "a.ply", "--high", "high.ply"}).code, usage);
    const Outcome only_normals =
        run({"bake", "low.obj", "--high", "high.ply", "-o", "n.png", "--size", "64", "--attributes", "normal"});
    EXPECT_EQ(only_normals.code, done) << only_normals.err;
}

TEST_F(BakeMaps, RenderShowsAMapOnTheMesh) {
    write_box("box.obj");
    ASSERT_EQ(run({"bake", "box.obj", "-o", "ao.png", "--size", "32"}).code, done);
    const std::vector<std::string> render{"render", "box.obj", "--size", "32x24", "--method", "none", "--texture"};
    const auto with = [&](const std::string& texture, const std::string& output) {
        std::vector<std::string> arguments = render;
        arguments.insert(arguments.end(), {texture, "-o", output});
        return run(arguments);
    };
    EXPECT_EQ(with("ao.png", "r.png").code, done);
    const Outcome missing = with("none.png", "s.png");
    EXPECT_EQ(missing.code, bad_input);
    EXPECT_NE(missing.err.find("none.png"), std::string::npos) << missing.err;
    write_mesh(sphere_mesh(2), folder_ / "work/box.obj");
    const Outcome without = with("ao.png", "s.png");
    EXPECT_EQ(without.code, bad_input);
    EXPECT_NE(without.err.find("has no texture coordinates (UVs) for the texture ao.png"), std::string::npos)
        << without.err;
}

TEST_F(BakeMaps, AMeshWithoutUvsIsToldTheOtherWays) {
    write_mesh(sphere_mesh(2), folder_ / "work/ball.ply");
    const Outcome outcome = run({"bake", "ball.ply", "-o", "a.png"});
    EXPECT_EQ(outcome.code, bad_input);
    EXPECT_NE(outcome.err.find("ball.ply: has no texture coordinates"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("--tessellate"), std::string::npos);
}

TEST_F(BakeMaps, OptionsOfTheOtherKindOfOutputAreRefused) {
    write_box("box.obj");
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"-o", "a.ply", "--size", "64"},
                                               {"-o", "a.ply", "--margin", "none"},
                                               {"-o", "a.ply", "--depth", "16"},
                                               {"-o", "a.ply", "--space", "object"},
                                               {"-o", "a.ply", "--pack", "ao"},
                                               {"-o", "a.png", "--tessellate", "auto"},
                                               {"-o", "a.png", "--self"},
                                               {"-o", "a.png", "--color", "ao"},
                                               {"-o", "a.png", "--size", "64x"},
                                               {"-o", "a.png", "--size", "0"},
                                               {"-o", "a.png", "--margin", "some"},
                                               {"-o", "a.png", "--depth", "float"}}) {
        std::vector<std::string> arguments{"bake", "box.obj"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, usage) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "work/a.png"));
    }
}

TEST_F(BakeMaps, MapsThatDoNotFitAreRefused) {
    write_box("box.obj");
    const Outcome outcome = run({"bake", "box.obj", "-o", "a.png", "--size", "16384", "--max-memory", "500MB"});
    EXPECT_EQ(outcome.code, bad_input);
    EXPECT_NE(outcome.err.find("maps of 16384 x 16384 texels need about"), std::string::npos) << outcome.err;
}

}
}
