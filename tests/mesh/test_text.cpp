// What all text formats have in common.
#include "scratch_files.h"

#include "alcove/mesh/formats/text_scanner.h"

#include <cmath>

using namespace alcove;

namespace {

/// A triangle in each text format.
const std::vector<std::pair<std::string, std::string>> triangles{
    {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n"},
    {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n"},
    {"a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n"},
    {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\n"
              "endfacet\nendsolid a\n"}};

class Text : public ScratchFiles {
  protected:
    Mesh expect_triangle(const std::string& name, const std::string& bytes) const {
        SCOPED_TRACE(name);
        Mesh mesh = read(name, bytes);
        EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}}));
        EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2}));
        return mesh;
    }
};

}

TEST_F(Text, AByteOrderMarkBeforeUtf8IsSkipped) {
    for (const auto& [name, text] : triangles) {
        EXPECT_TRUE(expect_triangle(name, "\xef\xbb\xbf" + text).warnings.empty());
        expect_triangle(name, "\xef\xbb\xbf\xef\xbb\xbf" + text);
        if (name == "a.obj" || name == "a.off")
            expect_triangle(name, "\xef\xbb\xbf# a comment\n" + text);
    }
    expect_triangle("without_extension", "\xef\xbb\xbf" + triangles[0].second);
}

TEST_F(Text, AByteOrderMarkStaysInTheText) {
    const std::string text = "\xef\xbb\xbf" + triangles[0].second;
    write_mesh(read("a.obj", text), path("out.obj"));
    EXPECT_EQ(bytes_of("out.obj"), text);
}

TEST_F(Text, PaddingAfterTheEndIsSkipped) {
    for (const std::size_t format : {0u, 1u, 2u})
        for (const std::string& padding :
             {std::string("\x1a"), std::string(20, '\0'), std::string("\x1a\r\n"), std::string("\n\x1a\x1a\0\0", 5)}) {
            const auto& [name, text] = triangles[format];
            const Mesh mesh = expect_triangle(name, text + padding);
            expect_triangle(name, text.substr(0, text.size() - 1) + padding);
            EXPECT_LE(mesh.warnings.size(), 1u);
            if (name != "a.ply") {
                ASSERT_EQ(mesh.warnings.size(), 1u);
                EXPECT_NE(mesh.warnings[0].find("(NUL or Ctrl-Z) after the last"), std::string::npos);
            }
        }
}

TEST_F(Text, OtherTextAfterTheEndIsNamed) {
    for (const std::size_t format : {0u, 1u}) {
        const auto& [name, text] = triangles[format];
        const Mesh mesh = expect_triangle(name, text + "</pre>\n");
        ASSERT_EQ(mesh.warnings.size(), 1u);
        EXPECT_NE(mesh.warnings[0].find("'</pre>'"), std::string::npos) << mesh.warnings[0];
        EXPECT_NE(mesh.warnings[0].find(format == 0 ? "line 5" : "line 7"), std::string::npos) << mesh.warnings[0];
    }
}

TEST_F(Text, NumbersThatOldLibrariesPrintAreNotFinite) {
    for (const char* token :
         {"1.#INF",         "1.#INF00",  "-1.#IND", "-1.#IND00", "1.#QNAN",   "1.#QNAN0", "1.#QNAN0e+000",
          "-1.#INF00e+000", "1.#SNAN",   "1.#J",    "-1.$",      "1.#IO",     "1,#INF00", "nan(ind)",
          "-nan(ind)",      "nan(snan)", "NaN",     "-inf",      "+Infinity", "\u221e",   "-\u221e"})
        for (const auto& [name, text] : triangles) {
            SCOPED_TRACE(std::string(token) + " in " + name);
            const Mesh mesh = read(name, std::string(text).replace(text.find("0.5"), 3, token));
            EXPECT_FALSE(std::isfinite(mesh.positions[2].z));
            ASSERT_EQ(mesh.warnings.size(), 1u);
            EXPECT_NE(mesh.warnings[0].find("1 vertex has coordinates that are not finite"), std::string::npos);
        }
}

TEST_F(Text, InfiniteNumbersKeepTheirSign) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(non_finite_number("1.#INF00"), infinity);
    EXPECT_EQ(non_finite_number("-1.#INF00e+000"), -infinity);
    EXPECT_TRUE(std::isnan(*non_finite_number("-1.#IND00")));
    for (const char* token : {"1.#", "1.#note", "1#INF", "2.#INF", "1.5", "#IND", "", "1.x", "1.#IN!"})
        EXPECT_FALSE(non_finite_number(token)) << token;
}

TEST_F(Text, ACommentBeginsAtTheStartOfAToken) {
    expect_triangle("a.obj", "v 0 0 0 #1\nv 1 0 0\t# 2\n#v 1 1 1\n # v\nv 0 1 0.5\nusemtl a#b\\\n c\nf 1 2 3 # \\\n");
    expect_triangle("a.off", "OFF # a\n3 1 0 #b\n0 0 0\n1 0 0 # c\n#d\n0 1 0.5\n3 0 1 2 #e\n");
}
