#include "scratch_files.h"

#include <cmath>

using namespace alcove;
using Off = ScratchFiles;

namespace {

const std::vector<Vec3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}};

void expect_triangle(const Mesh& mesh) {
    EXPECT_EQ(mesh.positions, corners);
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(mesh.face_begin, (std::vector<std::uint32_t>{0, 3}));
}

}

TEST_F(Off, HeadersOfAllShapesAreRead) {
    for (const std::string text : {
             "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n",
             "OFF 3 1 3\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2",
             "# before\n\n  # again\nOFF # here\n# there\n3 1 0 # counts\n\n0 0 0 # p\n1 0 0\n\n0 1 .5\n3 0 "
             "1 2 # f\n#end\n",
             "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 .5\r\n3 0 1 2\r\n",
             "OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 .5\r3 0 1 2\r",
             "3 1 0\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n",
             "OFF\n3 1\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n",
             "OFF\n3\n1\n0\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n",
             "OFF 3 1 0\n0 0 0 1 0 0\n0 1 .5\n3\n0 1\n2\n",
             "OFF\n3 1 0\n+0 -0.0 0e5\n\t1 0 0  \n0 1 5e-1\n3 0 1 2\n",
         }) {
        SCOPED_TRACE(text);
        const Mesh mesh = read("in.off", text);
        expect_triangle(mesh);
        EXPECT_TRUE(mesh.warnings.empty());
    }
}

TEST_F(Off, TheFirstBytesDecideOverTheExtension) {
    expect_triangle(read("in.ply", "# x\nOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n"));
}

TEST_F(Off, ColoursNormalsAndTextureCoordinatesAreRead) {
    const Mesh mesh = read("in.off", "STCNOFF\n3 1 0\n"
                                     "0 0 0 0 0 2 255 0 0 128 0 1\n"
                                     "1 0 0 0 0 0 0 10 0 255 0.5 1\n"
                                     "0 1 .5 3 4 0 0 0 77 0 1 0.25\n"
                                     "3 0 1 2\n");
    expect_triangle(mesh);
    EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 0, 0}, {0.6f, 0.8f, 0}}));
    EXPECT_EQ(mesh.vertex_colors, (std::vector<Color>{{255, 0, 0, 128}, {0, 10, 0, 255}, {0, 0, 77, 0}}));
    EXPECT_EQ(mesh.vertex_uvs, (std::vector<Vec2>{{0, 1}, {0.5f, 1}, {1, 0.25f}}));
}

TEST_F(Off, ColoursRunToOneOrTo255) {
    const auto colors = [&](const char* a, const char* b, const char* c) {
        return read("in.off", std::string("COFF\n3 1 0\n0 0 0 ") + a + "\n1 0 0 " + b + "\n0 1 .5 " + c + "\n3 0 1 2\n")
            .vertex_colors;
    };
    EXPECT_EQ(colors("1 0 0", "0.5 0 0", "0 0 1"),
              (std::vector<Color>{{255, 0, 0, 255}, {128, 0, 0, 255}, {0, 0, 255, 255}}));
    EXPECT_EQ(colors("1 0 0", "2 0 0", "0 0 255"),
              (std::vector<Color>{{1, 0, 0, 255}, {2, 0, 0, 255}, {0, 0, 255, 255}}));
    EXPECT_EQ(colors("1 0 0 1", "0 1 0 0", "0 0 1 1"),
              (std::vector<Color>{{255, 0, 0, 255}, {0, 255, 0, 0}, {0, 0, 255, 255}}));
}

TEST_F(Off, FaceColoursReachThePly) {
    const Mesh mesh = read("in.off", "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2 255 0 9\n3 2 1 0\n3 0 1 2 1 2 3 4\n");
    EXPECT_EQ(mesh.face_colors, (std::vector<Color>{{255, 0, 9, 255}, {170, 170, 170, 255}, {1, 2, 3, 4}}));
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("1 face has no colour"), std::string::npos);
    write_mesh(mesh, path("out.ply"));
    EXPECT_EQ(read_mesh(path("out.ply")).face_colors, mesh.face_colors);
}

TEST_F(Off, ColourMapIndicesAreCountedAsLeftOut) {
    const Mesh mesh = read("in.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2 7\n");
    expect_triangle(mesh);
    EXPECT_TRUE(mesh.face_colors.empty());
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("colour map"), std::string::npos);
}

TEST_F(Off, HomogeneousVerticesAreDividedByTheirWeight) {
    expect_triangle(read("in.off", "4OFF\n3 1 0\n0 0 0 5\n2 0 0 2\n0 .25 .125 .25\n3 0 1 2\n"));
}

TEST_F(Off, DimensionThreeIsRead) {
    expect_triangle(read("in.off", "nOFF\n3\n3 1 0\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n"));
}

TEST_F(Off, BinaryIsBigEndian) {
    const Mesh mesh =
        read("in.off", "COFF BINARY\n" + packed_reversed(3, 2, 0) +
                           packed_reversed(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, .5f, 0.f,
                                           1.f, .5f, 0.f, 0.f, 1.f, 0.f) +
                           packed_reversed(3, 0, 1, 2, 0) + packed_reversed(3, 2, 1, 0, 3, 0.f, 1.f, 0.f));
    EXPECT_EQ(mesh.positions, corners);
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 0}));
    EXPECT_EQ(mesh.vertex_colors, (std::vector<Color>{{255, 0, 0, 255}, {0, 255, 0, 128}, {0, 0, 255, 0}}));
    EXPECT_EQ(mesh.face_colors[1], (Color{0, 255, 0, 255}));
}

