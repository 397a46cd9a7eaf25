#include "scratch_files.h"

#include <cmath>

using namespace alcove;
using Stl = ScratchFiles;

namespace {

std::string facet(Vec3 a, Vec3 b, Vec3 c, std::uint16_t attribute = 0) {
    return packed(0.f, 0.f, 1.f, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z) + packed(attribute);
}

std::string binary(const std::string& title, std::uint32_t count, const std::string& facets) {
    std::string header = title;
    header.resize(80, ' ');
    return header + packed(count) + facets;
}

const std::string square = facet({0, 0, 0}, {1, 0, 0}, {1, 1, 0}) + facet({0, 0, 0}, {1, 1, 0}, {0, 1, -0.0f}) +
                           facet({0, 1, 0}, {-0.0f, 0, 0}, {0.1f, 0, 0});

void expect_square(const Mesh& mesh) {
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.1f, 0, 0}}));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 3, 0, 4}));
    EXPECT_EQ(mesh.face_begin, (std::vector<std::uint32_t>{0, 3, 6, 9}));
}

}

TEST_F(Stl, BinaryCornersAreJoinedInOrderOfFirstAppearance) {
    const Mesh mesh = read("in.stl", binary("made by hand", 3, square));
    expect_square(mesh);
    EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(Stl, ABinaryFileMayBeginWithTheWordSolid) {
    expect_square(read("in.stl", binary("solid box", 3, square)));
}

TEST_F(Stl, BinaryIsKnownByItsSizeWhateverItsName) {
    expect_square(read("in.mesh", binary("x", 3, square)));
}

TEST_F(Stl, NearbyCornersStayApart) {
    const float next = std::nextafter(1.0f, 2.0f);
    const Mesh mesh = read(
        "in.stl", binary("", 2, facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}) + facet({0, 0, 0}, {next, 0, 0}, {0, 1, 0})));
    EXPECT_EQ(mesh.vertex_count(), 4u);
}

TEST_F(Stl, AttributesAndBytesBehindTheEndAreCounted) {
    const Mesh mesh = read(
        "in.stl",
        binary("", 2, facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 9) + facet({0, 0, 0}, {1, 0, 0}, {NAN, 1, 0}) + "tail"));
    ASSERT_EQ(mesh.warnings.size(), 3u);
    EXPECT_NE(mesh.warnings[0].find("1 facet has attribute bytes"), std::string::npos);
    EXPECT_NE(mesh.warnings[1].find("4 bytes after"), std::string::npos);
    EXPECT_NE(mesh.warnings[2].find("1 vertex has coordinates that are not finite"), std::string::npos);
}

TEST_F(Stl, TextIsReadWhateverItsCaseAndLineEnds) {
    const std::string text = "solid first part\r\n"
                             " facet normal 0 0 1\r\n outer loop\r\n vertex 0 0 0\r\n vertex 1 0 0\r\n vertex 1 1 0\r\n"
                             " endloop\r\n endfacet\r\nendsolid first part\r\n"
                             "SOLID\n FACET NORMAL nan 0 0\nOUTER LOOP\nVERTEX -0 0 0\nVERTEX 1.0 1 0\nVERTEX 0 2 0\n"
                             "vertex 0 1 0\nENDLOOP\nENDFACET\nENDSOLID";
    const Mesh mesh = read("in.stl", text);
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 2, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 4}));
    EXPECT_EQ(mesh.face_begin, (std::vector<std::uint32_t>{0, 3, 7}));
}
