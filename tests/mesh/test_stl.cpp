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

std::string attributed(const std::vector<std::uint16_t>& attributes) {
    std::string facets;
    for (const std::uint16_t attribute : attributes)
        facets += facet({0, 0, 0}, {1, 0, 0}, {0, 1, float(facets.size())}, attribute);
    return facets;
}

std::string text_facet(const std::string& normal, int x, const std::string& endloop = "endloop",
                       const std::string& endfacet = "endfacet") {
    return "facet " + normal + "\nouter loop\nvertex " + std::to_string(x) + " 0 0\nvertex 9 0 1\nvertex 9 1 0\n" +
           endloop + "\n" + endfacet + "\n";
}

const std::string two = text_facet("normal 0 0 1", 0) + text_facet("normal 0 0 1", 1);

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
    EXPECT_NE(mesh.warnings[0].find("1 facet has attribute bytes that are not marked as a colour"), std::string::npos);
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

TEST_F(Stl, ACountThatWasNeverFilledInIsTakenFromTheSize) {
    for (const std::uint32_t count : {0u, 0xffffffffu, 0x7fffffffu})
        for (const char* title : {"made by hand", "solid box"}) {
            const Mesh mesh = read("in.stl", binary(title, count, square));
            expect_square(mesh);
            ASSERT_EQ(mesh.warnings.size(), 1u);
            EXPECT_NE(mesh.warnings[0].find("has room for 3: all of these were read"), std::string::npos);
        }
    const Mesh mesh = read("in.stl", binary("", 0, square + "ab"));
    EXPECT_EQ(mesh.face_count(), 3u);
    EXPECT_NE(mesh.warnings.at(1).find("2 bytes after the last facet were not read"), std::string::npos);
}

TEST_F(Stl, FacetsBeyondTheCountAreReported) {
    const Mesh mesh = read("in.stl", binary("", 1, square));
    EXPECT_EQ(mesh.face_count(), 1u);
    EXPECT_EQ(mesh.warnings, (std::vector<std::string>{"100 bytes after the last facet were not read; they look like 2 "
                                                       "facets beyond the 1 that the header declares"}));
    EXPECT_EQ(read("in.stl", binary("solid", 3, square + "ab")).warnings,
              std::vector<std::string>{"2 bytes after the last facet were not read"});
}