TEST_F(Off, ValuesTheKeywordDoesNotAnnounceAreCounted) {
    const Mesh mesh = read("in.off", "OFF\n3 1 0\n0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 .5 1 2 3\n3 0 1 2\n");
    expect_triangle(mesh);
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("3 vertex lines have more values"), std::string::npos) << mesh.warnings[0];
}

TEST_F(Off, NonFiniteTokensAndBytesBehindTheEndAreCounted) {
    const Mesh mesh = read("in.off", "OFF\n4 1 0\nnan 0 0\n1 INF 0\n0 1 1e39\n0 1 1e400\n3 0 1 2\n9 9 9\n");
    EXPECT_EQ(mesh.positions[2].z, 1e39);
    ASSERT_EQ(mesh.warnings.size(), 2u);
    EXPECT_NE(mesh.warnings[0].find("6 bytes after"), std::string::npos) << mesh.warnings[0];
    EXPECT_NE(mesh.warnings[1].find("3 vertices have coordinates that are not finite"), std::string::npos);
}

TEST_F(Off, KeywordsMayBeInLowerCaseAndTouchTheCounts) {
    for (const std::string header : {"OFF3 1 0\n", "off\n3 1 0\n", "Off 3 1 0\n", "off3 1 0\n", "\n# c\n\nOFF3 1\n"}) {
        SCOPED_TRACE(header);
        const Mesh mesh = read("in.off", header + "0 0 0\n1 0 0\n0 1 .5\n3 0 1 2\n");
        expect_triangle(mesh);
        EXPECT_TRUE(mesh.warnings.empty());
    }
    expect_triangle(read("in.off", "noff\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 .5 0 0 1\n3 0 1 2\n"));
    EXPECT_EQ(read("in.off", "coff3 1 0\n0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 .5 9 9 9\n3 0 1 2\n").vertex_colors[2],
              (Color{9, 9, 9, 255}));
}

namespace {

/// The values of a vertex after its coordinates.
const std::string normal = " 0.6 -0.8 0", bytes4 = " 200 100 50 255", bytes3 = " 200 100 50", uv = " 0.25 1";
const std::string fractions = " 0.75 0.5 0.25 1";

std::string off_of(const std::string& keyword, const std::string& values) {
    return keyword + "\n3 1 0\n0 0 0" + values + "\n1 0 0" + values + "\n0 1 .5" + values + "\n3 0 1 2\n";
}

struct Order {
    std::string keyword, values;
    Color color{200, 100, 50, 255};
    bool warns = true;
};

}

TEST_F(Off, TheNumbersDecideTheOrderOfTheValues) {
    const Color in_fractions{191, 128, 64, 255};
    for (const Order& order : std::vector<Order>{{"CNOFF", normal + bytes4, {200, 100, 50, 255}, false},
                                                 {"CNOFF", bytes4 + normal},
                                                 {"NCOFF", bytes4 + normal},
                                                 {"NCOFF", normal + bytes4},
                                                 {"NCOFF", bytes3 + normal},
                                                 {"NCOFF", normal + bytes3},
                                                 {"ncoff", fractions + normal, in_fractions},
                                                 {"CNOFF", normal + fractions, in_fractions, false},
                                                 {"STCNOFF", normal + bytes4 + uv, {200, 100, 50, 255}, false},
                                                 {"NCSTOFF", bytes4 + normal + uv},
                                                 {"STNCOFF", uv + normal + bytes4},
                                                 {"STCOFF", bytes4 + uv, {200, 100, 50, 255}, false},
                                                 {"STCOFF", uv + bytes4},
                                                 {"CSTOFF", bytes4 + uv},
                                                 {"CSTOFF", uv + bytes4},
                                                 {"CSTOFF", uv + fractions, in_fractions},
                                                 {"CSTOFF", fractions + uv, in_fractions}}) {
        SCOPED_TRACE(order.keyword + order.values);
        const Mesh mesh = read("in.off", off_of(order.keyword, order.values));
        expect_triangle(mesh);
        EXPECT_EQ(mesh.vertex_colors[1], order.color);
        const bool has_normals = order.values.find(normal) != std::string::npos;
        EXPECT_EQ(mesh.normals, std::vector<Vec3>(has_normals ? 3 : 0, Vec3(0.6f, -0.8f, 0)));
        const bool has_uvs = order.keyword.find("ST") != std::string::npos;
        EXPECT_EQ(mesh.vertex_uvs, std::vector<Vec2>(has_uvs ? 3 : 0, Vec2(0.25f, 1)));
        ASSERT_EQ(mesh.warnings.size(), order.warns ? 1u : 0u);
        if (order.warns) {
            EXPECT_NE(mesh.warnings[0].find("the values of each vertex are read as x y z "), std::string::npos);
        }
    }
}

TEST_F(Off, TheOrderOfTheFormatStaysWhereTheNumbersDoNotDecide) {
    // In the format's order, the normals are not of unit length either, so both orders fit equally.
    const Mesh mesh = read("in.off", off_of("CNOFF", " 0 0 5 255 0 0"));
    EXPECT_EQ(mesh.normals[0], Vec3(0, 0, 1));
    EXPECT_EQ(mesh.vertex_colors[0], (Color{255, 0, 0, 255}));
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_EQ(read("in.off", off_of("NSTOFF", normal + uv)).vertex_uvs[0], Vec2(0.25f, 1));
}

TEST_F(Off, AnyNumberOfUndeclaredValuesIsLeftOut) {
    for (const std::string& values : {std::string(" 7"), std::string(" 1 2"), normal + bytes4, normal + bytes4 + uv}) {
        const Mesh mesh = read("in.off", off_of("OFF", values));
        expect_triangle(mesh);
        ASSERT_EQ(mesh.warnings.size(), 1u);
        EXPECT_NE(mesh.warnings[0].find("3 vertex lines have more values"), std::string::npos) << mesh.warnings[0];
    }
}
