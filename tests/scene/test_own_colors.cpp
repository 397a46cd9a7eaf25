/// Meshes drawn in their own colours.
#include "scene_text.h"

#include "alcove/scene/scene.h"
#include "shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace alcove::test {
namespace {

/// Linear light of an sRGB value, from the definition in IEC 61966-2-1.
double linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// An open square of side 2 in the plane z = 0, of four triangles around the origin, as the rows of a PLY.
std::string square_ply(const std::string& vertex_properties, const std::string& face_properties,
                       const std::function<std::string(int)>& of_vertex,
                       const std::function<std::string(int)>& of_face) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n" +
        vertex_properties + "element face 4\nproperty list uchar int vertex_indices\n" + face_properties +
        "end_header\n";
    const char* const corners[] = {"-1 -1 0", "1 -1 0", "1 1 0", "-1 1 0", "0 0 0"};
    for (int v = 0; v < 5; ++v)
        text += fmt::format("{} {}\n", corners[v], of_vertex(v));
    for (int f = 0; f < 4; ++f)
        text += fmt::format("3 {} {} 4 {}\n", f, (f + 1) % 4, of_face(f));
    return text;
}

const std::string uchar_colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

std::string nothing(int) {
    return "";
}

/// Files in a temporary folder, drawn from the front under a white sky that lights every point alike.
class OwnColorsPicture : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }

    struct Drawn {
        Image image;
        std::vector<std::string> warnings;

        /// The colour at a point of the square.
        Vec3 at(double x, double y) const {
            const auto column = static_cast<std::size_t>(32.0 + 24.0 * x),
                       row = static_cast<std::size_t>(32.0 - 24.0 * y);
            return image.color[row * 64 + column];
        }
        bool warns(const std::string& part) const {
            return std::any_of(warnings.begin(), warnings.end(),
                               [&](const std::string& w) { return w.find(part) != std::string::npos; });
        }
    };

    /// The picture shows the colours of the surface.
    static Drawn draw(Scene scene, int samples = 1) {
        scene.ground.reset();
        scene.size = {64, 64};
        scene.samples = samples;
        scene.camera.eye = Vec3d(0, 0, 4);
        scene.camera.look_at = Vec3d(0);
        scene.camera.fov = 2.0 * std::atan(32.0 / 24.0 / 4.0) * 180.0 / 3.14159265358979;
        scene.light.sun = scene.light.bounce = Vec3(0.0f);
        scene.light.sky = Vec3(1.0f);
        scene.occlusion.choose("none");
        scene.occlusion.use = OcclusionUse::ambient;
        const PassSet passes = Pass::beauty | Pass::object;
        const BuiltScene built = build_scene(scene, passes);
        const Camera camera = make_camera(scene.camera, built.points, scene.size);
        return {render(built.renderable, camera, rendering_of(scene, built, camera, passes)), built.warnings};
    }
    Drawn draw_file(const std::string& name, const std::string& text) const {
        return draw(scene_of(write(name, text)));
    }

    static void expect_color(const Vec3& color, const Vec3d& expected) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(double(color[c]), expected[c], 2e-3) << "channel " << c;
    }

    const ScratchFolder folder_;
};

TEST_F(OwnColorsPicture, VertexColoursAreShownAsTheLightTheyEncode) {
    const Drawn red = draw_file("a.ply", square_ply(
                                             uchar_colors, "", [](int) { return "255 0 0"; }, nothing));
    expect_color(red.at(0.5, 0.1), {1, 0, 0});
    EXPECT_TRUE(red.warnings.empty());
    const Drawn mixed = draw_file("b.ply", square_ply(
                                               uchar_colors, "", [](int) { return "51 102 204"; }, nothing));
    expect_color(mixed.at(-0.5, 0.2), {linear(0.2), linear(0.4), linear(0.8)});
    // Black at the left, white at the right: interpolated in linear light.
    const Drawn ramp = draw_file("c.ply", square_ply(
                                              uchar_colors, "",
                                              [](int v) {
                                                  const double share = v == 4 ? 0.5 : v == 1 || v == 2 ? 1.0 : 0.0;
                                                  const int byte = share == 0.5 ? 188 : static_cast<int>(255 * share);
                                                  return fmt::format("{0} {0} {0}", byte);
                                              },
                                              nothing));
    EXPECT_NEAR(double(ramp.at(0.5, 0.0).x), 0.75, 0.03);
    EXPECT_NEAR(double(ramp.at(-0.5, 0.0).x), 0.25, 0.03);
}

TEST_F(OwnColorsPicture, FacesHaveTheirOwnColoursUpToTheirEdges) {
    const char* const colors[] = {"255 0 0", "0 255 0", "0 0 255", "255 255 0"}; // below, right, above, left
    for (const bool own_normals : {true, false}) {
        Scene scene = scene_of(write("a.ply", square_ply("", uchar_colors, nothing, [&](int f) { return colors[f]; })));
        std::get<MeshShape>(scene.objects.front().shape).own_normals = own_normals;
        const Drawn drawn = draw(scene);
        expect_color(drawn.at(0.0, -0.5), {1, 0, 0});
        expect_color(drawn.at(0.5, 0.0), {0, 1, 0});
        expect_color(drawn.at(0.2, 0.3), {0, 0, 1});
        expect_color(drawn.at(-0.3, 0.2), {1, 1, 0});
    }
}

