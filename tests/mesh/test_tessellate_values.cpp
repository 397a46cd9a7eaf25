#include "alcove/mesh/detail/tessellate.h"

#include "scratch_files.h"

#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/formats/ply/ply_document.h"

#include <cmath>

using namespace alcove;
using TessellateValues = ScratchFiles;

namespace {

Mesh quad(const Vec2& size) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {size.x, 0, 0}, {size.x, size.y, 0}, {0, size.y, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    return mesh;
}

bool mentions(const std::vector<std::string>& lines, std::string_view text) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

double number(const PlyElement& element, std::string_view name, std::size_t row) {
    const std::byte* at = element.rows.data() + row * element.smallest_row();
    for (const PlyProperty& property : element.properties) {
        if (property.name == name)
            return number_at(at, property.type);
        at += size_of(property.type);
    }
    throw std::out_of_range(std::string(name));
}

}

TEST_F(TessellateValues, OfVerticesAreInterpolated) {
    Mesh mesh = quad({1, 1});
    mesh.vertex_uvs = {{0, 0}, {4, 0}, {4, 8}, {0, 8}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}};
    mesh.vertex_colors = {{0, 0, 0, 255}, {255, 0, 0, 255}, {255, 100, 0, 255}, {0, 100, 0, 255}};
    mesh.set_attribute({"height", 1, {0, 0, 5, 5}});
    mesh.set_attribute({"place", 3, {0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1}});
    const Mesh result = tessellate(mesh, {.longest = 0.1});
    const std::vector<float>& place = result.find_attribute("place")->values;
    ASSERT_EQ(place.size(), 3 * result.vertex_count());
    for (std::size_t v = 0; v < result.vertex_count(); ++v) {
        const Vec2 p(result.positions[v]);
        EXPECT_EQ(result.vertex_uvs[v], Vec2(4, 8) * p);
        EXPECT_EQ(Vec3(place[3 * v], place[3 * v + 1], place[3 * v + 2]), Vec3(p, 1));
        EXPECT_EQ(result.find_attribute("height")->values[v], 5 * p.y);
        EXPECT_EQ(result.vertex_colors[v][0], std::lround(255 * p.x));
        EXPECT_EQ(result.vertex_colors[v][1], std::lround(100 * p.y));
        EXPECT_EQ(result.vertex_colors[v][3], 255);
        if (v != 3) {
            EXPECT_NEAR(glm::length(result.normals[v]), 1.0, 1e-6);
        }
        if (p.y == 0.0f) {
            EXPECT_EQ(result.normals[v], Vec3(0, 0, 1));
        }
        if (p.x == 1.0f && p.y == 0.5f) {
            EXPECT_LE(glm::length(result.normals[v] - glm::normalize(Vec3(1, 0, 1))), 1e-6f);
        }
    }
}

TEST_F(TessellateValues, OfOtherVerticesDoNotSpoilAnEdge) {
    Mesh mesh = quad({1, 1});
    mesh.set_attribute({"value", 1, {1, 1, 1, NAN}});
    const Mesh result = tessellate(mesh, {.longest = 0.6});
    for (std::size_t v = 0; v < result.vertex_count(); ++v)
        if (result.positions[v].x == 1.0 || result.positions[v].y == 0.0) {
            EXPECT_EQ(result.find_attribute("value")->values[v], 1.0f);
        }
}

TEST_F(TessellateValues, OfCornersStayApartAcrossASeam) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    mesh.add_face(std::vector<std::uint32_t>{1, 4, 5, 2});
    // The right face is elsewhere in the texture, and mirrored.
    mesh.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {9, 0}, {8, 0}, {8, 1}, {9, 1}};
    const Mesh result = tessellate(mesh, {.longest = 0.3});
    ASSERT_EQ(result.corner_uvs.size(), result.corners.size());
    std::size_t left = 0;
    for (std::size_t f = 0; f < result.face_count(); ++f) {
        Vec3d centre(0.0);
        for (const std::uint32_t v : result.face(f))
            centre += result.positions[v] / 3.0;
        left += centre.x < 1.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 p(result.positions[result.face(f)[k]]);
            EXPECT_EQ(result.corner_uvs[result.face_begin[f] + k], centre.x < 1.0 ? p : Vec2(10 - p.x, p.y));
        }
    }
    EXPECT_EQ(2 * left, result.face_count());
    EXPECT_EQ(diagnose(result).coincident_vertices, 0u);
}

