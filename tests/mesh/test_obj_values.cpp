// Texture coordinates, normals and colours of OBJ files, sound and damaged.
#include "scratch_files.h"

#include <cmath>

using namespace alcove;
using ObjValues = ScratchFiles;

namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string uvs = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

void expect_square(const Mesh& mesh) {
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

void expect_warning(const Mesh& mesh, const std::string& words) {
    ASSERT_EQ(mesh.warnings.size(), 1u) << words;
    EXPECT_NE(mesh.warnings[0].find(words), std::string::npos) << mesh.warnings[0];
}

}

TEST_F(ObjValues, TextureCoordinatesAreKeptPerVertexWhereTheyAgreeElsePerCorner) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 0 1\n";
    const Mesh agreeing = read("a.obj", vertices + "f 1/1 2/2 3/3\nf 2/-4 4/4 3/5\n");
    EXPECT_EQ(agreeing.vertex_uvs, (std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
    EXPECT_TRUE(agreeing.corner_uvs.empty());
    const Mesh split = read("b.obj", vertices + "f 1/1 2/2 3/3\nf 2/1 4/4 3/3\n");
    EXPECT_TRUE(split.vertex_uvs.empty());
    EXPECT_EQ(split.corner_uvs, (std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 1}, {0, 1}}));
    const Mesh partly = read("c.obj", vertices + "f 1 2 3\nf 2/2 4/4 3/3\n");
    EXPECT_EQ(partly.corner_uvs, (std::vector<Vec2>{{0, 0}, {0, 0}, {0, 0}, {1, 0}, {1, 1}, {0, 1}}));
    ASSERT_EQ(partly.warnings.size(), 1u);
    EXPECT_NE(partly.warnings[0].find("3 face corners have no texture"), std::string::npos);
}

TEST_F(ObjValues, NormalsOfOneVertexAreSummedOnceEach) {
    // Vertex 1 has the normal z three times and x once; the sum of the distinct ones is halfway between them.
    const Mesh mesh = read("in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 4\nvn 2 0 0\nvn 0 0 1\n"
                                     "f 1//1 2//1 3//1\nf 1//3 2//1 3//1\nf 1//1 3//1 2//1\nf 1//2 3//-3 4//2\n");
    const float half = std::sqrt(0.5f);
    EXPECT_NEAR(glm::length(mesh.normals[0] - Vec3(half, 0, half)), 0.0f, 1e-6f);
    EXPECT_EQ(mesh.normals[1], Vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[3], Vec3(1, 0, 0));
    EXPECT_TRUE(mesh.warnings.empty());
    ASSERT_EQ(mesh.corner_normals.size(), 12u);
    EXPECT_EQ(mesh.corner_normals[3], Vec3(0, 0, 1));
    EXPECT_EQ(mesh.corner_normals[9], Vec3(1, 0, 0));
}

TEST_F(ObjValues, NothingAfterASlashIsNoReference) {
    for (const char* face : {"f 1/ 2/ 3/ 4/\n", "f 1// 2// 3// 4//\n", "f 1 2/ 3// 4\n"}) {
        const Mesh mesh = read("in.obj", square + face);
        expect_square(mesh);
        EXPECT_TRUE(mesh.warnings.empty());
        EXPECT_TRUE(mesh.vertex_uvs.empty() && mesh.corner_uvs.empty() && mesh.normals.empty());
        write_mesh(mesh, path("out.obj"));
        EXPECT_EQ(bytes_of("out.obj"), square + face);
    }
    const Mesh mesh = read("in.obj", square + uvs + "f 1/1/ 2/2/ 3/3/ 4/4/\n");
    expect_square(mesh);
    EXPECT_EQ(mesh.vertex_uvs, (std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

TEST_F(ObjValues, DamagedTextureCoordinatesAreCountedWithTheirLine) {
    const std::string face = "f 1/1 2/2 3/3 4/4\n";
    for (const auto& [line, uv] :
         {std::pair("vt -1.#IND00 -1.#IND00 -1.#IND00", Vec2(0, 0)), std::pair("vt nan nan", Vec2(0, 0)),
          std::pair("vt 0,25 0,5", Vec2(0, 0)), std::pair("vt 1 inf", Vec2(1, 0)), std::pair("vt", Vec2(0, 0)),
          std::pair("vt 1 0 0 1", Vec2(1, 0)), std::pair("vt 1 0 ?", Vec2(1, 0))}) {
        SCOPED_TRACE(line);
        const std::string text = square + "vt 0 0\n" + line + "\nvt 1 1\nvt 0 1\n" + face;
        const Mesh mesh = read("in.obj", text);
        expect_square(mesh);
        EXPECT_EQ(mesh.vertex_uvs, (std::vector<Vec2>{{0, 0}, uv, {1, 1}, {0, 1}}));
        expect_warning(mesh, "1 'vt' line does not hold 1 to 3 finite numbers (first: line 6); ");
        write_mesh(mesh, path("out.obj"));
        EXPECT_EQ(bytes_of("out.obj"), text);
    }
}

TEST_F(ObjValues, DamagedNormalsAreCountedWithTheirLine) {
    for (const auto& [line, normal] :
         {std::pair("vn 1.#QNAN 1.#QNAN 1.#QNAN", Vec3(0, 0, 0)), std::pair("vn 0 0 nan", Vec3(0, 0, 0)),
          std::pair("vn 0 1", Vec3(0, 0, 0)), std::pair("vn", Vec3(0, 0, 0)), std::pair("vn 0,0 0 1", Vec3(0, 0, 0)),
          std::pair("vn 0 0 2 1", Vec3(0, 0, 1))}) {
        SCOPED_TRACE(line);
        const Mesh mesh = read("in.obj", square + "vn 0 0 1\n" + line + "\nf 1//1 2//2 3//1 4//1\n");
        expect_square(mesh);
        EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, 1}, normal, {0, 0, 1}, {0, 0, 1}}));
        expect_warning(mesh, "1 'vn' line does not hold 3 finite numbers (first: line 6); ");
    }
}

