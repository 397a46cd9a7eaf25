// What exporters write besides the plain vertices and faces: strips, names, ranges of colours, text after the rows.
#include "scratch_files.h"

#include "alcove/mesh/formats/ply/ply_document.h"
#include "alcove/mesh/triangulate.h"

#include <algorithm>
#include <set>

using namespace alcove;
using PlyVariants = ScratchFiles;

namespace {

const std::string cube_points = "-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string list = "property list uchar int vertex_indices\n";

/// A cube by its strips: 12 triangles, all outward.
const std::vector<std::vector<int>> cube_strips{{3, 2, 0, 1, 4, 5, 7, 6, 3, 2}, {1, 2, 5, 6}, {0, 4, 3, 7}};

std::string cube_of_strips(const std::string& properties, const std::string& rows, int count = 1) {
    return "ply\nformat ascii 1.0\nelement vertex 8\n" + xyz + "element tristrips " + std::to_string(count) + "\n" +
           properties + "end_header\n" + cube_points + rows;
}

std::string in_one_row(const std::string& separator) {
    std::string row;
    int count = 0;
    for (const std::vector<int>& strip : cube_strips) {
        for (const int v : strip)
            row += " " + std::to_string(v);
        row += " " + separator;
        count += static_cast<int>(strip.size()) + 1;
    }
    return std::to_string(count) + row;
}

std::size_t outward_triangles(const Mesh& mesh) {
    std::set<std::vector<std::uint32_t>> different;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        const Vec3d a = mesh.positions[face[0]], b = mesh.positions[face[1]], c = mesh.positions[face[2]];
        std::vector<std::uint32_t> sorted(face.begin(), face.end());
        std::sort(sorted.begin(), sorted.end());
        if (face.size() == 3 && glm::dot(glm::cross(b - a, c - a), a + b + c) > 0.0)
            different.insert(sorted);
    }
    return different.size();
}

bool warns(const Mesh& mesh, std::string_view words) {
    return std::any_of(mesh.warnings.begin(), mesh.warnings.end(),
                       [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

/// A triangle whose vertices have `properties`, with one vertex per entry of `rows`.
std::string triangle_with(const std::string& properties, const std::array<std::string, 3>& rows) {
    return "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + properties + "element face 1\n" + list +
           "end_header\n0 0 0 " + rows[0] + "\n1 0 0 " + rows[1] + "\n0 1 0 " + rows[2] + "\n3 0 1 2\n";
}

std::string of_type(const std::string& type, std::initializer_list<const char*> names) {
    std::string properties;
    for (const char* name : names)
        properties += "property " + type + " " + name + "\n";
    return properties;
}

}

TEST_F(PlyVariants, StripsOfAnyTypeAreTriangles) {
    std::string rows;
    for (const std::vector<int>& strip : cube_strips) {
        rows += std::to_string(strip.size());
        for (const int v : strip)
            rows += " " + std::to_string(v);
        rows += "\n";
    }
    for (const std::string& file :
         {cube_of_strips("property list int int vertex_indices\n", in_one_row("-1") + "\n"),
          cube_of_strips("property list uint uint vertex_indices\n", in_one_row("4294967295") + "\n"),
          cube_of_strips("property list ushort ushort vertex_index\n", in_one_row("65535") + "\n"),
          cube_of_strips("property list uchar uchar vertex_index\n", in_one_row("255") + "\n"),
          cube_of_strips("property list uchar char vertex_indices\n", rows, 3)}) {
        const Mesh mesh = read("strips.ply", file);
        EXPECT_EQ(mesh.face_count(), 12u) << file;
        EXPECT_EQ(outward_triangles(mesh), 12u) << file;
        EXPECT_TRUE(mesh.warnings.empty());
    }
}

TEST_F(PlyVariants, BinaryStripsAreTriangles) {
    std::string rows;
    for (const float c : {-1.f, -1.f, 0.f, 1.f, -1.f, 0.f, -1.f, 1.f, 0.f, 1.f, 1.f, 0.f})
        rows += packed(c);
    const Mesh mesh = read("strips.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4\n" + xyz +
                                             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                                             rows + packed(4, 0, 1, 2, 3));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
}

TEST_F(PlyVariants, StripsConnectedByRepeatedVerticesKeepTheirTurns) {
    // The strips 0 1 2 3 and 4 5 6 7 are joined by repeating 3 and 4, so that an even number of triangles is
    // degenerate.
    const Mesh mesh =
        read("strips.ply", cube_of_strips("property list int int vertex_indices\n", "10 0 1 2 3 3 4 4 5 6 7\n"));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7}));
}

