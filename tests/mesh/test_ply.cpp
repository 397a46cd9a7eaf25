#include "scratch_files.h"

#include "alcove/mesh/formats/ply/ply_document.h"

#include <cmath>
#include <limits>

using namespace alcove;
using Ply = ScratchFiles;

namespace {

/// One row of an element per line; scalar and list properties of all kinds on each element.
const std::string rich_header_body = "comment made by hand\n"
                                     "obj_info scanned 1998\n"
                                     "element camera 1\n"
                                     "property double focal\n"
                                     "property list uchar short marks\n"
                                     "element vertex 4\n"
                                     "property float x\n"
                                     "property float y\n"
                                     "property float z\n"
                                     "property short confidence\n"
                                     "property list ushort double history\n"
                                     "comment in the middle\n"
                                     "property float s\n"
                                     "property float t\n"
                                     "element face 2\n"
                                     "property uchar group\n"
                                     "property list uchar int vertex_indices\n"
                                     "property list uchar float weights\n"
                                     "element edge 1\n"
                                     "property int vertex1\n"
                                     "property int vertex2\n"
                                     "end_header\n";

const std::string rich_text = "35.5 3 -1 2 300\n"
                              "0 0 0 -5 0 0.25 0.5\n"
                              "1 0 0 7 2 0.1 1e300 1 0.5\n"
                              "1 1 0 32767 1 -2.5 1 1\n"
                              "0 1 0.125 0 0 0 1\n"
                              "200 4 0 1 2 3 0\n"
                              "7 3 0 1 2 2 0.5 1.5\n"
                              "3 1\n";

template <class Pack>
std::string rich_rows(Pack pack) {
    using u8 = std::uint8_t;
    using u16 = std::uint16_t;
    using i16 = std::int16_t;
    return pack(35.5, u8(3), i16(-1), i16(2), i16(300)) + pack(0.0f, 0.0f, 0.0f, i16(-5), u16(0), 0.25f, 0.5f) +
           pack(1.0f, 0.0f, 0.0f, i16(7), u16(2), 0.1, 1e300, 1.0f, 0.5f) +
           pack(1.0f, 1.0f, 0.0f, i16(32767), u16(1), -2.5, 1.0f, 1.0f) +
           pack(0.0f, 1.0f, 0.125f, i16(0), u16(0), 0.0f, 1.0f) + pack(u8(200), u8(4), 0, 1, 2, 3, u8(0)) +
           pack(u8(7), u8(3), 0, 1, 2, u8(2), 0.5f, 1.5f) + pack(3, 1);
}

std::string rich_file(const std::string& format) {
    const std::string header = "ply\nformat " + format + " 1.0\n" + rich_header_body;
    if (format == "ascii")
        return header + rich_text;
    const bool little = format == "binary_little_endian";
    return header + (little ? rich_rows([](auto... v) { return packed(v...); })
                            : rich_rows([](auto... v) { return packed_reversed(v...); }));
}

const std::string square = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                           "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

class PlyFormats : public ScratchFiles, public testing::WithParamInterface<const char*> {};

}

TEST_P(PlyFormats, GiveTheSameMesh) {
    const Mesh mesh = read("rich.ply", rich_file(GetParam()));
    ASSERT_EQ(mesh.vertex_count(), 4u);
    EXPECT_EQ(mesh.positions[3], Vec3d(0.0, 1.0, 0.125));
    EXPECT_EQ(mesh.face_begin, (std::vector<std::uint32_t>{0, 4, 7}));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2}));
    ASSERT_EQ(mesh.vertex_uvs.size(), 4u);
    EXPECT_EQ(mesh.vertex_uvs[1], Vec2(1.0f, 0.5f));
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_TRUE(mesh.source->has_vertex_property("confidence"));
    EXPECT_FALSE(mesh.source->has_vertex_property("quality"));
}