TEST_F(Stl, ColoursOfViscamBecomeThoseOfTheFaces) {
    constexpr std::uint16_t red = 31 << 10, green = 31 << 5, blue = 31, valid = 0x8000;
    const Mesh mesh = read("in.stl", binary("", 4, attributed({red | valid, green | valid, blue | valid, 16 | valid})));
    EXPECT_EQ(mesh.face_colors,
              (std::vector<Color>{{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {0, 0, 132, 255}}));
    EXPECT_TRUE(mesh.warnings.empty());
    const Mesh some = read("in.stl", binary("", 3, attributed({red | valid, 0, green})));
    EXPECT_EQ(some.face_colors, (std::vector<Color>{{255, 0, 0, 255}, {170, 170, 170, 255}, {170, 170, 170, 255}}));
    EXPECT_EQ(some.warnings,
              (std::vector<std::string>{"1 facet has attribute bytes that are not marked as a colour; left out",
                                        "2 facets have no colour, unlike others; grey is used"}));
}

TEST_F(Stl, ColoursOfMagicsBecomeThoseOfTheFaces) {
    constexpr std::uint16_t red = 31, green = 31 << 5, blue = 31 << 10, of_part = 0x8000;
    const std::string title = "made by hand COLOR=\x0a\x14\x1e\xc8,MATERIAL=";
    const Mesh mesh = read("in.stl", binary(title, 4, attributed({red, green, blue, of_part | red})));
    EXPECT_EQ(mesh.face_colors,
              (std::vector<Color>{{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {10, 20, 30, 200}}));
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_EQ(read("in.stl", binary(title, 2, attributed({0, 0}))).face_colors,
              std::vector<Color>(2, Color{10, 20, 30, 200}));
    write_mesh(mesh, path("out.ply"));
    EXPECT_EQ(read_mesh(path("out.ply")).face_colors, mesh.face_colors);
}

TEST_F(Stl, TextIsReadWhateverItsFirstAndLastLines) {
    for (const auto& [head, tail] :
         std::vector<std::pair<std::string, std::string>>{{"solid a\n", "end solid a\n"},
                                                          {"solid\n", "end solid"},
                                                          {"solid a\n", "endsolida\n"},
                                                          {"solid a\nsolid a\n", "endsolid a\nendsolid a\n"},
                                                          {"solida\n", "ENDSOLID a"},
                                                          {"", "endsolid\n"},
                                                          {"solid a\n", "endsolid a\nsolid b\nendsolid b\n"},
                                                          {"", ""}}) {
        SCOPED_TRACE(head + "..." + tail);
        const Mesh mesh = read("in.stl", head + two + tail);
        EXPECT_EQ(mesh.face_count(), 2u);
        EXPECT_EQ(mesh.vertex_count(), 4u);
        EXPECT_TRUE(mesh.warnings.empty());
    }
    const Mesh cut = read("in.stl", "solid a\n" + two);
    EXPECT_EQ(cut.face_count(), 2u);
    EXPECT_EQ(cut.warnings, std::vector<std::string>{"the file ends without 'endsolid': check that it is complete"});
    const Mesh several = read("in.stl", "solid a\n" + two + "endsolid a\nsolid b\nendsolid b\nsolid c\n" +
                                            text_facet("normal 0 0 1", 2) + "endsolid c\n");
    EXPECT_EQ(several.face_count(), 3u);
    EXPECT_TRUE(several.warnings.empty());
}

TEST_F(Stl, KeywordsMayBeTwoWords) {
    const Mesh mesh = read("in.stl", "solid a\n" + text_facet("normal 0 0 1", 0, "end loop", "end facet") +
                                         text_facet("normal 0 0 1", 1, "END LOOP", "endfacet") + "end solid a\n");
    EXPECT_EQ(mesh.face_count(), 2u);
    EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(Stl, NormalsMayBeMissingOrNoNumbers) {
    for (const char* normal :
         {"normal", "", "normal nan nan nan", "normal -nan(ind) -nan(ind) -nan(ind)", "normal -1.#IND -1.#IND -1.#IND",
          "normal 1.#QNAN0e+000 1.#QNAN0e+000 0", "normal 0,5 0,5 0", "normal 0 1"}) {
        const Mesh mesh = read("in.stl", "solid a\n" + text_facet(normal, 0) + two + "endsolid a\n");
        EXPECT_EQ(mesh.face_count(), 3u) << normal;
        EXPECT_TRUE(mesh.warnings.empty()) << normal;
    }
}

TEST_F(Stl, PaddingBehindATextIsIgnored) {
    const std::string sound = "solid a\n" + two + "endsolid a\n";
    for (const std::string& padding :
         {std::string("\x1a"), std::string("\n\x1a\n"), std::string(1, '\0'), std::string(2000, '\0')}) {
        const Mesh mesh = read("in.stl", sound + padding);
        EXPECT_EQ(mesh.face_count(), 2u);
        EXPECT_TRUE(mesh.warnings.empty());
    }
}

TEST_F(Stl, TextThatIsNoStlIsLeftOutAndQuoted) {
    const std::string sound = "solid a\n" + two + "endsolid a\n";
    for (const auto& [bytes, words] : std::vector<std::pair<std::string, std::string>>{
             {sound + "</pre>\n</html>\n",
              "2 lines do not begin with an STL keyword (first: line 17 with '</pre>'); left out"},
             {"<pre>\n" + sound, "(first: line 1 with '<pre>')"},
             {"solid a\ncolor 1 0 0\n" + two + "endsolid", "(first: line 2 with 'color')"}}) {
        const Mesh mesh = read("in.stl", bytes);
        EXPECT_EQ(mesh.face_count(), 2u) << words;
        ASSERT_EQ(mesh.warnings.size(), 1u) << words;
        EXPECT_NE(mesh.warnings[0].find(words), std::string::npos) << mesh.warnings[0];
    }
}
