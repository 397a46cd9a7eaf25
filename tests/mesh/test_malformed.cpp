#include "scratch_files.h"

#include "alcove/base/types.h"
#include "alcove/mesh/formats/formats.h"

#include <algorithm>
#include <random>

using namespace alcove;

namespace {

/// A damaged file, the position that its error must contain, and words that it must contain.
struct Damage {
    const char* name;
    std::string bytes;
    std::string place; ///< "line 3" or "byte 84"; empty if the error concerns the whole file
    std::string words;

    friend void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }
};

std::string ply(const std::string& vertex_lines, const std::string& face_lines, const std::string& rows) {
    return "ply\nformat ascii 1.0\n" + vertex_lines + face_lines + "end_header\n" + rows;
}
const std::string xyz = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string list = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
const std::string binary_header = "ply\nformat binary_little_endian 1.0\n" + xyz + list + "end_header\n"; // 159 bytes
const std::string binary_points = packed(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);                    // 36 bytes
const std::string off = "OFF\n3 1 0\n" + points;
const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string solid = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
const std::string stl_title(80, ' ');

/// The text in UTF-16; a byte-order mark at its start is converted too.
std::string wide(std::string text, bool big_endian) {
    std::string bytes;
    if (text.starts_with("\ufeff")) {
        bytes = big_endian ? "\xfe\xff" : "\xff\xfe";
        text.erase(0, 3);
    }
    for (const char c : text)
        bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
    return bytes;
}

std::string byte_after(std::size_t offset) {
    return "byte " + std::to_string(offset);
}

