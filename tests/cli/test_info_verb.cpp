#include "program.h"

#include <cmath>
#include <set>

namespace alcove::test {
namespace {

using InfoVerb = ProgramTest;

TEST_F(InfoVerb, CountsWhatAMeshHolds) {
    write("cube.off", cube_off);
    const Outcome outcome = run({"info", "cube.off", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const nlohmann::json cube = outcome.json();
    EXPECT_EQ(cube.at("kind"), "mesh");
    EXPECT_EQ(cube.at("format"), "OFF");
    EXPECT_EQ(cube.at("vertices"), 8);
    EXPECT_EQ(cube.at("faces"), 6);
    EXPECT_EQ(cube.at("triangles"), 0);
    EXPECT_EQ(cube.at("quads"), 6);
    EXPECT_EQ(cube.at("box").at("min"), nlohmann::json({0.0, 0.0, 0.0}));
    EXPECT_EQ(cube.at("box").at("max"), nlohmann::json({1.0, 1.0, 1.0}));
    EXPECT_DOUBLE_EQ(cube.at("diagonal"), std::sqrt(3.0));
    EXPECT_EQ(cube.at("normals"), false);
    EXPECT_EQ(cube.at("diagnosis").at("edges"), 12);
    EXPECT_EQ(cube.at("diagnosis").at("closed"), true);
    EXPECT_DOUBLE_EQ(cube.at("diagnosis").at("signed_volume"), 1.0);
    EXPECT_EQ(cube.at("sign"), "solid");
    EXPECT_TRUE(cube.at("warnings").empty());
}

TEST_F(InfoVerb, NamesEveryPropertyAndWhatIsWrong) {
    write("scan.ply", "ply\nformat ascii 1.0\ncomment from a laser\nelement vertex 5\nproperty float x\n"
                      "property float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                      "property double confidence\nelement face 2\nproperty list uchar int vertex_indices\n"
                      "property uchar flags\nend_header\n"
                      "0 0 0 0 0 1 1\n1 0 0 0 0 1 1\n1 1 0 0 0 1 1\n0 1 0 0 0 1 1\nnan 0 0 0 0 1 1\n"
                      "3 0 1 2 7\n3 0 2 3 7\n");
    const nlohmann::json scan = run({"info", "scan.ply", "--json"}).json();
    EXPECT_EQ(scan.at("format"), "PLY");
    EXPECT_EQ(scan.at("normals"), true);
    EXPECT_EQ(scan.at("comments"), nlohmann::json({"comment from a laser"}));
    const nlohmann::json& vertex = scan.at("elements").at(0);
    EXPECT_EQ(vertex.at("name"), "vertex");
    EXPECT_EQ(vertex.at("properties").size(), 7u);
    EXPECT_EQ(vertex.at("properties").at(6),
              nlohmann::json({{"name", "confidence"}, {"type", "double"}, {"list", false}}));
    EXPECT_EQ(scan.at("elements").at(1).at("properties").at(0).at("list"), true);
    EXPECT_EQ(scan.at("diagnosis").at("open_edges"), 4);
    EXPECT_EQ(scan.at("diagnosis").at("non_finite_vertices"), 1);
    EXPECT_EQ(scan.at("diagnosis").at("unreferenced_vertices"), 1);
    EXPECT_EQ(scan.at("sign"), "sheet");
    EXPECT_EQ(scan.at("warnings").size(), 1u);

    const Outcome text = run({"info", "scan.ply"});
    EXPECT_EQ(text.code, done);
    for (const char* part :
         {"scan.ply: mesh\n", "PLY", "2 triangles", "confidence", "4 open edges", "sheet", "not finite"})
        EXPECT_NE(text.out.find(part), std::string::npos) << part << " is not in " << text.out;
}

TEST_F(InfoVerb, MeasuresAGridInTheUnitsOfTheScene) {
    write("cube.off", cube_off);
    const Outcome made =
        run({"voxelize", "cube.off", "-o", "cube.vdb", "--voxel", "0.05", "--radius", "0.5", "--json"});
    ASSERT_EQ(made.code, done) << made.err;
    const nlohmann::json written = made.json();
    const Outcome outcome = run({"info", "cube.vdb", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    const nlohmann::json grid = outcome.json();
    EXPECT_EQ(grid.at("kind"), "grid");
    EXPECT_EQ(grid.at("written_by_alcove"), true);
    EXPECT_EQ(grid.at("sign"), "solid");
    ASSERT_EQ(grid.at("levels").size(), written.at("levels").size());
    double voxel = 0.05;
    for (std::size_t i = 0; i < grid.at("levels").size(); ++i, voxel *= 2) {
        const nlohmann::json& level = grid.at("levels").at(i);
        EXPECT_NEAR(level.at("voxel"), voxel, 1e-6);
        EXPECT_EQ(level.at("active_voxels"), written.at("levels").at(i).at("active_voxels"));
        EXPECT_NEAR(level.at("band").get<double>(), voxel * level.at("band_voxels").get<double>(), 1e-6);
    }
    // The box is accurate to the cells of the search: 1/64 of the diagonal.
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(grid.at("box").at("min").at(axis), 0.0, std::sqrt(3.0) / 64);
        EXPECT_NEAR(grid.at("box").at("max").at(axis), 1.0, std::sqrt(3.0) / 64);
    }
    const Outcome text = run({"info", "cube.vdb"});
    for (const char* part : {"Alcove", "voxel 0.05,", "negative inside"})
        EXPECT_NE(text.out.find(part), std::string::npos) << part << " is not in " << text.out;
}

TEST_F(InfoVerb, ListsTheChannelsOfAnImage) {
    write("cube.off", cube_off);
    for (const char* name : {"cube.exr", "cube.png"}) {
        ASSERT_EQ(run({"render", "cube.off", "-o", name, "--size", "40x30"}).code, done);
        const Outcome outcome = run({"info", name, "--json"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        const nlohmann::json image = outcome.json();
        EXPECT_EQ(image.at("kind"), "image");
        EXPECT_EQ(image.at("width"), 40);
        EXPECT_EQ(image.at("height"), 30);
    }
    const nlohmann::json exr = run({"info", "cube.exr", "--json"}).json();
    EXPECT_EQ(exr.at("format"), "EXR");
    std::set<std::string> channels;
    for (const nlohmann::json& channel : exr.at("channels"))
        channels.insert(channel.at("name").get<std::string>() + " " + channel.at("type").get<std::string>());
    for (const char* channel : {"R half", "A half", "Z float", "N.X float", "AO.R half"})
        EXPECT_TRUE(channels.contains(channel)) << channel;
    EXPECT_EQ(exr.at("texts").at("software"), "alcove " ALCOVE_VERSION);
    EXPECT_EQ(run({"info", "cube.png", "--json"}).json().at("channels").size(), 3u);
    EXPECT_NE(run({"info", "cube.exr"}).out.find("40 x 30 pixels"), std::string::npos);
}

TEST_F(InfoVerb, FailsWhenItsWordsCannotBeWritten) {
    // The error message cannot be written either.
    write("cube.off", cube_off);
    max_file_size_ = 1;
    const Outcome outcome = run({"info", "cube.off"});
    EXPECT_EQ(outcome.code, failure);
}

}
}
