#include "scene_text.h"

#include "alcove/base/types.h"

namespace alcove::test {
namespace {

const char* const ball = "[[object]]\nshape = \"sphere\"\n";

/// The message of the InputError when reading the scene.
std::string refusal(const std::string& text) {
    try {
        scene_from(text);
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "read without an error: " << text;
    return {};
}

void expect_refusal(const std::string& text, std::initializer_list<const char*> parts) {
    const std::string said = refusal(text);
    for (const char* part : parts)
        EXPECT_NE(said.find(part), std::string::npos) << said << "\ndoes not contain: " << part;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

TEST(SceneFile, HoldsEveryShape) {
    const SceneText text(R"(
[[object]]
shape = "sphere"
center = [1, 2, 3]
radius = 4

[[object]]
shape = "box"
name = "crate"
size = [1, 2, 3]
translate = [0, 1, 0]
rotate = [0, 90, 0]
scale = 2.5

[[object]]
shape = "torus"
ring = 3
tube = 0.5

[[object]]
shape = "capsule"
start = [1, 0, 0]
end = [2, 0, 0]
radius = 0.1

[[object]]
shape = "plane"
point = [0, -1, 0]
normal = [0, 2, 0]

[[object]]
shape = "mesh"
file = "a/scan.ply"
voxel = "0.5%"
sign = "sheet"
normals = "field"
painted = true

[[object]]
shape = "vdb"
file = "/b/grid.vdb"

[[object]]
shape = "difference"
blend = 0.25
part = [{ shape = "sphere" }, { shape = "union", part = [{ shape = "plane" }] }]
)");
    const Scene scene = read_scene(text.file());
    ASSERT_EQ(scene.objects.size(), 8u);
    const auto& sphere = std::get<SphereShape>(scene.objects[0].shape);
    EXPECT_EQ(sphere.center, Vec3d(1, 2, 3));
    EXPECT_EQ(sphere.radius, 4.0);
    EXPECT_EQ(scene.objects[0].name, "object 1 (sphere)");
    EXPECT_EQ(scene.objects[1].name, "crate");
    EXPECT_EQ(std::get<BoxShape>(scene.objects[1].shape).size, Vec3d(1, 2, 3));
    EXPECT_EQ(scene.objects[1].placement.translation, Vec3d(0, 1, 0));
    EXPECT_EQ(scene.objects[1].placement.rotation, Vec3d(0, 90, 0));
    EXPECT_EQ(scene.objects[1].placement.scale, 2.5);
    EXPECT_EQ(std::get<TorusShape>(scene.objects[2].shape).ring, 3.0);
    EXPECT_EQ(std::get<CapsuleShape>(scene.objects[3].shape).end, Vec3d(2, 0, 0));
    EXPECT_EQ(std::get<PlaneShape>(scene.objects[4].shape).normal, Vec3d(0, 2, 0));
    const auto& mesh = std::get<MeshShape>(scene.objects[5].shape);
    EXPECT_EQ(mesh.file, text.folder() / "a/scan.ply");
    ASSERT_TRUE(mesh.voxel);
    EXPECT_EQ(mesh.voxel->value, 0.005);
    EXPECT_EQ(mesh.sign, SignChoice::sheet);
    EXPECT_TRUE(!mesh.own_normals && mesh.painted);
    EXPECT_EQ(std::get<GridShape>(scene.objects[6].shape).file, "/b/grid.vdb");
    const auto& cut = std::get<CompositeShape>(scene.objects[7].shape);
    EXPECT_EQ(cut.operation, CompositeShape::Operation::subtract);
    EXPECT_EQ(cut.blend, 0.25);
    ASSERT_EQ(cut.parts.size(), 2u);
    EXPECT_EQ(std::get<CompositeShape>(cut.parts[1].shape).operation, CompositeShape::Operation::unite);
    EXPECT_EQ(cut.parts[1].name, "object 8 (difference), part 2 (union)");
}

TEST(SceneFile, HoldsLightCameraAndOcclusion) {
    const Scene scene = scene_from(R"(
[image]
width = 320
height = 200
samples = 9
[camera]
eye = [1, 2, 3]
look_at = [0, 0, 0.5]
up = [0, 0, 1]
fov = 25
[occlusion]
method = "hemisphere"
radius = "20%"
samples = 16
light = "everything"
far_samples = 4
far = 30
[sun]
direction = [0, 2, 0]
color = [3, 2, 1]
sharpness = 12
[sky]
color = 0.5
bounce = [0, 0, 0.25]
[ground]
height = -2
material = "clay"
[material.clay]
color = [0.7, 0.5, 0.25]
edge_color = 1
subsurface = 0.125
reflection = 0.5
occlusion = 0.75
)" + std::string(ball));
    EXPECT_EQ(scene.size.width, 320);
    EXPECT_EQ(scene.size.height, 200);
    EXPECT_EQ(scene.samples, 9);
    EXPECT_EQ(scene.camera.eye, Vec3d(1, 2, 3));
    EXPECT_EQ(scene.camera.look_at, Vec3d(0, 0, 0.5));
    EXPECT_EQ(scene.camera.up, Vec3d(0, 0, 1));
    EXPECT_EQ(scene.camera.fov, 25.0);
    EXPECT_EQ(scene.occlusion.method->name, "hemisphere");
    EXPECT_EQ(scene.occlusion.radius.value, 0.2);
    EXPECT_EQ(scene.occlusion.radius.unit, Length::Unit::diagonal);
    EXPECT_EQ(scene.occlusion.parameters, (std::vector<std::pair<std::string, double>>{{"samples", 16.0}}));
    EXPECT_EQ(scene.occlusion.use, OcclusionUse::everything);
    EXPECT_EQ(scene.occlusion.far_samples, 4);
    EXPECT_EQ(scene.occlusion.far, 30.0);
    EXPECT_TRUE(scene.light.casts_shadow);
    EXPECT_EQ(scene.light.shadow.sharpness, 12.0f);
    EXPECT_FALSE(scene_from("[sun]\nshadow = false\n").light.casts_shadow);
    EXPECT_EQ(scene.light.toward_sun, Vec3d(0, 2, 0));
    EXPECT_EQ(scene.light.sun, Vec3(3, 2, 1));
    EXPECT_EQ(scene.light.sky, Vec3(0.5f));
    EXPECT_EQ(scene.light.bounce, Vec3(0, 0, 0.25f));
    ASSERT_TRUE(scene.ground);
    EXPECT_EQ(scene.ground->height, -2.0);
    EXPECT_EQ(scene.ground->material.color, Vec3(0.7f, 0.5f, 0.25f));
    EXPECT_EQ(scene.ground->material.edge_color, Vec3(1.0f));
    EXPECT_EQ(scene.ground->material.subsurface, Vec3(0.125f));
    EXPECT_EQ(scene.ground->material.reflection, 0.5f);
    EXPECT_EQ(scene.ground->material.occlusion, 0.75f);
}

TEST(SceneFile, WithoutAWordHasDefaults) {
    const Scene scene = scene_from(ball);
    EXPECT_FALSE(scene.ground || scene.camera.eye || scene.light.sun);
    EXPECT_TRUE(scene.occlusion.is_planned());
    EXPECT_EQ(scene.occlusion.radius.value, 0.1);
    EXPECT_EQ(scene_from("[occlusion]\nmethod = \"none\"\n").occlusion.method, nullptr);
}

TEST(SceneFile, AnUnknownKeyIsAnErrorThatNamesTheNearest) {
    expect_refusal("[camera]\neyes = [0, 0, 1]\n", {"scene.toml:2", "eyes", "[camera]", "did you mean eye?"});
    expect_refusal("[image]\nwidht = 3\n", {":2:", "width"});
    expect_refusal("[objects]\n", {":1:", "did you mean object?"});
    expect_refusal(std::string(ball) + "raduis = 2\n", {":3:", "raduis", "[[object]]", "radius"});
    expect_refusal(std::string(ball) + "file = \"a.ply\"\n", {":3:", "file"});        // of another shape
    expect_refusal("[occlusion]\nmethod = \"classic\"\nrays = 3\n", {":3:", "rays"}); // of another method
    expect_refusal("[material.clay]\ncolour = 1\n", {":2:", "[material.clay]", "did you mean color?"});
    expect_refusal("[[object]]\nshape = \"union\"\npart = [{ shape = \"box\", sise = [1, 1, 1] }]\n",
                   {":3:", "[[object.part]]", "size"});
}

TEST(SceneFile, EveryWrongValueIsNamedWithItsLine) {
    expect_refusal("[camera]\neye = [0, 0]\n", {":2:", "eye takes three numbers"});
    expect_refusal("[camera]\neye = [0, inf, 0]\n", {":2:", "finite"});
    expect_refusal("[camera]\nup = [0, 0, 0]\n", {":2:", "direction"});
    expect_refusal("[camera]\nfov = 180\n", {":2:", "1 to 170"});
    expect_refusal("[camera]\neye = [1, 1, 1]\nlook_at = [1, 1, 1]\n", {":3:", "the same point as eye"});
    expect_refusal("camera = 3\n", {":1:", "camera takes a table, not a number"});
    expect_refusal("[image]\nwidth = 0.5\n", {":2:", "whole number from 1 to 65536"});
    expect_refusal("[image]\nsamples = \"4\"\n", {":2:", "takes a number, not a string"});
    expect_refusal("[occlusion]\nmethod = \"clasic\"\n", {":2:", "clasic", "classic"});
    expect_refusal("[occlusion]\nradius = \"10 apples\"\n", {":2:", "10 apples", "10%"});
    expect_refusal("[occlusion]\nradius = 0\n", {":2:", "above 0"});
    expect_refusal("[occlusion]\nrays = 0.5\n", {":2:", "rays"});
    expect_refusal("[occlusion]\nmethod = \"traced\"\ncosine_weighted = 1\n", {":3:", "true or false"});
    expect_refusal("[occlusion]\nfar = 3\n", {":2:", "far_samples"});
    expect_refusal("[occlusion]\nlight = \"all\"\n", {":2:", "ambient", "all"});
    expect_refusal("[sky]\ncolor = [0, -1, 0]\n", {":2:", "from 0 to 10000"});
    expect_refusal("[material.red]\ncolor = 255\n", {":2:", "from 0 to 1"});
    expect_refusal("[material.red]\ncolor = \"red\"\n", {":2:", "red, green and blue"});
    expect_refusal("[material.a]\nreflection = 2\n", {":2:", "from 0 to 1"});
    expect_refusal("material = [1]\n", {":1:", "table"});
    expect_refusal(std::string(ball) + "material = \"clay\"\n",
                   {":3:", "material clay is not defined", "add [material.clay]"});
    expect_refusal(std::string(ball) + "radius = -1\n", {":3:", "above 0"});
    expect_refusal(std::string(ball) + "scale = nan\n", {":3:", "finite"});
    expect_refusal("object = 1\n", {":1:", "[[object]]"});
    expect_refusal("[[object]]\n", {":1:", "needs a shape"});
    expect_refusal("[[object]]\nshape = \"cube\"\n", {":2:", "box", "cube"});
    expect_refusal("[[object]]\nshape = \"mesh\"\n", {"needs a file"});
    expect_refusal("[[object]]\nshape = \"mesh\"\nfile = \"a.ply\"\nvoxel = \"3vx\"\n", {":4:", "vx"});
    expect_refusal("[[object]]\nshape = \"mesh\"\nfile = \"a.ply\"\nnormals = \"smooth\"\n", {":4:", "field, mesh"});
    expect_refusal("[[object]]\nshape = \"box\"\nsize = [1, 0, 1]\n", {":3:", "above 0"});
    expect_refusal("[[object]]\nshape = \"union\"\n", {"needs parts"});
    expect_refusal("[[object]]\nshape = \"union\"\npart = [{ shape = \"mesh\", file = \"a.ply\", painted = true }]\n",
                   {":3:", "painted", "parts"});
    expect_refusal("[[object]]\nshape = \"union\"\npart = [{ shape = \"mesh\", file = \"a.ply\", color = \"own\" }]\n",
                   {":3:", "color", "parts"});
    expect_refusal("[[object]]\nshape = \"mesh\"\nfile = \"a.ply\"\ncolor = \"red\"\n", {":4:", "none, own"});
    expect_refusal("[[object]]\nshape = \"union\"\nblend = -1\npart = [{ shape = \"box\" }]\n", {":3:", "0 or more"});
}

TEST(SceneFile, WhatIsNoTomlIsNamedWithItsLine) {
    expect_refusal("[camera]\neye = = 3\n", {"scene.toml:2", "invalid TOML"});
    expect_refusal(std::string("[camera]\n\0\n", 11), {":2", "invalid TOML"});
    expect_refusal(std::string("a = ") + std::string(5000, '['), {"unsupported TOML"});
    EXPECT_THROW(read_scene("/nowhere/scene.toml"), InputError);
}

TEST(SceneFile, AByteOrderMarkIsSkippedAndUtf16IsNamed) {
    EXPECT_EQ(scene_from("\xef\xbb\xbf[camera]\nfov = 30\n").camera.fov, 30.0);
    EXPECT_EQ(scene_from("\xef\xbb\xbf\xef\xbb\xbf# twice\n[camera]\nfov = 30\n").camera.fov, 30.0);
    expect_refusal("\xef\xbb\xbf[camera]\nfov = 300\n", {":2:", "1 to 170"});
    const std::string text = "[camera]\nfov = 30\n";
    for (const bool big : {false, true})
        for (const bool marked : {false, true}) {
            std::string wide = !marked ? "" : big ? "\xfe\xff" : "\xff\xfe";
            for (const char c : text)
                wide += big ? std::string{'\0', c} : std::string{c, '\0'};
            expect_refusal(wide, {"scene.toml: is text in UTF-16; save it as UTF-8"});
        }
}

TEST(SceneFile, ARefusalIsOneLineWhateverTheNamesHold) {
    expect_refusal("\"a\\nb\" = 1\n", {":1", "a?b"});
    expect_refusal("[camera]\nfov = tru\n", {":2", "invalid TOML"});
    expect_refusal("[[object]]\nshape = \"a\\nb\"\n", {":2", "a?b"});
}

TEST(SceneFile, TablesNestedWithoutEndAreRefused) {
    std::string deep = "a";
    for (int i = 0; i < 100000; ++i)
        deep += ".a";
    expect_refusal("[camera]\n[" + deep + "]\n", {":2", "nested more than 1000 deep"});
    expect_refusal(deep + " = 1\n", {":1", "nested more than 1000 deep"});
    expect_refusal("a = [\n{" + deep + " = 1}]\n", {":2", "nested more than 1000 deep"});
    expect_refusal("a = [\"\"\"x\"\"\"\", {" + deep + " = 1}]\n", {":1", "nested more than 1000 deep"});
    // Dots in strings, comments and numbers do not count.
    const std::string dots(2000, '.');
    std::string numbers;
    for (int i = 0; i < 2000; ++i)
        numbers += "0.5,\n";
    expect_refusal("# " + dots + "\n[camera]\neye = \"\\\"" + dots + "\"\n", {":3", "takes three numbers"});
    expect_refusal("[camera]\neye = \"\"\"\n" + dots + "\"\"\"\n", {":2", "takes three numbers"});
    expect_refusal("[camera]\neye = [" + numbers + "]\n", {":2", "takes three numbers"});
}

TEST(SceneFile, PartsMayNotBeNestedWithoutEnd) {
    std::string nested = "{ shape = \"box\" }";
    for (int i = 0; i < 40; ++i)
        nested = "{ shape = \"union\", part = [" + nested + "] }";
    expect_refusal("object = [" + nested + "]\n", {"nested at most 32 deep"});
}

}
}