TEST_F(TessellateValues, OfAPlyFileAreKept) {
    const std::string header = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 6\nproperty float x\n"
                               "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
                               "property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                               "property short confidence\nproperty double heat\n"
                               "element camera 1\nproperty list uchar short marks\n"
                               "element face 2\nproperty uchar group\nproperty list uchar uchar vertex_indices\n"
                               "property list uchar float texcoord\nproperty list uchar int notes\nend_header\n";
    const std::string rows = "0 0 0 0 0 2 0 0 0 -5 0.25\n4 0 0 0 0 2 255 0 0 8 1\n4 4 0 0 0 2 255 9 0 8 1\n"
                             "0 4 0 0 0 2 0 9 0 -5 0.25\n5 0 0 0 0 2 0 0 0 0 0\n5 4 0 0 0 2 0 0 0 0 0\n"
                             "2 7 8\n"
                             "17 4 0 1 2 3 8 0 0 1 0 1 1 0 1 1 42\n"
                             "18 3 1 4 2 6 1 0 1.25 0 1 1 0\n";
    const Mesh mesh = read("in.ply", header + rows);
    const Mesh result = tessellate(mesh, {.longest = 0.2});
    EXPECT_EQ(result.warnings, mesh.warnings);
    EXPECT_TRUE(write_mesh(result, path("out.ply")).empty());
    EXPECT_NE(header_of("out.ply").find("comment by hand\n"), std::string::npos);

    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_EQ(again.positions, result.positions); // exact as float
    EXPECT_EQ(again.corners, result.corners);
    EXPECT_EQ(again.corner_uvs, result.corner_uvs);
    EXPECT_EQ(again.vertex_colors, result.vertex_colors);
    const auto& document = dynamic_cast<const PlyDocument&>(*again.source);
    const PlyElement& vertices = *document.find("vertex");
    EXPECT_EQ(vertices.find("confidence")->type, PlyType::int16);
    for (std::size_t v = 0; v < again.vertex_count(); ++v) {
        const double x = again.positions[v].x / 4.0;
        if (x <= 1.0 && v != 4 && v != 5) {
            EXPECT_EQ(number(vertices, "heat", v), 0.25 + 0.75 * x);
            EXPECT_EQ(number(vertices, "confidence", v), std::round(-5.0 + 13.0 * x));
        }
        EXPECT_EQ(number(vertices, "nz", v), v < 6 ? 2.0 : 1.0);
    }
    EXPECT_EQ(document.find("camera")->rows.size(), 5u);
    const PlyElement& faces = *document.find("face");
    EXPECT_EQ(faces.find("vertex_indices")->type, again.vertex_count() > 256 ? PlyType::int32 : PlyType::uint8);
    EXPECT_GT(again.vertex_count(), 256u);
    const auto* group = reinterpret_cast<const unsigned char*>(faces.rows.data());
    EXPECT_EQ(group[0], 17);
}

TEST_F(TessellateValues, OfAPlyFileWithWholeCoordinates) {
    const Mesh mesh = read("in.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty list uchar uchar tags\n"
                                     "property short x\nproperty short y\nproperty short z\nelement face 1\n"
                                     "property list uchar int vertex_index\nend_header\n"
                                     "2 1 2 0 0 0\n0 1 0 0\n1 3 0 1 0\n3 0 1 2\n");
    write_mesh(tessellate(mesh, {.longest = 0.3}), path("out.ply"));
    const Mesh again = read_mesh(path("out.ply"));
    EXPECT_EQ(again.positions, tessellate(mesh, {.longest = 0.3}).positions);
    const PlyElement& vertices = *dynamic_cast<const PlyDocument&>(*again.source).find("vertex");
    EXPECT_EQ(vertices.find("x")->type, PlyType::float64);
    EXPECT_TRUE(vertices.find("tags")->count_type);
}

TEST_F(TessellateValues, OfAnUnsplitFileAreByteForByteTheSame) {
    const Mesh mesh = quad({1, 1});
    write_mesh(mesh, path("in.ply"));
    write_mesh(tessellate(read_mesh(path("in.ply")), {.longest = 1}), path("out.ply"));
    EXPECT_EQ(bytes_of("out.ply"), bytes_of("in.ply"));
}

TEST_F(TessellateValues, OfAnObjFileThatAreLostAreNamed) {
    const Mesh mesh = read("in.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl red\n"
                                     "f 1/1 2/2 3/3\n");
    const Mesh result = tessellate(mesh, {.longest = 0.6});
    EXPECT_TRUE(mentions(result.warnings, "1 'usemtl' line"));
    EXPECT_TRUE(mentions(result.warnings, "1 'mtllib' line"));
    EXPECT_TRUE(write_mesh(result, path("out.obj")).empty());
    const Mesh again = read_mesh(path("out.obj"));
    EXPECT_EQ(again.positions, result.positions);
    EXPECT_EQ(again.vertex_uvs, result.vertex_uvs);
    EXPECT_EQ(again.corners, result.corners);
    EXPECT_EQ(tessellate(mesh, {.longest = 2}).warnings, mesh.warnings);
}