TEST_F(PlyVariants, StripsAreWrittenAsFacesAndWhatIsDroppedIsNamed) {
    const Mesh mesh = read("strips.ply", cube_of_strips("property list int int vertex_indices\nproperty int group\n",
                                                        "6 0 1 2 -1 3 4 7\n"));
    EXPECT_TRUE(warns(mesh, "1 triangle strip has fewer than three vertices"));
    EXPECT_TRUE(warns(mesh, "the property 'group' of the triangle strips is left out"));
    EXPECT_TRUE(write_mesh(mesh, path("out.ply")).empty());
    EXPECT_NE(header_of("out.ply").find("element face 1\nproperty list uchar int vertex_indices\nend_header"),
              std::string::npos);
    EXPECT_EQ(header_of("out.ply").find("tristrips"), std::string::npos);
    EXPECT_EQ(read_mesh(path("out.ply")).corners, mesh.corners);
}

TEST_F(PlyVariants, StripsBesideFacesStayInTheFile) {
    const Mesh mesh = read("both.ply", "ply\nformat ascii 1.0\nelement vertex 8\n" + xyz + "element face 1\n" + list +
                                           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                                           cube_points + "3 0 1 2\n3 0 1 2\n");
    EXPECT_EQ(mesh.face_count(), 1u);
    EXPECT_TRUE(warns(mesh, "1 rows of triangle strips; these are kept"));
    write_mesh(mesh, path("out.ply"));
    EXPECT_NE(header_of("out.ply").find("element tristrips 1\n"), std::string::npos);
}

TEST_F(PlyVariants, NamesMayHoldBlanksAndAnyLetters) {
    const std::string properties = "property float wear mask\nproperty uchar H\xc3\xb6he \xc3\xbc. NN\n";
    Mesh mesh = read("names.ply", triangle_with(properties, {".5 1", ".25 2", "1 3"}));
    mesh.set_attribute({"ao", 1, {0, 0, 0}});
    EXPECT_TRUE(write_mesh(mesh, path("out.ply")).empty());
    EXPECT_NE(header_of("out.ply").find(properties + "property float ao\n"), std::string::npos);
    EXPECT_NE(rows_of("out.ply").find(packed(1.f, 0.f, 0.f, .25f, std::uint8_t(2), 0.f)), std::string::npos);
    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_TRUE(again.source->has_vertex_property("wear mask"));

    const Mesh other = read("element.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + "element face 1\n" +
                                               list + "element left over 1\nproperty int a\nend_header\n" +
                                               "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n9\n");
    write_mesh(other, path("out.ply"));
    EXPECT_NE(header_of("out.ply").find("element left over 1\n"), std::string::npos);
}