/// Each polygon of an OFF has a colour; a face without a triangle must not shift those after it.
TEST_F(OwnColorsPicture, ColoursOfPolygonsFollowTheirTriangles) {
    const Drawn drawn = draw_file("a.off", "OFF\n6 4 0\n-1 -1 0\n0 -1 0\n1 -1 0\n1 1 0\n0 1 0\n-1 1 0\n"
                                           "4 0 1 4 5 255 0 0\n2 0 1 0 255 0\n3 0 0 1 0 255 0\n4 1 2 3 4 0 0 255\n");
    expect_color(drawn.at(-0.5, 0.3), {1, 0, 0});
    expect_color(drawn.at(0.5, 0.3), {0, 0, 1});
    expect_color(drawn.at(0.5, -0.7), {0, 0, 1});
}

const std::string square_obj = "v -1 -1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\nv -1 1 0\n";

TEST_F(OwnColorsPicture, MaterialsOfAnObjGiveTheirKd) {
    write("skin/a.mtl",
          "\xef\xbb\xbf# colours\r\nnewmtl dark #1 red\r\n\tkd 0.5 0 0\r\nKs 1 1 1\r\nnewmtl blue\r\nKd 0 0 1\r\n"
          "newmtl blue\r\nKd 1 1 1\r\nnewmtl grey\r\nKd 0.2\r\n");
    const std::string faces = "usemtl dark #1 red\nf 1 2 5 6\nusemtl blue\nf 2 3 4 5\n";
    for (const std::string line :
         {"mtllib skin/a.mtl", "mtllib skin\\a.mtl", "mtllib \"skin/a.mtl\"", "mtllib b.mtl skin/a.mtl"}) {
        write("b.mtl", "newmtl other\nKd 1 1 1\n");
        const Drawn drawn = draw_file("a.obj", line + "\n" + square_obj + faces);
        expect_color(drawn.at(-0.5, 0.3), {linear(0.5), 0, 0});
        expect_color(drawn.at(0.5, 0.3), {0, 0, 1});
        EXPECT_TRUE(drawn.warnings.empty()) << drawn.warnings.front();
    }
    write("my model.mtl", "newmtl grey\nKd 0.2\n");
    const Drawn grey =
        draw_file("b.obj", "mtllib elsewhere/my model.mtl\n" + square_obj + "f 1 2 5 6\nusemtl grey\nf 2 3 4 5\n");
    expect_color(grey.at(-0.5, 0.3), Vec3d(0.8)); // no material yet
    expect_color(grey.at(0.5, 0.3), Vec3d(linear(0.2)));
}

TEST_F(OwnColorsPicture, WhatAMaterialFileLacksIsAWarning) {
    const std::string faces = square_obj + "usemtl a\nf 1 2 5 6\nusemtl b\nf 2 3 4 5\n";
    const Drawn lost = draw_file("lost.obj", "mtllib lost.mtl\n" + faces);
    expect_color(lost.at(0.5, 0.3), Vec3d(0.8));
    EXPECT_TRUE(lost.warns("'lost.mtl' is missing"));
    EXPECT_EQ(lost.warnings.size(), 1u);
    const Drawn none = draw_file("none.obj", faces);
    EXPECT_TRUE(none.warns("2 materials have no colour (Kd)"));
    write("wide.mtl", std::string("\xff\xfen\0e\0w\0", 8));
    EXPECT_TRUE(draw_file("wide.obj", "mtllib wide.mtl\n" + faces).warns("UTF-16"));
    write("broken.mtl", "Kd 1 0 0\nnewmtl a\nKd red\nnewmtl\nKd\nnewmtl b\nKd spectral b.rfl\nKd nan 0 0\n\\\n");
    EXPECT_TRUE(draw_file("broken.obj", "mtllib broken.mtl\n" + faces).warns("2 materials have no colour (Kd)"));
    write("textured.mtl",
          "newmtl a\nKd 0 1 0\nmap_Kd a.png\nmap_bump n.png\nd 0.5\nnewmtl b\nKd 0 1 0\nmap_Kd -s 2 2 2 b.png\n"
          "Tr 0.25\nKe 1 1 0\nnewmtl unused\nmap_Kd c.png\n");
    const Drawn textured = draw_file("textured.obj", "mtllib textured.mtl\n" + faces);
    expect_color(textured.at(0.5, 0.3), {0, 1, 0});
    ASSERT_EQ(textured.warnings.size(), 1u);
    EXPECT_TRUE(
        textured.warns("3 textures (map_Kd, map_bump), the transparency of 2 materials, the light of 1 material"));
}