std::vector<Damage> damages() {
    const std::size_t body = binary_header.size();
    const std::string signed_header = "ply\nformat binary_little_endian 1.0\n" + xyz +
                                      "element face 1\nproperty list int int vertex_indices\nend_header\n";
    const std::string big_endian_header = "ply\nformat binary_big_endian 1.0\n" + xyz +
                                          "element face 1\nproperty list int int vertex_indices\nend_header\n";
    const std::string huge_header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty float x\n"
        "property float y\nproperty float z\n" +
        list + "end_header\n";
    return {
        // All formats
        {"empty.ply", "", "", "is empty"},
        {"unknown.txt", "hello", "", "is not a mesh in a known format"},
        {"zeros.bin", std::string(100, '\0'), "", "is not a mesh in a known format"},
        {"no_points.ply",
         "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
         "line 7", "contains no vertices and no faces"},
        {"points.off", "OFF\n# no faces\n3 0 0\n" + points, "line 3", "contains 3 points but no faces"},
        {"binary_points.off", "OFF BINARY\n" + packed_reversed(1, 0, 0, 0.f, 0.f, 0.f), "",
         "contains 1 point but no faces"},
        {"points.obj", obj, "", "contains 3 points but no faces"},
        {"nothing.stl", stl_title + packed(0), "", "contains no facets"},
        {"far_apart.obj", "v -1e308 0 0\nv 1e308 0 0\nv 0 1 0\nf 1 2 3\n", "",
         "farther apart than numbers can represent"},
        {"near_together.obj", "v -1e-310 0 0\nv 1e-310 0 0\nv 0 1e-310 0\nf 1 2 3\n", "",
         "closer together than numbers can resolve"},
        {"nothing.obj", "# only a comment\n", "", "contains no vertices and no faces"},
        {"little_endian.obj", wide(obj, false), "", "is text in UTF-16; save it as UTF-8"},
        {"big_endian.ply", wide("\ufeffply\n", true), "", "is text in UTF-16; save it as UTF-8"},
        {"marked.stl", wide("\ufeffsolid a\n", false), "", "is text in UTF-16; save it as UTF-8"},
        {"unmarked.off", wide(off, true), "", "is text in UTF-16; save it as UTF-8"},
        {"of_32_bits.obj", std::string("\xff\xfe\0\0v\0\0\0", 8), "", "is text in UTF-32; save it as UTF-8"},
        // PLY headers
        {"magic.ply", "plyx\nformat ascii 1.0\n", "line 1", "begins with a line 'ply'"},
        {"cut_in_magic.ply", "ply", "line 1", "end_header is missing"},
        {"cut_header.ply", "ply\nformat ascii 1.0\n" + xyz, "line 7", "end_header is missing"},
        {"cut_in_end_header.ply", "ply\nformat ascii 1.0\n" + xyz + list + "end_hea", "line 9",
         "end_header is missing"},
        {"no_format.ply", "ply\n" + xyz + list + "end_header\n" + points + "3 0 1 2\n", "", "no format line"},
        {"format.ply", "ply\nformat utf8 1.0\n", "line 2", "'utf8' is not a PLY format"},
        {"version.ply", "ply\nformat ascii 2.0\n", "line 2", "must read 'format NAME 1.0'"},
        {"format_twice.ply", "ply\nformat ascii 1.0\nformat ascii 1.0\nend_header\n", "line 3", "second format"},
        {"keyword.ply", ply("elemnt vertex 3\n", list, points), "line 3", "'elemnt' is not a keyword"},
        {"binary_keyword.ply", "ply\n\x01\x02\xff\n", "line 2", "'?\?\?' is not a keyword"},
        {"type.ply", ply("element vertex 3\nproperty half x\n", list, points), "line 4", "'half' is not a PLY type"},
        {"count_type.ply", ply(xyz, "element face 1\nproperty list float int vertex_indices\n", points), "line 8",
         "cannot be of type 'float'"},
        {"element_words.ply", ply("element vertex\n", list, points), "line 3", "must read 'element NAME COUNT'"},
        {"property_words.ply", ply("element vertex 3\nproperty float\n", list, points), "line 4",
         "must read 'property TYPE NAME'"},
        {"list_words.ply", ply(xyz, "element face 1\nproperty list uchar vertex_indices\n", points), "line 8",
         "must read 'property TYPE NAME'"},
        {"count_word.ply", ply("element vertex many\n", list, points), "line 3", "'many' is not a number"},
        {"count_negative.ply", ply("element vertex -3\n", list, points), "line 3", "'-3' is not a number"},
        {"count_fraction.ply", ply("element vertex 3.5\n", list, points), "line 3", "'3.5' is not a number"},
        {"count_overflow.ply", ply("element vertex 99999999999999999999\n", list, points), "line 3", "is not a number"},
        {"element_twice.ply", ply(xyz + xyz, list, points), "line 7", "second element 'vertex'"},
        {"property_twice.ply", ply(xyz + "property int x\n", list, points), "line 7", "second property 'x'"},
        {"property_first.ply", ply("property float x\n" + xyz, list, points), "line 3", "before the first element"},
        {"long_line.ply", "ply\ncomment " + std::string(70000, 'x') + "\n", "line 2", "longer than 65,536 bytes"},
        {"no_vertices.ply", ply("", list, "3 0 1 2\n"), "line 5", "no element 'vertex'"},
        {"no_z.ply", ply("element vertex 3\nproperty float x\nproperty float y\n", list, points), "line 8",
         "no property 'z'"},
        {"list_x.ply",
         ply("element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z\n", list, points),
         "line 9", "'x' as a list"},
        {"no_list.ply", ply(xyz, "element face 1\nproperty int vertex_indices\n", points + "3\n"), "line 9",
         "no list of whole numbers 'vertex_indices'"},
        {"float_list.ply", ply(xyz, "element face 1\nproperty list uchar float vertex_indices\n", points + "3 0 1 2\n"),
         "line 9", "no list of whole numbers 'vertex_indices'"},
        {"strips.ply", ply(xyz, "element tristrips 1\nproperty list int int vertex_indices\n", points + "4 0 1 1 -1\n"),
         "", "its triangle strips contain no triangle"},
        {"strip_range.ply",
         ply(xyz, "element tristrips 1\nproperty list int int vertex_indices\n", points + "4 0 1 2 3\n"), "line 13",
         "vertex index 3 is out of range"},
        {"strip_negative.ply",
         ply(xyz, "element tristrips 1\nproperty list int int vertex_indices\n", points + "4 0 1 2 -2\n"), "line 13",
         "vertex index -2 is out of range"},
        {"faces.ply", ply(xyz, "element faces 1\nproperty list uchar int indices\n", points + "3 0 1 2\n"), "line 9",
         "no element 'face' but 'faces' with 'indices'"},
        {"vertices.ply", ply("element vertices 3\nproperty float x\n", list, ""), "line 7",
         "no element 'vertex' but 'vertices', 'face'"},
        {"corners.ply", ply(xyz, "element face 1\nproperty list uchar int corners\n", points + "3 0 1 2\n"), "line 9",
         "'vertex_indices' of the faces but 'corners'"},
        // PLY text rows
        {"huge_count.ply",
         ply("element vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\n", list, points),
         "line 10", "2,000,000,000 rows of element 'vertex' are declared but only 18 bytes follow"},
        {"huge_faces.ply",
         ply(xyz, "element face 18446744073709551615\nproperty list uchar int vertex_indices\n", points + "3 0 1 2\n"),
         "line 13", "rows of element 'face' are declared"},
        {"huge_other.ply", ply(xyz, list + "element other 99999999999\nproperty int a\n", points + "3 0 1 2\n1\n"),
         "line 16", "rows of element 'other' are declared"},
        {"token.ply", ply(xyz, list, "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n"), "line 11", "'zero' is not a number"},
        {"half_token.ply", ply(xyz, list, "0 0 0\n1 0 0x3\n0 1 0\n3 0 1 2\n"), "line 11", "'0x3' is not a number"},
        {"comma.ply", ply(xyz, list, "0 0 0\n1,5 0 0\n0 1 0\n3 0 1 2\n"), "line 11", "'1,5' is not a number"},
        {"index_token.ply", ply(xyz, list, points + "3 0 1 2.0\n"), "line 13", "'2.0' is not a whole number"},
        {"early_end.ply", ply(xyz, list, points + "3 0 1     "), "line 13", "ends early"},
        {"early_vertices.ply", ply(xyz, list, "0 0 0 \n  1 0 0\n0 1"), "line 12", "ends early"},
        {"too_many_values.ply", ply(xyz, list, "0 0 0 7\n1 0 0 7\n0 1 0 7\n3 0 1 2\n"), "line 10", "more values"},
        {"index_range.ply", ply(xyz, list, points + "3 0 1 3\n"), "line 13", "vertex index 3 is out of range"},
        {"index_negative.ply", ply(xyz, list, points + "3 0 -1 2\n"), "line 13", "vertex index -1 is out of range"},
        {"corners_negative.ply",
         ply(xyz, "element face 1\nproperty list int int vertex_indices\n", points + "-3 0 1 2\n"), "line 13",
         "of -3 items does not fit"},
        {"corners_huge.ply",
         ply(xyz, "element face 1\nproperty list int int vertex_indices\n", points + "2000000000 0 1 2\n"), "line 13",
         "of 2000000000 items does not fit"},
        {"corners_range.ply", ply(xyz, list, points + "300 0 1 2\n"), "line 13", "300 does not fit the type"},
        {"value_range.ply", ply(xyz + "property uchar red\n", list, "0 0 0 256\n1 0 0 0\n0 1 0 0\n3 0 1 2\n"),
         "line 11", "256 does not fit the type"},
        // PLY binary rows
        {"binary_huge.ply", huge_header + binary_points, byte_after(huge_header.size()),
         "2,000,000,000 rows of element 'vertex' take at least 12 bytes each but only 36 bytes follow"},
        {"binary_cut_vertices.ply", binary_header + binary_points.substr(0, 35), byte_after(body),
         "only 35 bytes follow"},
        {"binary_no_faces.ply", binary_header + binary_points, byte_after(body + 36), "only 0 bytes follow"},
        {"binary_cut_face.ply", binary_header + binary_points + packed(std::uint8_t(3), 0, 1), byte_after(body + 36),
         "of 3 items does not fit"},
        {"binary_cut_row.ply",
         "ply\nformat binary_little_endian 1.0\n" + xyz +
             "element face 2\nproperty list uchar int vertex_indices\nend_header\n" + binary_points +
             packed(std::uint8_t(1), 0),
         byte_after(body + 41), "row 1 of element 'face' is cut"},
        {"binary_index.ply", binary_header + binary_points + packed(std::uint8_t(3), 0, 1, 9),
         byte_after(body + 36 + 9), "vertex index 9 is out of range"},
        {"binary_negative_index.ply", binary_header + binary_points + packed(std::uint8_t(1), -1),
         byte_after(body + 37), "vertex index -1 is out of range"},
        {"binary_negative_corners.ply", signed_header + binary_points + packed(-3, 0, 1, 2),
         byte_after(signed_header.size() + 36), "of -3 items does not fit"},
        {"binary_huge_corners.ply", signed_header + binary_points + packed(2000000000, 0, 1, 2),
         byte_after(signed_header.size() + 36), "of 2000000000 items does not fit"},
        {"big_endian_corners.ply", big_endian_header + binary_points + packed(3, 0, 1, 2),
         byte_after(big_endian_header.size() + 36), "of 50331648 items does not fit"},
        // OFF
        {"keyword.off", "OFFX\n3 1 0\n", "line 1", "'OFFX' is not an OFF keyword"},
        {"only_keyword.off", "OFF\n", "line 2", "the number of vertices is missing"},
        {"dimension.off", "nOFF\n4\n3 1 0\n", "line 2", "dimension other than 3"},
        {"count_token.off", "OFF\nthree 1 0\n", "line 2", "'three' is not a whole number"},
        {"count_negative.off", "OFF\n-3 1 0\n" + points, "line 2", "negative"},
        {"count_huge.off", "OFF\n2000000000 1 0\n" + points, "line 2", "2,000,000,000 vertices"},
        {"count_huge_faces.off", "OFF\n3 2000000000 0\n" + points, "line 2", "2,000,000,000 faces"},
        {"count_overflow.off", "OFF\n99999999999999999999 1 0\n" + points, "line 2", "is not a whole number"},
        {"token.off", "OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", "line 4", "'x' is not a number"},
        {"early_vertices.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1         ", "line 5", "ends early"},
        {"early_faces.off", off, "line 6", "ends early"},
        {"early_face.off", off + "3 0 1     ", "line 6", "ends early"},
        {"corners_negative.off", off + "-3 0 1 2\n", "line 6", "negative"},
        {"corners_huge.off", off + "2000000000 0 1 2\n", "line 6", "2,000,000,000 corners does not fit"},
        {"index_range.off", off + "3 0 1 3\n", "line 6", "vertex index 3 is out of range"},
        {"index_negative.off", off + "3 0 -1 2\n", "line 6", "vertex index -1 is out of range"},
        {"index_fraction.off", off + "3 0 1 1.5\n", "line 6", "'1.5' is not a whole number"},
        {"face_color.off", off + "3 0 1 2 9 9\n", "line 6", "a colour of 2 numbers"},
        {"no_color.off", "COFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "line 3", "has no colour"},
        {"binary_counts.off", "OFF BINARY\n" + packed_reversed(3, 1), "byte 19", "the number of edges is missing"},
        {"binary_negative.off", "OFF BINARY\n" + packed_reversed(-3, 1, 0), "byte 23", "negative"},
        {"binary_huge.off", "OFF BINARY\n" + packed_reversed(2000000000, 1, 0), "byte 23", "2,000,000,000 vertices"},
        {"binary_corners.off",
         "OFF BINARY\n" + packed_reversed(1, 1, 0) + std::string(12, '\0') + packed_reversed(9, 0), "byte 39",
         "a face of 9 corners does not fit"},
        {"binary_index.off",
         "OFF BINARY\n" + packed_reversed(1, 1, 0) + std::string(12, '\0') + packed_reversed(1, 7, 0), "byte 43",
         "vertex index 7 is out of range"},
        // OBJ
        {"token.obj", "v 0 0 0\nv 1 o 0\n", "line 2", "'o' is not a number"},
        {"vertex_words.obj", "v 0 0\n", "line 1", "a vertex of 2 numbers"},
        {"vertex_many.obj", "v 0 0 0 1 1\n", "line 1", "a vertex of 5 numbers"},
        {"zero.obj", obj + "f 0 1 2\n", "line 4", "'0' is out of range"},
        {"range.obj", obj + "f 1 2 4\nf 1 2 3\n", "line 4", "index 4 is out of range: the file has 3 vertices"},
        {"negative_range.obj", obj + "f -1 -2 -4\n", "line 4", "'-4' is out of range"},
        {"huge_index.obj", obj + "f 1 2 99999999999999\n", "line 4", "'99999999999999' is out of range"},
        {"corner_word.obj", obj + "f 1 2 three\n", "line 4", "'three' is not a corner"},
        {"corner_slashes.obj", obj + "f 1/1/1/1 2 3\n", "line 4", "'1/1/1/1' is not a corner"},
        {"mark_before_v.obj", "v 0 0 0\n\xef\xbb\xbfv 1 0 0\n", "line 2", "'?\?\?v' is not an OBJ keyword"},
        {"byte_before_vn.obj", obj + "xvn 0 0 1\n", "line 4", "'xvn' is not an OBJ keyword"},
        {"no_blank_after_v.obj", "v0 0 0\n", "line 1", "'v0' is not an OBJ keyword"},
        {"no_blank_after_f.obj", obj + "f1 2 3\n", "line 4", "'f1' is not an OBJ keyword"},
        {"page.obj", "<html>\n<body>\n</html>\n", "line 1", "'<html>' is not an OBJ keyword"},
        {"glued_comment.obj", "v 0 0 0#1\n", "line 1", "'0#1' is not a number"},
        {"decimal_comma.obj", "v 0,5 0 0\n", "line 1", "a point before decimals"},
        {"corner_fraction.obj", obj + "f 1 2 3.5\n", "line 4", "'3.5' is not a corner"},
        // STL
        {"short.stl", "solid", "", "contains no facets"},
        {"padded.stl", "solid link" + std::string(70, ' '), "", "contains no facets"},
        {"empty_solid.stl", "solid link\nendsolid link\n", "", "contains no facets"},
        {"blanks.stl", " \n\t\n", "", "contains no facets"},
        {"page.stl", "<html>\nNot found\n</html>\n", "", "contains no facets, and a line begins with '<html>'"},
        {"count_unset.stl", stl_title + packed(-1), "", "contains no facets"},
        {"one_too_many.stl", stl_title + packed(3) + std::string(100, '\0'), "byte 80",
         "3 facets of 50 bytes are declared but only 100 bytes follow, which hold 2"},
        {"short_binary.stl", std::string(50, '\1'), "byte 50", "at least 84 bytes"},
        {"count_huge.stl", stl_title + packed(2000000000) + std::string(50, '\0'), "byte 80", "2,000,000,000 facets"},
        {"cut.stl", stl_title + packed(2) + std::string(99, '\0'), "byte 80", "only 99 bytes follow"},
        {"cut_solid.stl", "solid" + std::string(75, '\0') + packed(2) + std::string(99, '\0'), "byte 80",
         "only 99 bytes"},
        {"vertex_token.stl", solid + "vertex 0 one 0\n", "line 6", "'one' is not a number"},
        {"early.stl", solid + "vertex 0 1 0\nendloop\n", "line 8", "endfacet is missing"},
        {"keyword.stl", solid + "vortex 0 1 0\n", "line 6", "'vortex' found where 'vertex'"},
        {"lost_facet.stl", solid + "vertex 0 1 0\nendloop\nendfacet\nfazet\nouter loop\n", "line 10",
         "'outer' found where 'facet'"},
        {"no_outer.stl", "solid\nfacet normal 0 0 1\nloop\nvertex 0 0 0\n", "line 3", "'loop' found where 'outer'"},
    };
}

class Malformed : public ScratchFiles, public testing::WithParamInterface<Damage> {};

}