TEST_F(PlyVariants, TheFormatLineMayComeLast) {
    const Mesh mesh = read("late.ply", "ply\nelement vertex 3\n" + xyz + "comment between\nelement face 1\n" + list +
                                           "format ascii 1.0\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(mesh.face_count(), 1u);
}

TEST_F(PlyVariants, TheValuesOfColoursTellTheirRange) {
    // 51 = 0.2 × 255, whatever the type.
    struct Case {
        const char *type, *fifth, *full;
    };
    for (const auto& [type, fifth, full] : {Case{"float", "51", "255"},
                                            {"float", "0.2", "1"},
                                            {"double", "51.0", "255"},
                                            {"double", ".2", "1.0000001"},
                                            {"uchar", "51", "255"},
                                            {"int", "51", "255"},
                                            {"ushort", "51", "255"},
                                            {"ushort", "13107", "65535"},
                                            {"uint", "13107", "65535"},
                                            {"float", "13107", "65535"},
                                            {"float", "51", "nan"},
                                            {"float", ".2", "nan"}}) {
        SCOPED_TRACE(std::string(type) + " " + fifth + " " + full);
        const std::string grey = std::string(fifth) + " " + fifth + " " + fifth;
        const Mesh mesh = read("colours.ply", triangle_with(of_type(type, {"red", "green", "blue"}),
                                                            {grey, std::string(full) + " 0 0", grey}));
        ASSERT_EQ(mesh.vertex_colors.size(), 3u);
        EXPECT_EQ(mesh.vertex_colors[0], (Color{51, 51, 51, 255}));
        EXPECT_EQ(mesh.vertex_colors[1][0], std::string(full) == "nan" ? 0 : 255);
    }
    const Mesh opaque = read("alpha.ply", triangle_with(of_type("float", {"red", "green", "blue", "alpha"}),
                                                        {"1 1 1 255", "0.2 0 0 51", "0 0 0 0"}));
    EXPECT_EQ(opaque.vertex_colors[1], (Color{51, 0, 0, 51})) << "alpha has its own range";
}

TEST_F(PlyVariants, ColoursAreKnownByTheirOtherNames) {
    for (const auto& names : {std::initializer_list<const char*>{"r", "g", "b", "a"},
                              {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"}}) {
        const Mesh mesh = read("names.ply", triangle_with(of_type("uchar", names), {"1 2 3 4", "5 6 7 8", "9 0 0 0"}));
        ASSERT_EQ(mesh.vertex_colors.size(), 3u);
        EXPECT_EQ(mesh.vertex_colors[1], (Color{5, 6, 7, 8}));
    }
}

TEST_F(PlyVariants, TextBehindTheRowsIsQuoted) {
    const std::string sound = triangle_with("", {"", "", ""});
    for (const auto& [rest, warnings] : std::vector<std::pair<std::string, std::vector<std::string>>>{
             {"\x1a", {}},
             {std::string(100, '\0'), {}},
             {"7 8 9\n", {"6 bytes after the last row were not read: '7 8 9'"}},
             {"</pre>\n</html>\n", {"15 bytes after the last row were not read: '</pre>'"}}}) {
        const Mesh mesh = read("rest.ply", sound + rest);
        EXPECT_EQ(mesh.face_count(), 1u);
        EXPECT_EQ(mesh.warnings, warnings);
    }
}

TEST_F(PlyVariants, ReplacedPropertiesAreNamedUnlessAnEarlierRunMadeThem) {
    const std::string file = triangle_with("property uchar ao\nproperty float bent_y\n", {"11 0", "22 0", "33 0"});
    Mesh mesh = read("own.ply", file);
    mesh.set_attribute({"ao", 1, {0, .5f, 1}});
    mesh.set_attribute({"bent_normal", 3, std::vector<float>(9)});
    mesh.added_comments = {"baker 1: ao, bent_normal by hand"};
    EXPECT_EQ(write_mesh(mesh, path("out.ply")),
              (std::vector<std::string>{"the property 'ao' of the input is replaced",
                                        "the property 'bent_y' of the input is replaced"}));
    Mesh again = read_mesh(path("out.ply"));
    again.set_attribute(mesh.attributes[0]);
    again.set_attribute(mesh.attributes[1]);
    EXPECT_EQ(write_mesh(again, path("twice.ply")).size(), 4u) << "nothing says that the run is of the same program";
    again.added_comments = {"baker 2: ao, bent_normal by machine"};
    EXPECT_TRUE(write_mesh(again, path("twice.ply")).empty());
    again.set_attribute({"thickness", 1, {1, 2, 3}});
    EXPECT_TRUE(write_mesh(again, path("twice.ply")).empty()) << "the input has no such property";
}