TEST_F(OwnColorsPicture, ColoursOfVerticesComeBeforeThoseOfFaces) {
    const Drawn drawn = draw_file(
        "a.ply", square_ply(
                     uchar_colors, uchar_colors, [](int) { return "255 0 0"; }, [](int) { return "0 0 255"; }));
    expect_color(drawn.at(0.5, 0.1), {1, 0, 0});
    EXPECT_TRUE(drawn.warns("colours of the faces are not shown"));
    const Drawn clear = draw_file("b.ply", square_ply(
                                               uchar_colors + "property uchar alpha\n", "",
                                               [](int v) { return v == 0 ? "255 0 0 7" : "255 0 0 255"; }, nothing));
    expect_color(clear.at(0.5, 0.1), {1, 0, 0});
    EXPECT_TRUE(clear.warns("the alpha of 1 colour is not shown"));
}

TEST_F(OwnColorsPicture, TheAoOfAnEarlierBakeIsNotAColour) {
    const auto ply = [](const std::string& comment, const std::string& more, const std::string& color) {
        std::string text = square_ply(
            uchar_colors + more, "", [&](int) { return color + (more.empty() ? "" : " 0.2"); }, nothing);
        return text.insert(text.find("element"), comment);
    };
    const std::string provenance = "comment alcove 0.2.0: ao by guided:16, radius 1, voxel 0.01\n";
    const std::string quality = "property float quality\n";
    const Drawn baked = draw_file("a.ply", ply(provenance, quality, "51 51 51"));
    expect_color(baked.at(0.5, 0.1), Vec3d(0.8));
    EXPECT_TRUE(baked.warns("ao of an earlier bake"));
    // Colours that the bake kept, and greys of another program.
    expect_color(draw_file("b.ply", ply(provenance, quality, "51 51 52")).at(0.5, 0.1),
                 {linear(0.2), linear(0.2), linear(52.0 / 255.0)});
    expect_color(draw_file("c.ply", ply(provenance, "", "51 51 51")).at(0.5, 0.1), Vec3d(linear(0.2)));
    expect_color(draw_file("d.ply", ply("comment other\n", quality, "51 51 51")).at(0.5, 0.1), Vec3d(linear(0.2)));
}

TEST_F(OwnColorsPicture, ASceneFileSaysWhetherTheyAreShown) {
    write("a.ply", square_ply(
                       uchar_colors, "", [](int) { return "255 0 0"; }, nothing));
    const auto draw_scene = [&](const std::string& more) {
        return draw(read_scene(write("scene.toml", "[material.green]\ncolor = [0, 1, 0]\n[[object]]\nshape = \"mesh\"\n"
                                                   "file = \"a.ply\"\n" +
                                                       more)));
    };
    const Drawn unsaid = draw_scene("");
    expect_color(unsaid.at(0.5, 0.1), Vec3d(0.8));
    EXPECT_TRUE(unsaid.warns("color = \"own\""));
    const Drawn green = draw_scene("material = \"green\"\n");
    expect_color(green.at(0.5, 0.1), {0, 1, 0});
    EXPECT_TRUE(green.warnings.empty());
    expect_color(draw_scene("material = \"green\"\ncolor = \"own\"\n").at(0.5, 0.1), {1, 0, 0});
    EXPECT_TRUE(draw_scene("color = \"none\"\n").warnings.empty());
    EXPECT_TRUE(draw_scene("painted = true\n").warnings.empty());
    // The same vertex colour is the colour of the surface and, as brightness, multiplies the ao.
    expect_color(draw_scene("painted = true\ncolor = \"own\"\n").at(0.5, 0.1), {1.0 / 3.0, 0, 0});
}

/// A folded sheet of red faces.
std::string folds_off() {
    constexpr int n = 24;
    std::string text = fmt::format("OFF\n{} {} 0\n", (n + 1) * (n + 1), n * n);
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
            const double u = 2.0 * x / n - 1.0, v = 2.0 * y / n - 1.0;
            text += fmt::format("{} {} {}\n", u, v, 0.4 * std::sin(8.0 * u) * std::cos(5.0 * v));
        }
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const int first = y * (n + 1) + x;
            text += fmt::format("4 {} {} {} {} 255 0 0\n", first, first + 1, first + n + 2, first + n + 1);
        }
    return text;
}

/// Where a ray meets the field but no triangle, as at some outlines, the colour is still that of the mesh.
TEST_F(OwnColorsPicture, OutlinesHaveThemToo) {
    for (const bool own_normals : {true, false})
        for (const char* const voxel : {"0.4%", "5%"}) {
            Scene scene = scene_of(write("a.off", folds_off()));
            auto& mesh = std::get<MeshShape>(scene.objects.front().shape);
            mesh.voxel = Length(voxel);
            mesh.own_normals = own_normals;
            scene.objects.front().placement.rotation = {55, 20, 0};
            const Drawn drawn = draw(scene, 16);
            int seen = 0;
            for (std::size_t i = 0; i < drawn.image.pixels(); ++i) {
                seen += drawn.image.alpha[i] > 0.0f;
                EXPECT_NEAR(drawn.image.color[i].x, drawn.image.alpha[i], 1e-5f);
                EXPECT_EQ(drawn.image.color[i].y, 0.0f) << i % 64 << ", " << i / 64;
            }
            EXPECT_GT(seen, 1000);
        }
}

}
}