TEST_P(Malformed, IsRefusedInOneLineThatNamesThePlace) {
    const Damage& damage = GetParam();
    try {
        read(damage.name, damage.bytes);
        FAIL() << "was read";
    } catch (const InputError& error) {
        const std::string message = error.what();
        const std::string prefix =
            path(damage.name).string() + ": " + (damage.place.empty() ? "" : damage.place + ": ");
        EXPECT_TRUE(message.starts_with(prefix)) << message;
        EXPECT_NE(message.find(damage.words), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

INSTANTIATE_TEST_SUITE_P(Files, Malformed, testing::ValuesIn(damages()), [](const auto& test) {
    std::string name = test.param.name;
    std::replace(name.begin(), name.end(), '.', '_');
    return name;
});

using Unreadable = ScratchFiles;

TEST_F(Unreadable, AFolderAndAMissingFileAreNamed) {
    std::filesystem::create_directory(path("folder.stl"));
    try {
        read_mesh(path("folder.stl"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("folder.stl: is a folder"), std::string::npos);
    }
    EXPECT_THROW(read_mesh("/dev/zero"), InputError);
    EXPECT_THROW(read_mesh("/proc/self/mem"), InputError); // it cannot be read, though it is a regular file
    try {
        read_mesh(path("none.ply"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("none.ply: cannot be opened: No such file"), std::string::npos);
    }
}

namespace {

std::vector<std::pair<std::string, std::string>> sound_files() {
    using u8 = std::uint8_t;
    const std::string rich = xyz +
                             "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
                             "property uchar green\nproperty uchar blue\nproperty list ushort short marks\n"
                             "property float s\nproperty float t\n" +
                             list + "property list uchar float texcoord\nproperty char flag\nend_header\n";
    const auto rows = [](auto pack) {
        std::string bytes;
        for (int v = 0; v < 3; ++v)
            bytes += pack(float(v == 1), float(v == 2), 0.f, 0.f, 0.f, 1.f, u8(1), u8(2), u8(3), std::uint16_t(v)) +
                     (v > 0 ? pack(std::int16_t(7)) : "") + (v > 1 ? pack(std::int16_t(-7)) : "") + pack(0.5f, 0.5f);
        return bytes + pack(u8(3), 0, 1, 2, u8(6), 0.f, 1.f, 2.f, 3.f, 4.f, 5.f, std::int8_t(-1));
    };
    return {
        {"a.ply", "ply\nformat ascii 1.0\ncomment c\n" + rich +
                      "0 0 0 0 0 1 1 2 3 0 .5 .5\n1 0 0 0 0 1 1 2 3 1 7 .5 .5\n"
                      "0 1 0 0 0 1 1 2 3 2 7 -7 .5 .5\n3 0 1 2 6 0 1 2 3 4 5 -1\n"},
        {"l.ply", "ply\nformat binary_little_endian 1.0\n" + rich + rows([](auto... v) { return packed(v...); })},
        {"b.ply", "ply\nformat binary_big_endian 1.0\n" + rich + rows([](auto... v) { return packed_reversed(v...); })},
        {"plain.ply", binary_header + binary_points + packed(u8(3), 0, 1, 2)},
        {"a.off", "# c\nSTCNOFF\n3 2 0\n0 0 0 0 0 1 255 0 0 128 0 1\n1 0 0 0 0 1 0 10 0 255 .5 1\n"
                  "0 1 .5 3 4 0 0 0 77 0 1 .25\n3 0 1 2 1 2 3\n4 0 1 2 0\n"},
        {"b.off", "COFF BINARY\n" + packed_reversed(1, 2, 0, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f) +
                      packed_reversed(3, 0, 0, 0, 0, 2, 0, 0, 3, 0.f, 1.f, 0.f)},
        {"a.obj", "# c\nmtllib a.mtl\n" + obj +
                      "v 0 0 1 .5 .5 1\nvt 0 0\nvt 1 1 0\nvn 0 0 1\ng a\nusemtl m\n"
                      "f 1/1/1 2/2/1 -2/-1/-1\nf 1//1 \\\n 2//1 3//1\nl 1 2\nf 1 2 3 4\n"},
        {"a.stl", solid + "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
        {"b.stl", stl_title + packed(1) + std::string(50, '\0')},
    };
}

/// Bytes that affect a parser more often than random ones do.
constexpr std::string_view steering = "\n\r\t -+./0129eEnif#\\\x00\x7f\x80\xff";

class Mutated : public ScratchFiles, public testing::WithParamInterface<std::size_t> {
  protected:
    /// Reads the file and, if that succeeds, writes it in both formats. Exceptions other than InputError fail the test.
    void survive(const std::string& name, const std::string& bytes) {
        try {
            Mesh mesh = read_bytes(FileBytes(name, bytes));
            EXPECT_LE(mesh.vertex_count(), bytes.size());
            EXPECT_EQ(mesh.face_begin.back(), mesh.corners.size());
            for (const std::uint32_t corner : mesh.corners)
                EXPECT_LT(corner, mesh.vertex_count());
            mesh.set_attribute({"ao", 1, std::vector<float>(mesh.vertex_count())});
            mesh.added_colors.resize(mesh.vertex_count());
            write_mesh(mesh, path("out.ply"));
            write_mesh(mesh, path("out.obj"));
            EXPECT_EQ(read_mesh(path("out.ply")).corners, mesh.corners);
            EXPECT_EQ(read_mesh(path("out.obj")).vertex_count(), mesh.vertex_count());
        } catch (const InputError& error) {
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
        }
    }
};

}

TEST_P(Mutated, FilesAreReadOrRefused) {
    const auto [name, sound] = sound_files()[GetParam()];
    ASSERT_NO_THROW(read(name, sound));
    for (std::size_t length = 0; length < sound.size(); ++length)
        survive(name, sound.substr(0, length));
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    const auto below = [&random](std::size_t bound) { return random() % bound; };
    for (int round = 0; round < 600; ++round) {
        std::string bytes = sound;
        for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
            const std::size_t at = below(bytes.size());
            switch (below(4)) {
            case 0:
                bytes[at] = static_cast<char>(below(256));
                break;
            case 1:
                bytes[at] = steering[below(steering.size())];
                break;
            case 2:
                bytes.insert(at, 1, steering[below(steering.size())]);
                break;
            default:
                bytes.erase(at, 1 + below(4));
            }
        }
        SCOPED_TRACE(testing::Message() << name << " round " << round);
        survive(name, bytes);
        if (HasFailure())
            break;
    }
}

INSTANTIATE_TEST_SUITE_P(Files, Mutated, testing::Range(std::size_t(0), sound_files().size()));