TEST_P(PlyFormats, AreWrittenBackWithEveryValueInLittleEndian) {
    EXPECT_TRUE(write_mesh(read("rich.ply", rich_file(GetParam())), path("out.ply")).empty());
    EXPECT_EQ(rows_of("out.ply"), rich_rows([](auto... v) { return packed(v...); }));
    const std::string header = header_of("out.ply");
    EXPECT_TRUE(header.starts_with("ply\nformat binary_little_endian 1.0\n"
                                   "comment made by hand\nobj_info scanned 1998\ncomment in the middle\n"
                                   "element camera 1\nproperty double focal\nproperty list uchar short marks\n"
                                   "element vertex 4\n"))
        << header;
}

TEST_P(PlyFormats, TakeAddedColumnsBehindTheirOwn) {
    Mesh mesh = read("rich.ply", rich_file(GetParam()));
    mesh.set_attribute({"ao", 1, {0.0f, 0.25f, 0.5f, 1.0f}});
    mesh.added_colors = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}, {13, 14, 15, 16}};
    write_mesh(mesh, path("out.ply"));
    using u8 = std::uint8_t;
    const std::string expected_row = packed(1.0f, 0.0f, 0.0f, std::int16_t(7), std::uint16_t(2), 0.1, 1e300, 1.0f, 0.5f,
                                            0.25f, u8(5), u8(6), u8(7), u8(8));
    EXPECT_NE(rows_of("out.ply").find(expected_row), std::string::npos);
    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_EQ(again.corners, mesh.corners);
    EXPECT_EQ(again.vertex_uvs, mesh.vertex_uvs);
    EXPECT_EQ(again.vertex_colors, mesh.added_colors);
}

INSTANTIATE_TEST_SUITE_P(All, PlyFormats, testing::Values("ascii", "binary_little_endian", "binary_big_endian"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(Ply, BakingTwiceReplacesInPlace) {
    Mesh mesh = read("square.ply", square);
    mesh.set_attribute({"ao", 1, {1, 2, 3, 4}});
    mesh.set_attribute({"bent_normal", 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}});
    mesh.set_attribute({"flow", 3, std::vector<float>(12, 0.5f)});
    mesh.added_colors.assign(4, Color{255, 0, 0, 255});
    mesh.added_comments = {"baked by a test", "radius 1"};
    write_mesh(mesh, path("once.ply"));
    Mesh once = read_mesh(path("once.ply"));
    once.set_attribute(mesh.attributes[0]);
    once.set_attribute(mesh.attributes[1]);
    once.set_attribute(mesh.attributes[2]);
    once.added_colors = mesh.added_colors;
    once.added_comments = mesh.added_comments;
    write_mesh(once, path("twice.ply"));
    EXPECT_EQ(bytes_of("once.ply"), bytes_of("twice.ply"));
    const std::string header = header_of("once.ply");
    EXPECT_NE(header.find("comment baked by a test\ncomment radius 1\n"), std::string::npos);
    EXPECT_NE(header.find("property float ao\nproperty float bent_x\nproperty float bent_y\nproperty float bent_z\n"
                          "property float flow_x\nproperty float flow_y\nproperty float flow_z\n"
                          "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"),
              std::string::npos)
        << header;
    EXPECT_EQ(rows_of("once.ply").substr(0, 44).substr(12, 16), packed(1.0f, 1.0f, 2.0f, 3.0f));
}

TEST_F(Ply, APropertyOfAnotherTypeIsReplacedInPlace) {
    Mesh mesh =
        read("in.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty list uchar int ao\n"
                       "property double y\nproperty float red\nproperty float green\nproperty float blue\n"
                       "property double z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
                       "0 2 7 8 0 0.5 0.25 1 0\n1 0 0 0 0 0 0\n0 1 9 1 1 1 1 0.1\n3 0 1 2\n");
    EXPECT_EQ(mesh.vertex_colors[0], (Color{128, 64, 255, 255}));
    mesh.set_attribute({"ao", 1, {0.5f, 0.25f, 0.125f}});
    mesh.added_colors.assign(3, Color{1, 2, 3, 4});
    write_mesh(mesh, path("out.ply"));
    using u8 = std::uint8_t;
    const auto row = [](double x, float ao, double y, double z) {
        return packed(x, ao, y, u8(1), u8(2), u8(3), z, u8(4));
    };
    EXPECT_EQ(rows_of("out.ply"),
              row(0, 0.5f, 0, 0) + row(1, 0.25f, 0, 0) + row(0, 0.125f, 1, 0.1) + packed(u8(3), 0, 1, 2));
    EXPECT_NE(
        header_of("out.ply").find("property double x\nproperty float ao\nproperty double y\nproperty uchar red\n"),
        std::string::npos);
}

TEST_F(Ply, NormalsAreUnitOrZero) {
    const Mesh mesh = read("in.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                     "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                                     "element face 1\nproperty list uchar int vertex_index\nend_header\n"
                                     "0 0 0 0 0 8\n1 0 0 0 0 0\n0 1 0 nan 0 1\n1 1 1 3 4 0\n3 0 1 2\n");
    EXPECT_EQ(mesh.normals[0], Vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[1], Vec3(0));
    EXPECT_EQ(mesh.normals[2], Vec3(0));
    EXPECT_EQ(mesh.normals[3], Vec3(0.6f, 0.8f, 0.0f));
}

TEST_F(Ply, CornerTextureCoordinatesComeFromTheFaces) {
    const Mesh mesh = read("in.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                     "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                                     "property list uchar float texcoord\nend_header\n"
                                     "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 .1 .2 .3 .4 .5\n3 2 1 0 0\n");
    ASSERT_EQ(mesh.corner_uvs.size(), 6u);
    EXPECT_EQ(mesh.corner_uvs[1], Vec2(0.2f, 0.3f));
    EXPECT_EQ(mesh.corner_uvs[5], Vec2(0.0f));
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("1 face has no texture coordinates"), std::string::npos) << mesh.warnings[0];
}

