#include "scratch_files.h"

#include <cmath>

using namespace alcove;
using Obj = ScratchFiles;

namespace {

const std::string scene = "# made by hand\r\n"
                          "mtllib scene.mtl\r\n"
                          "o square\r\n"
                          "v  0.0 0 -0.50000000000000001\t\r\n"
                          "v 1 0 0 0.1 0.2 0.3\r\n"
                          "vt 0 0\r\n"
                          "v 1 1 0 # corner\r\n"
                          "v 0 \\\r\n 1 +0.0\r\n"
                          "\r\n"
                          "usemtl red # paint\r\n"
                          "f 1 2 \\\r\n 3 4\r\n"
                          "l 1 3\r\n"
                          "f -4 -3 -2\r\n"
                          "v 5 5 5";

std::string without_vertex_lines(const std::string& text) {
    std::string rest;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = text.find('\n', at);
        const bool is_vertex = text.compare(at, 2, "v ") == 0;
        while (is_vertex && end != std::string::npos && end >= 2 && text.compare(end - 2, 2, "\\\r") == 0)
            end = text.find('\n', end + 1);
        end = end == std::string::npos ? text.size() : end + 1;
        if (!is_vertex)
            rest += text.substr(at, end - at);
        at = end;
    }
    return rest;
}

}

TEST_F(Obj, ReadsPolygonsNegativeIndicesAndContinuedLines) {
    const Mesh mesh = read("scene.obj", scene);
    ASSERT_EQ(mesh.vertex_count(), 5u);
    EXPECT_EQ(mesh.positions[3], Vec3d(0, 1, 0));
    EXPECT_EQ(mesh.face_begin, (std::vector<std::uint32_t>{0, 4, 7}));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2}));
    EXPECT_TRUE(mesh.vertex_uvs.empty()); // no corner refers to a 'vt'
    EXPECT_EQ(mesh.vertex_colors[1], (Color{26, 51, 77, 255}));
    EXPECT_EQ(mesh.vertex_colors[0], (Color{255, 255, 255, 255}));
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("4 vertices have no colour"), std::string::npos);
}

TEST_F(Obj, WithoutColoursTheTextIsWrittenAsItWas) {
    Mesh mesh = read("scene.obj", scene);
    mesh.set_attribute({"ao", 1, std::vector<float>(5)});
    const auto lost = write_mesh(mesh, path("out.obj"));
    EXPECT_EQ(bytes_of("out.obj"), scene);
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_NE(lost[0].find("'ao'"), std::string::npos);
}