TEST_F(ObjValues, ADamagedNormalIsNoneOfTheNormalsOfAVertex) {
    const Mesh mesh = read("in.obj", square + "vn nan 0 0\nvn 0 0 1\nf 1//1 2//2 3//2\nf 1//2 3//2 4//2\n");
    EXPECT_EQ(mesh.normals[0], Vec3(0, 0, 1));
    EXPECT_EQ(mesh.warnings.size(), 1u);
    EXPECT_TRUE(read("in.obj", square + "vn nan 0 0\nf 1//1 2//1 3//1\n").normals.empty());
}

TEST_F(ObjValues, ReferencesToMissingItemsAreIgnoredAndCounted) {
    const Mesh normals = read("in.obj", square + "f 1//1 2//2 3//3 4//4\n");
    expect_square(normals);
    EXPECT_TRUE(normals.normals.empty());
    expect_warning(normals, "4 face corners name normals that the file does not have, for example in line 5");

    const Mesh kinds = read("in.obj", square + "vn 0 0 1\nf 1/1 2/1 3/1 4/1\n");
    expect_square(kinds);
    EXPECT_TRUE(kinds.vertex_uvs.empty() && kinds.corner_uvs.empty() && kinds.normals.empty());
    expect_warning(kinds, "4 face corners name texture coordinates that the file does not have");

    for (const char* index : {"5", "-5", "0", "99999999999999"}) {
        SCOPED_TRACE(index);
        const Mesh one = read("in.obj", square + uvs + "f 1/1 2/" + index + " 3/3 4/4\n");
        expect_square(one);
        EXPECT_EQ(one.vertex_uvs, (std::vector<Vec2>{{0, 0}, {0, 0}, {1, 1}, {0, 1}}));
        ASSERT_EQ(one.warnings.size(), 2u);
        EXPECT_NE(one.warnings[0].find("1 face corner names texture coordinates"), std::string::npos);
        EXPECT_NE(one.warnings[0].find("line 9"), std::string::npos);
        EXPECT_NE(one.warnings[1].find("1 face corner has no texture coordinate"), std::string::npos);
    }
}

TEST_F(ObjValues, MrgbCommentsAreColours) {
    const std::string face = "f 1 2 3 4\n", red_green = "#MRGB ffff000080ff0000\r\n#MRGB ff00FF00 \n#MRGB \tff00ff7f\n";
    const Mesh mesh = read("in.obj", square + red_green + face);
    const std::vector<Color> colors{{255, 0, 0, 255}, {255, 0, 0, 255}, {0, 255, 0, 255}, {0, 255, 127, 255}};
    EXPECT_EQ(mesh.vertex_colors, colors);
    EXPECT_TRUE(mesh.warnings.empty());
    write_mesh(mesh, path("out.ply"));
    EXPECT_EQ(read_mesh(path("out.ply")).vertex_colors, colors);

    EXPECT_EQ(read("in.obj", "#MRGB ffff000080ff0000ff00ff00ff00ff7f\n" + square + face).vertex_colors, colors);
}

TEST_F(ObjValues, MrgbCommentsThatDoNotFitAreTold) {
    const std::string face = "f 1 2 3 4\n", four = "#MRGB ff000000ff000000ff000000ff000000\n";
    const auto expect_unused = [&](const std::string& text, const std::string& words) {
        const Mesh mesh = read("in.obj", text + face);
        EXPECT_TRUE(mesh.vertex_colors.empty());
        expect_warning(mesh, words);
    };
    expect_unused(square + "#MRGB ff000000ff000000ff000000\n", "not used: there are 3 for 4 vertices");
    expect_unused(square + four + "#MRGB ff000000\n", "not used: there are 5 for 4 vertices");
    expect_unused(square + "#MRGB ff000000ff00000gff000000ff000000\n", "not used: 1 of 1 lines cannot be read");
    expect_unused(square + "#MRGB ff000000ff000000ff000000ff0000\n", "not used: 1 of 1 lines cannot be read");
    EXPECT_TRUE(read("in.obj", square + "usemtl x #MRGB ff000000ff000000ff000000ff000000\n" + face).warnings.empty());

    const Mesh both = read("in.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0 1 0 0\n" + four + face);
    EXPECT_EQ(both.vertex_colors[0], (Color{255, 0, 0, 255}));
    expect_warning(both, "not used: the vertex lines have colours too");
}

TEST_F(ObjValues, NewColoursBesideMrgbCommentsAreTold) {
    Mesh mesh = read("in.obj", square + "#MRGB ff000000ff000000ff000000ff000000\nf 1 2 3 4\n");
    EXPECT_TRUE(write_mesh(mesh, path("out.obj")).empty());
    mesh.added_colors.assign(4, Color{9, 9, 9, 255});
    const auto told = write_mesh(mesh, path("out.obj"));
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("1 '#MRGB' line still holds the colours of the input"), std::string::npos) << told[0];
}