TEST_F(Ply, LineEndsOfAllKindsAreRead) {
    const auto with_line_ends = [](std::string text, const std::string& end) {
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
            text.replace(at, 1, end);
        return text;
    };
    for (const std::string end : {"\r\n", "\r"}) {
        EXPECT_EQ(read("text.ply", with_line_ends(square, end)).corners, (std::vector<std::uint32_t>{0, 1, 2, 3}));
        // The first byte of the rows is a line feed.
        const std::string rows = packed('\n', '\0', '\0', '\0', 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f) +
                                 packed(std::uint8_t(3), 0, 1, 2);
        const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                                   "property float y\nproperty float z\nelement face 1\n"
                                   "property list uchar int vertex_indices\nend_header\n";
        const Mesh mesh = read("binary.ply", with_line_ends(header, end) + rows);
        EXPECT_EQ(mesh.positions[0].x, std::bit_cast<float>(10));
        EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2}));
    }
}

TEST_F(Ply, OddValuesAreKeptAndCounted) {
    Mesh mesh = read("in.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty float y\n"
                               "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"
                               "nan 0 0\n1e39 -inf 0\n0 1 0\n1e39 2 0\n3 0 1 2\n2 0 1\n0\n# behind\n");
    EXPECT_EQ(mesh.vertex_count(), 4u);
    EXPECT_EQ(mesh.face_count(), 3u);
    EXPECT_EQ(mesh.positions[3].x, 1e39);
    ASSERT_EQ(mesh.warnings.size(), 3u);
    EXPECT_NE(mesh.warnings[0].find("bytes after"), std::string::npos) << mesh.warnings[0];
    EXPECT_NE(mesh.warnings[1].find("2 vertices have coordinates that are not finite"), std::string::npos);
    EXPECT_NE(mesh.warnings[2].find("2 faces have fewer than three corners"), std::string::npos);
    write_mesh(mesh, path("out.ply"));
    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_TRUE(std::isnan(again.positions[0].x));
    EXPECT_EQ(again.face_begin, mesh.face_begin);
}

