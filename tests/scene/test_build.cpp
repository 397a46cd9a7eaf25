#include "scene_text.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/types.h"
#include "alcove/field/primitives.h"
#include "alcove/scene/detail/loaded_shapes.h"
#include "alcove/scene/detail/shared_grids.h"
#include "alcove/scene/scene.h"
#include "shapes.h"

#include <cmath>
#include <random>

namespace alcove::test {
namespace {

/// The field of a built scene, in scene space and scene units.
struct Mapped {
    BuiltScene built;

    explicit Mapped(const std::string& text) : built(build_scene(scene_from(text))) {}
    double operator()(const Vec3d& p) const {
        const Frame& frame = built.renderable.frame;
        return double(built.renderable.field.map(frame.to_unit(p))) * frame.diagonal;
    }
};

std::vector<Vec3d> random_places(double size) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> coordinate(-size, size);
    std::vector<Vec3d> places;
    for (int i = 0; i < 300; ++i)
        places.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    return places;
}

TEST(Staging, QualityChoosesGuidedAndItsRays) {
    Scene scene = scene_from("[[object]]\nshape = \"sphere\"\n");
    int fewer = 0;
    for (const Quality quality : {Quality::draft, Quality::good, Quality::fine}) {
        scene.occlusion.choose(quality);
        const BuiltScene built = build_scene(scene);
        ASSERT_NE(built.occlusion.method, nullptr);
        EXPECT_EQ(built.occlusion.method->name, "guided");
        EXPECT_GT(built.occlusion.samples, fewer);
        fewer = built.occlusion.samples;
    }
    scene.occlusion.choose("traced");
    EXPECT_EQ(build_scene(scene).occlusion.method->name, "traced");
    scene.occlusion.choose("none");
    EXPECT_EQ(build_scene(scene).occlusion.method, nullptr);
}

TEST(Staging, PrimitivesAreWhatTheirFormulasSay) {
    const Mapped map(R"(
object = [
    { shape = "sphere", center = [1, 2, 0], radius = 0.5 },
    { shape = "box", center = [0, 0, -1], size = [1, 2, 0.5] },
    { shape = "torus", center = [-2, 0, 0], ring = 1, tube = 0.25 },
    { shape = "capsule", start = [0, -2, 0], end = [1, -2, 1], radius = 0.3 },
]
)");
    for (const Vec3d& p : random_places(3.0)) {
        const Vec3 q(p);
        const float expected =
            std::min({Sphere{{1, 2, 0}, 0.5f}.map(q), Cuboid{{0, 0, -1}, {0.5f, 1.0f, 0.25f}}.map(q),
                      Torus{{-2, 0, 0}, 1.0f, 0.25f}.map(q), Capsule{{0, -2, 0}, {1, -2, 1}, 0.3f}.map(q)});
        EXPECT_NEAR(map(p), expected, 3e-6);
    }
}

TEST(Staging, PlacementScalesThenTurnsAboutXThenYThenZThenMoves) {
    const Mapped map("[[object]]\nshape = \"box\"\nsize = [1, 2, 3]\ntranslate = [5, -4, 2]\nrotate = [30, 40, 50]\n"
                     "scale = 2\n");
    const auto turn = [](double& a, double& b, double degrees) {
        const double angle = degrees * 3.14159265358979323846 / 180.0, a0 = a;
        a = a * std::cos(angle) - b * std::sin(angle);
        b = a0 * std::sin(angle) + b * std::cos(angle);
    };
    const Cuboid turned{{}, {0.5f, 1.0f, 1.5f}};
    for (const Vec3d& local : random_places(2.0)) {
        Vec3d p = 2.0 * local;
        turn(p.y, p.z, 30.0);
        turn(p.z, p.x, 40.0);
        turn(p.x, p.y, 50.0);
        EXPECT_NEAR(map(p + Vec3d(5, -4, 2)), 2.0f * turned.map(Vec3(local)), 2e-5);
    }
}

TEST(Staging, PartsArePlacedWithinWhatTheyArePartOf) {
    const Mapped map(R"(
[[object]]
shape = "difference"
translate = [10, 0, 0]
scale = 2
part = [
    { shape = "box", size = [2, 2, 2] },
    { shape = "sphere", radius = 0.5, translate = [0, 1, 0], scale = 1.5 },
    { shape = "plane", point = [0, -0.5, 0] },
]
)");
    for (const Vec3d& p : random_places(4.0)) {
        const Vec3 q(0.5 * p);
        const float expected =
            2.0f * std::max({Cuboid{{}, {1, 1, 1}}.map(q), -Sphere{{0, 1, 0}, 0.75f}.map(q), -(q.y + 0.5f)});
        EXPECT_NEAR(map(p + Vec3d(10, 0, 0)), expected, 2e-5);
    }
    const Box& box = map.built.renderable.box;
    EXPECT_NEAR(box.min.x, 8.0, 1e-9);
    EXPECT_NEAR(box.max.y, 2.0, 1e-9);
}

TEST(Staging, UnitSpaceIsThatOfAllThatIsBounded) {
    const BuiltScene built = build_scene(scene_from(R"(
[occlusion]
radius = "25%"
[[object]]
shape = "box"
size = [2, 3, 6]
[[object]]
shape = "plane"
normal = [0, 3, 0]
point = [7, -2, 7]
)"));
    EXPECT_NEAR(built.renderable.frame.diagonal, 7.0, 1e-12);
    EXPECT_FLOAT_EQ(built.radius, 0.25f);
    ASSERT_EQ(built.renderable.grounds.size(), 1u);
    EXPECT_EQ(built.renderable.parts.size(), 1u);
    EXPECT_NEAR(double(built.renderable.grounds[0].plane.map({0, 0, 0})) * 7.0, 2.0, 1e-6);
    EXPECT_NEAR(double(built.renderable.surroundings().map({0.0f, -0.25f, 0.0f})) * 7.0, 2.0 - 0.25 * 7.0, 1e-6);
    for (const Vec3d& p : built.points)
        EXPECT_LE(std::fabs(p.z), 3.1);
}

TEST(Staging, TheGroundIsBelowTheLowestPoint) {
    const char* const shapes[] = {
        "{ shape = \"sphere\", center = [3, 1, 1], radius = 1 }",
        "{ shape = \"difference\", part = [{ shape = \"box\", size = [2, 4, 2] }, { shape = \"plane\" }] }",
        "{ shape = \"torus\", rotate = [90, 0, 0], ring = 1, tube = 0.5, translate = [0, 1.5, 0] }"};
    for (const char* const shape : shapes) {
        const BuiltScene built = build_scene(scene_from(std::string("object = [") + shape + "]\n[ground]\n"));
        ASSERT_EQ(built.renderable.grounds.size(), 1u);
        const Frame& frame = built.renderable.frame;
        EXPECT_NEAR(built.renderable.grounds[0].plane.map(frame.to_unit({0, 0, 0})), 0.0f, 6e-4f) << shape;
    }
    const BuiltScene given = build_scene(scene_from("object = [{ shape = \"sphere\" }]\n[ground]\nheight = -3\n"));
    EXPECT_NEAR(given.renderable.grounds[0].plane.map(given.renderable.frame.to_unit({5, -3, 1})), 0.0f, 1e-6f);
}

TEST(Staging, AFieldNearEnoughToAScaledAndMovedSceneIsTheSame) {
    const Mapped small("object = [{ shape = \"torus\", ring = 2e-6, tube = 1e-6 }]\n");
    const Mapped large("object = [{ shape = \"torus\", ring = 2e9, tube = 1e9, translate = [1e10, 0, 0] }]\n");
    for (const Vec3d& p : random_places(3.0)) {
        EXPECT_NEAR(small(1e-6 * p) * 1e6, large(1e9 * p + Vec3d(1e10, 0, 0)) * 1e-9, 1e-5);
    }
}

TEST(Staging, ABlendStaysInItsBoxHoweverManyPartsItHas) {
    std::string parts;
    for (int i = 0; i < 8; ++i)
        parts += "{ shape = \"box\", size = [2, 1, 2] }, ";
    const BuiltScene built =
        build_scene(scene_from("object = [{ shape = \"union\", blend = 1, part = [" + parts + "] }]\n"));
    const Frame& frame = built.renderable.frame;
    const Box& box = built.renderable.box;
    for (const double y : {box.min.y, box.max.y})
        for (double x = -1.0; x <= 1.0; x += 0.25)
            EXPECT_GE(built.renderable.field.map(frame.to_unit({x, y, 0.3})), -1e-6f);
}

TEST(Staging, TheGroundIsBelowWhatIsSmallInALargeScene) {
    const BuiltScene built = build_scene(scene_from("object = [{ shape = \"sphere\", radius = 0.01 }, { shape = "
                                                    "\"box\", translate = [0, 2, 0] }]\n[ground]\n"));
    EXPECT_NEAR(double(built.renderable.grounds[0].plane.map(built.renderable.frame.to_unit({0, 0, 0}))) *
                    built.renderable.frame.diagonal,
                0.01, 1e-6);
}

TEST(Staging, ATurnedBallIsAsLargeAsBefore) {
    const BuiltScene built = build_scene(scene_from("object = [{ shape = \"sphere\", rotate = [45, 35, 0] }]\n"));
    EXPECT_NEAR(built.renderable.frame.diagonal, std::sqrt(12.0), 1e-12);
    const Box ring =
        build_scene(scene_from("object = [{ shape = \"torus\", ring = 2, tube = 0.5, rotate = [90, 0, 0] }]\n"))
            .renderable.box;
    EXPECT_NEAR(ring.max.y, 2.5, 1e-12);
    EXPECT_NEAR(ring.max.z, 0.5, 1e-7);
}

/// A soft shadow depends on distances up to t/sharpness. If these are cut off, open ground is dark.
TEST(Staging, DistancesReachAsFarAsShadowsAsk) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder / "ball.off";
    {
        std::ofstream off(file);
        const Mesh ball = sphere_mesh(3);
        off << "OFF " << ball.positions.size() << " " << ball.face_count() << " 0\n";
        for (const Vec3d& p : ball.positions)
            off << p.x << " " << p.y << " " << p.z << "\n";
        for (std::size_t f = 0; f < ball.face_count(); ++f)
            off << "3 " << ball.face(f)[0] << " " << ball.face(f)[1] << " " << ball.face(f)[2] << "\n";
    }
    Scene scene = scene_of(file);
    scene.occlusion.radius = {0.02, Length::Unit::diagonal};
    const auto distance_at = [&](double x) {
        const BuiltScene built = build_scene(scene, Pass::beauty);
        const Frame& frame = built.renderable.frame;
        return double(built.renderable.field.map(frame.to_unit({x, 0, 0}))) * frame.diagonal;
    };
    EXPECT_NEAR(distance_at(2.2), 1.2, 0.05); // voxels are coarse a third of the diagonal away
    scene.light.casts_shadow = false;
    EXPECT_LT(distance_at(1.7), 0.68); // a lower bound only, because no larger reach is needed
}

/// A folder with a tetrahedron, and scenes of many copies of it in a row.
class ManyObjects : public testing::Test {
  protected:
    ManyObjects() {
        std::ofstream(folder_ / "t.off")
            << "OFF 4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    }

    Scene scene(int count, double shrinking, const std::string& voxel) const {
        Scene scene;
        scene.occlusion.choose("none");
        for (int i = 0; i < count; ++i) {
            MeshShape mesh{.file = folder_ / (i % 2 == 0 ? "t.off" : "./t.off")};
            if (!voxel.empty())
                mesh.voxel = Length(voxel);
            Placement placement{.translation = {2.0 * i, 0.0, 0.0}, .scale = 1.0 - shrinking * i};
            scene.objects.push_back({"object " + std::to_string(i + 1), mesh, placement});
        }
        return scene;
    }

    const ScratchFolder folder_;
};

TEST_F(ManyObjects, OfOneFileShareItsMeshAndGrid) {
    Scene many = scene(60, 0.0, "2%");
    many.objects[1].placement.rotation = {0, 0, 90};
    forget_peak_resident_bytes();
    const std::size_t before = peak_resident_bytes();
    const BuiltScene built = build_scene(many);
    EXPECT_LT(peak_resident_bytes(), before + 60'000'000);
    ASSERT_EQ(built.renderable.parts.size(), 60u);
    const auto distance = [&](const Vec3d& p) {
        return double(built.renderable.field.map(built.renderable.frame.to_unit(p))) * built.renderable.frame.diagonal;
    };
    // Above the face x + y + z = 1, half a unit to the left of the face x = 0, and in front of the rotated one.
    EXPECT_NEAR(distance(Vec3d(18.0, 0, 0) + Vec3d(1.0 / 3.0 + 0.1)), 0.1 * std::sqrt(3.0), 0.01);
    EXPECT_NEAR(distance({117.9, 0.2, 0.2}), 0.1, 0.01);
    EXPECT_NEAR(distance({1.8, -0.1, 0.1}), 0.1, 0.01);
}

TEST_F(ManyObjects, WarnOnceOfWhatTheyShare) {
    std::ofstream(folder_ / "t.off")
        << "OFF 5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nnan 0 0\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    const BuiltScene built = build_scene(scene(10, 0.0, "2%"));
    EXPECT_EQ(std::count_if(built.warnings.begin(), built.warnings.end(),
                            [](const std::string& w) { return w.find("not finite") != std::string::npos; }),
              1);
}

TEST_F(ManyObjects, ThatNeedTooMuchMemoryAreRefusedBeforeTheyAreBuilt) {
    const auto refusal = [](const Scene& scene) -> std::string {
        try {
            build_scene(scene);
            return "built";
        } catch (const LimitError& error) {
            return error.what();
        }
    };
    // Each size needs a grid of its own.
    const std::string message = refusal(scene(4000, 1e-4, "0.1%"));
    EXPECT_NE(message.find("the scene needs about"), std::string::npos) << message;
    EXPECT_NE(message.find("t.off needs most"), std::string::npos) << message;
}

TEST_F(ManyObjects, GetCoarserVoxelsWhereFinerOnesDoNotFit) {
    const Scene many = scene(12, 1e-2, "");
    const auto voxels_within = [&](double limit) {
        MemoryEstimate memory(limit);
        std::vector<LoadedShape> shapes = load_shapes(many, memory);
        Box box;
        for (const LoadedShape& shape : shapes) {
            box.add(shape.box.min);
            box.add(shape.box.max);
        }
        const Frame frame = frame_of(box);
        SharedGrids grids(shapes, {frame, 0.01f}, memory);
        std::vector<float> voxels;
        for (LoadedShape& shape : shapes) {
            grids.field(shape);
            voxels.push_back(shape.stack.levels.front().voxel);
        }
        return voxels;
    };
    const std::vector<float> fine = voxels_within(4e9), coarse = voxels_within(40e6);
    for (std::size_t i = 0; i < fine.size(); ++i) {
        EXPECT_FLOAT_EQ(fine[i], 1.0f / 256.0f);
        EXPECT_GT(coarse[i], 1.2f * fine[i]);
    }
    EXPECT_THROW(voxels_within(1e6), LimitError);
    EXPECT_THROW(voxels_within(100.0), LimitError) << "the file alone is larger";
}

/// A vertex that no face uses does not count, wherever it is.
TEST_F(ManyObjects, StandWhereTheirFacesAre) {
    std::ofstream(folder_ / "t.off")
        << "OFF 5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-50 -70 0\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    Scene one = scene(1, 0.0, "");
    one.ground = SceneGround{};
    const BuiltScene built = build_scene(one);
    EXPECT_NEAR(built.renderable.frame.diagonal, std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(built.renderable.box.min.x, 0.0, 1e-12);
    const Frame& frame = built.renderable.frame;
    EXPECT_NEAR(built.renderable.grounds.at(0).plane.map(frame.to_unit({0, 0, 0})), 0.0f, 1e-6f);
    for (const Vec3d& p : built.points)
        EXPECT_GT(p.y, -0.1);
}

void expect_refusal(const std::string& text, std::initializer_list<const char*> parts) {
    try {
        build_scene(scene_from(text));
        ADD_FAILURE() << "built without an error: " << text;
    } catch (const InputError& error) {
        for (const char* part : parts)
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(Staging, WhatMakesNoPictureIsNamed) {
    expect_refusal("[image]\n", {"empty", "[[object]]"});
    expect_refusal("object = [{ shape = \"union\", part = [{ shape = \"plane\", name = \"wall\" }] }]\n",
                   {"wall", "is infinite"});
    expect_refusal("object = [{ shape = \"difference\", part = [{ shape = \"plane\" }, { shape = \"box\" }] }]\n",
                   {"part 1 (plane)", "is infinite"});
    expect_refusal("object = [{ shape = \"difference\", part = [{ shape = \"box\" }, { shape = \"sphere\", radius = 2 "
                   "}] }]\n",
                   {"no surface"});
    expect_refusal("occlusion = { radius = \"3vx\" }\nobject = [{ shape = \"box\" }]\n", {"vx"});
}

}
}