TEST_F(Obj, ColoursChangeTheVertexLinesOnly) {
    Mesh mesh = read("scene.obj", scene);
    const std::vector<Color> colors{
        {0, 0, 0, 255}, {255, 128, 1, 255}, {9, 9, 9, 255}, {2, 3, 4, 255}, {255, 254, 253, 255}};
    mesh.added_colors = colors;
    mesh.added_comments = {"not in here"};
    EXPECT_TRUE(write_mesh(mesh, path("out.obj")).empty());
    const std::string text = bytes_of("out.obj");
    EXPECT_EQ(without_vertex_lines(text), without_vertex_lines(scene));
    EXPECT_NE(text.find("v  0.0 0 -0.50000000000000001 0.0000 0.0000 0.0000\t\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find("v 1 0 0 1.0000 0.5020 0.0039\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find("v 0 \\\r\n 1 +0.0 0.0078 0.0118 0.0157\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find(" # corner\r\n"), std::string::npos) << text;
    const Mesh again = read_mesh(path("out.obj"));
    EXPECT_EQ(again.vertex_colors, colors);
    EXPECT_EQ(again.positions, mesh.positions);
    EXPECT_EQ(again.corners, mesh.corners);
}

TEST_F(Obj, EveryColourByteSurvives) {
    Mesh mesh;
    std::vector<Color> colors;
    for (int i = 0; i < 256; ++i) {
        mesh.positions.push_back({double(i), 0, 0});
        const auto c = std::uint8_t(i);
        colors.push_back({c, std::uint8_t(255 - i), c, 255});
    }
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2});
    mesh.added_colors = colors;
    write_mesh(mesh, path("out.obj"));
    EXPECT_EQ(read_mesh(path("out.obj")).vertex_colors, colors);
}

TEST_F(Obj, WeightsGiveWayToColoursAndAreTold) {
    Mesh mesh = read("in.obj", "v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0 2\nf 1 2 3\n");
    EXPECT_TRUE(mesh.vertex_colors.empty());
    EXPECT_TRUE(write_mesh(mesh, path("same.obj")).empty());
    EXPECT_EQ(bytes_of("same.obj"), bytes_of("in.obj"));
    mesh.added_colors.assign(3, Color{0, 0, 0, 255});
    const auto lost = write_mesh(mesh, path("out.obj"));
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_NE(lost[0].find("the weights of 2 vertices"), std::string::npos) << lost[0];
    EXPECT_EQ(bytes_of("out.obj").find("0.5"), std::string::npos);
}

TEST_F(Obj, FacesMayComeBeforeTheirVertices) {
    EXPECT_EQ(read("in.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").corners, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_F(Obj, ToPlyKeepsTheMeshAndTellsTheRest) {
    const Mesh mesh = read("scene.obj", scene);
    std::string lost;
    for (const std::string& line : write_mesh(mesh, path("out.ply")))
        lost += line + "\n";
    EXPECT_EQ(lost, "not stored in PLY: 1 'usemtl' line\nnot stored in PLY: 1 'mtllib' line\n"
                    "not stored in PLY: 1 'o' line\nnot stored in PLY: 1 'l' line\n"
                    "not stored in PLY: 1 comment line\n");
    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_EQ(again.positions, mesh.positions);
    EXPECT_EQ(again.corners, mesh.corners);
    EXPECT_EQ(again.face_begin, mesh.face_begin);
    EXPECT_EQ(again.vertex_colors, mesh.vertex_colors);
}

TEST_F(Obj, APlyBecomesAnObjWithEverythingItCanHold) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0.1f}, {1, 0, 0.1}, {1e-17, 1.0 / 3.0, 0}, {1e20, 0, 0}};
    mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0.6f, 0.8f, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    mesh.add_face(std::vector<std::uint32_t>{2, 1, 0});
    mesh.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {.5f, .25f}, {0, 0}, {1, 1}};
    mesh.added_comments = {"one\ntwo"};
    write_mesh(mesh, path("out.obj"));
    EXPECT_TRUE(bytes_of("out.obj").starts_with("# one two\nv 0 0 0.1\n"));
    const Mesh again = read_mesh(path("out.obj"));
    EXPECT_EQ(again.corner_uvs, mesh.corner_uvs);
    EXPECT_EQ(again.normals, mesh.normals);
    EXPECT_EQ(again.face_begin, mesh.face_begin);
    EXPECT_EQ(again.corners, mesh.corners);
    EXPECT_EQ(again.positions[2], mesh.positions[2]);
    EXPECT_EQ(again.positions[1].z, 0.1);
    EXPECT_EQ(static_cast<float>(again.positions[0].z), 0.1f);
    mesh.corner_uvs.clear();
    mesh.vertex_uvs = {{0, 0}, {1, 0}, {.5f, 1}, {2, 2}};
    write_mesh(mesh, path("out.obj"));
    EXPECT_EQ(read_mesh(path("out.obj")).vertex_uvs, mesh.vertex_uvs);
}

TEST_F(Obj, WhatAPlyHoldsBeyondAnObjIsTold) {
    Mesh mesh =
        read("in.ply", "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty float y\n"
                       "property float z\nproperty float quality\nelement face 1\n"
                       "property list uchar int vertex_indices\nproperty int patch\nelement light 1\n"
                       "property int on\nend_header\n0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2 5\n1\n");
    mesh.set_attribute({"ao", 1, {1, 1, 1}});
    std::string lost;
    for (const std::string& line : write_mesh(mesh, path("out.obj")))
        lost += line + "\n";
    for (const char* name : {"'ao'", "'quality'", "'patch'", "'light'", "1 comment line"})
        EXPECT_NE(lost.find(name), std::string::npos) << name << " in\n" << lost;
}

TEST_F(Obj, LinesOfUnknownKeywordsAreKeptAndCounted) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nzz top\nzz 3\nf 1 2 3\n";
    const Mesh mesh = read("in.obj", text);
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("2 lines do not begin with an OBJ keyword (first: line 4 with 'zz'); kept"),
              std::string::npos);
    write_mesh(mesh, path("out.obj"));
    EXPECT_EQ(bytes_of("out.obj"), text);
}

TEST_F(Obj, AllKeywordsOfTheFormatAreKnown) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* keyword :
         {"vp",   "deg",   "bmat",   "step",   "cstype",     "p",         "l",     "curv",  "curv2",    "surf",
          "parm", "trim",  "hole",   "scrv",   "sp",         "end",       "con",   "g",     "s",        "mg",
          "o",    "bevel", "lod",    "usemtl", "shadow_obj", "trace_obj", "ctech", "stech", "c_interp", "d_interp",
          "call", "csh",   "mtllib", "maplib", "usemap",     "bsp",       "bzp",   "cdc",   "cdp",      "res"})
        text += std::string(keyword) + " 1\n";
    const Mesh mesh = read("in.obj", text);
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_EQ(mesh.vertex_count(), 3u);
}