TEST_F(Ply, AMeshFromElsewhereIsWrittenWhole) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1f}, {0, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}};
    mesh.vertex_colors = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}, {13, 14, 15, 16}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    mesh.add_face(std::vector<std::uint32_t>{2, 1, 0});
    mesh.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {.5f, .25f}, {0, 0}, {1, 1}};
    mesh.face_colors = {{255, 0, 0, 255}, {0, 255, 0, 128}};
    write_mesh(mesh, path("out.ply"));
    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_EQ(again.positions, mesh.positions);
    EXPECT_EQ(again.normals, mesh.normals);
    EXPECT_EQ(again.vertex_colors, mesh.vertex_colors);
    EXPECT_EQ(again.face_begin, mesh.face_begin);
    EXPECT_EQ(again.corners, mesh.corners);
    EXPECT_EQ(again.corner_uvs, mesh.corner_uvs);
    EXPECT_EQ(again.face_colors, mesh.face_colors);
}

TEST_F(Ply, APolygonOf300CornersStaysWhole) {
    Mesh mesh;
    std::vector<std::uint32_t> ring;
    for (std::uint32_t v = 0; v < 300; ++v) {
        mesh.positions.push_back({std::cos(v * 0.02), std::sin(v * 0.02), 0});
        ring.push_back(v);
        mesh.corner_uvs.push_back({float(v), 0.5f});
    }
    mesh.add_face(ring);
    write_mesh(mesh, path("out.ply"));
    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_EQ(again.corners, ring);
    EXPECT_EQ(again.corner_uvs, mesh.corner_uvs);
}

TEST_F(Ply, ManyTextRowsAndLongOnesKeepEveryValue) {
    constexpr int count = 20000;
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
                       "\nproperty float x\nproperty float y\nproperty float z\n"
                       "property list uchar short marks\nelement face 2\n"
                       "property list int int vertex_indices\nend_header\n";
    std::string rows;
    for (int v = 0; v < count; ++v) {
        const int marks = v / 4000; // later rows are longer
        text += std::to_string(v) + " 0 1 " + std::to_string(marks);
        rows += packed(float(v), 0.0f, 1.0f, std::uint8_t(marks));
        for (int m = 0; m < marks; ++m) {
            text += " " + std::to_string(m - v);
            rows += packed(std::int16_t(m - v));
        }
        text += "\n";
    }
    for (int face = 0; face < 2; ++face) {
        text += std::to_string(count);
        rows += packed(count);
        for (int v = 0; v < count; ++v) {
            text += " " + std::to_string(v);
            rows += packed(v);
        }
        text += "\n";
    }
    const Mesh mesh = read("in.ply", text);
    EXPECT_EQ(mesh.face_begin, (std::vector<std::uint32_t>{0, count, 2 * count}));
    write_mesh(mesh, path("out.ply"));
    EXPECT_TRUE(rows_of("out.ply") == rows);
}

TEST_F(Ply, CoordinatesAreDoubleOnlyWhereFloatWouldMoveThem) {
    const auto x_type = [&](double offset) {
        Mesh mesh;
        mesh.positions = {{offset, 0, 0}, {offset + 1.1, 0, 0}, {offset, 1, 0}};
        mesh.add_face(std::vector<std::uint32_t>{0, 1, 2});
        write_mesh(mesh, path("out.ply"));
        return header_of("out.ply").find("property double x") != std::string::npos ? "double" : "float";
    };
    EXPECT_STREQ(x_type(0.0), "float");
    EXPECT_STREQ(x_type(5e5), "double");
    EXPECT_STREQ(x_type(1e39), "double");
}

TEST_F(Ply, AMeshThatLostItsFacesCountIsNotMixedWithItsDocument) {
    Mesh mesh = read("square.ply", square);
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2});
    const auto lost = write_mesh(mesh, path("out.ply"));
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_EQ(read_mesh(path("out.ply")).face_count(), 2u);
}
