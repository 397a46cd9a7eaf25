/// Compares bake with --occluder, --ground and --self with closed forms: the occlusion of a point is the configuration
/// factor of a spherical cap or a half space (Howell 1982).
#include "baked.h"
#include "program.h"
#include "shapes.h"

#include "alcove/mesh/files.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"

#include <cmath>
#include <limits>

namespace alcove::test {
namespace {

class BakeSurroundings : public ProgramTest {
  protected:
    void write_part(const std::string& name, const Mesh& part, double scale = 1.0,
                    const Vec3d& move = Vec3d(0.0)) const {
        Mesh mesh;
        add_part(mesh, part, scale, move);
        write_mesh(mesh, folder_ / "work" / name);
    }
    Baked bake(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "bake");
        arguments.insert(arguments.end(), {"-o", "out.ply"});
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return read_baked(folder_ / "work/out.ply");
    }
};

/// Visibility on a floor under a sphere of radius a around (0, h, 0), at distance s from the point below its centre.
double under_sphere(double a, double h, double s, double radius) {
    const double d2 = h * h + s * s, d = std::sqrt(d2);
    double share = 1.0 - std::pow((radius * radius + d2 - a * a) / (2.0 * radius * d), 2);
    if (radius >= std::sqrt(d2 - a * a))
        share = a * a / d2;
    else if (radius <= d - a)
        share = 0.0;
    return 1.0 - share * h / d;
}

std::vector<Vec3> normals_of(const Mesh& mesh) {
    return angle_weighted_normals(mesh, triangulate(mesh).triangles);
}

TEST_F(BakeSurroundings, AFloorUnderASphere) {
    const double a = 0.5, h = 0.8;
    write_part("floor.ply", floor_mesh(2.0, 12));
    write_part("sphere.ply", sphere_mesh(5), a, {0, h, 0});
    for (const char* radius : {"0.5", "1", "inf"}) {
        const Baked baked =
            bake({"floor.ply", "--occluder", "sphere.ply", "--radius", radius, "--method", "traced", "--rays", "512"});
        for (std::size_t v = 0; v < baked.ao.size(); ++v) {
            const Vec3d& p = baked.mesh.positions[v];
            const double expected = under_sphere(a, h, std::hypot(p.x, p.z), std::strtod(radius, nullptr));
            EXPECT_NEAR(baked.ao[v], expected, 0.02) << radius << " at " << p.x << " " << p.z;
        }
    }
}

TEST_F(BakeSurroundings, InfiniteMeansAsFarAsTheFurthestOccluder) {
    const double a = 10.0, h = 40.0; // 14 diagonals of the floor away
    write_part("floor.ply", floor_mesh(1.0, 4));
    write_part("sphere.ply", sphere_mesh(5), a, {0, h, 0});
    const Baked baked =
        bake({"floor.ply", "--occluder", "sphere.ply", "--radius", "inf", "--method", "traced", "--rays", "1024"});
    for (std::size_t v = 0; v < baked.ao.size(); ++v) {
        const Vec3d& p = baked.mesh.positions[v];
        EXPECT_NEAR(baked.ao[v], under_sphere(a, h, std::hypot(p.x, p.z), INFINITY), 0.02);
    }
}

TEST_F(BakeSurroundings, FarVerticesAreUnchangedAndNoneIsBrighter) {
    const Mesh elephant = read_mesh(real_mesh("elephant.off"));
    const double diagonal = elephant.box().diagonal(), radius = 0.1 * diagonal;
    const Vec3d place = elephant.box().max; // a corner of the box that part of the mesh reaches
    const double size = 0.15 * diagonal;
    write_part("sphere.ply", sphere_mesh(4), size, place);
    const Baked alone = bake({real_mesh("elephant.off"), "--method", "traced"});
    const Baked occluded = bake({real_mesh("elephant.off"), "--method", "traced", "--occluder", "sphere.ply"});
    std::size_t far = 0, darker = 0;
    for (std::size_t v = 0; v < alone.ao.size(); ++v) {
        const double distance = glm::length(alone.mesh.positions[v] - place) - size;
        if (distance > 2.0 * radius) {
            ++far;
            EXPECT_EQ(occluded.ao[v], alone.ao[v]);
        }
        // Shorter steps may let a few grazing rays pass the mesh.
        EXPECT_LE(occluded.ao[v], alone.ao[v] + 2.0f / 64.0f) << v;
        darker += occluded.ao[v] < alone.ao[v] - 0.1f;
    }
    EXPECT_GT(far, alone.ao.size() / 4);
    EXPECT_GT(darker, 20u);
}

TEST_F(BakeSurroundings, SaysWhatIsTooFarAway) {
    write_part("floor.ply", floor_mesh(1.0, 4));
    write_part("sphere.ply", sphere_mesh(3), 1.0, {0, 100, 0});
    const Outcome outcome = run({"bake", "floor.ply", "-o", "a.ply", "--occluder", "sphere.ply"});
    EXPECT_EQ(outcome.code, done);
    EXPECT_NE(outcome.err.find("sphere.ply is too far away"), std::string::npos) << outcome.err;
}

TEST_F(BakeSurroundings, ASphereOnTheGround) {
    const double pi = std::acos(-1.0);
    write_part("sphere.ply", sphere_mesh(3), 3.0, {50, -20, 7});
    const struct {
        const char* text;
        Vec3d up;
    } ups[] = {{"0,0,2", {0, 0, 1}}, {"-1,1,0", {-std::sqrt(0.5), std::sqrt(0.5), 0}}};
    for (const auto& [text, up] : ups)
        for (const char* radius : {"2", "inf"}) {
            const Baked baked = bake({"sphere.ply", "--ground", "--up", text, "--radius", radius, "--method", "traced",
                                      "--rays", "1024", "--voxel", "1%"});
            const std::vector<Vec3> normals = normals_of(baked.mesh);
            std::size_t compared = 0;
            for (std::size_t v = 0; v < baked.ao.size(); ++v) {
                const Vec3d normal(normals[v]);
                const double height = glm::dot(baked.mesh.positions[v] - Vec3d(50, -20, 7), up) + 3.0;
                // Within the radius the plane is a disc, seen in a cone around the downward direction.
                const double cone = std::acos(std::min(1.0, height / std::strtod(radius, nullptr)));
                const double tilt = std::acos(std::clamp(-glm::dot(normal, up), -1.0, 1.0));
                double expected = 0.5 * (1.0 + glm::dot(normal, up));
                if (std::string(radius) != "inf") {
                    if (cone > 0.0 && cone + tilt > 0.5 * pi)
                        continue; // cut by the horizon of the vertex
                    expected = 1.0 - std::pow(std::sin(cone), 2) * std::cos(tilt);
                }
                ++compared;
                EXPECT_NEAR(baked.ao[v], expected, 0.02) << text << " " << radius << " at height " << height;
            }
            EXPECT_GT(compared, baked.ao.size() / 2);
        }
}

TEST_F(BakeSurroundings, VerticesThatTouchTheGroundAreFiniteAndItsUndersideIsBuried) {
    write_part("cube.ply", box_mesh(Vec3d(1.0), 4));
    const Baked baked = bake({"cube.ply", "--ground", "--voxel", "1%", "--method", "traced", "--no-pilot"});
    for (std::size_t v = 0; v < baked.ao.size(); ++v) {
        const Vec3d& p = baked.mesh.positions[v];
        EXPECT_TRUE(baked.ao[v] >= 0.0f && baked.ao[v] <= 1.0f);
        if (p.y == -1.0 && std::fabs(p.x) < 1.0 && std::fabs(p.z) < 1.0) {
            EXPECT_EQ(baked.ao[v], 0.0f);
        }
        if (p.y > -0.5) {
            EXPECT_NEAR(baked.ao[v], 1.0f, 0.02f);
        }
    }
    // A sheet on the ground is not occluded.
    write_part("floor.ply", floor_mesh(1.0, 4));
    for (const float ao : bake({"floor.ply", "--ground", "--method", "traced"}).ao)
        EXPECT_NEAR(ao, 1.0f, 0.02f);
}

TEST_F(BakeSurroundings, PartsByThemselvesAreOpenHoweverTheyMeet) {
    Mesh pair;
    add_part(pair, sphere_mesh(3), 1.0, {0, 0, 0});
    add_part(pair, sphere_mesh(3), 1.0, {2, 0, 0}); // touches the first at a shared vertex
    add_part(pair, sphere_mesh(3), 0.5, {0, 0, 0.8});
    write_mesh(pair, folder_ / "work/pair.ply");
    for (const char* method : {"traced", "classic"})
        for (const float ao : bake({"pair.ply", "--self", "--radius", "0.5", "--method", method, "--voxel", "1%"}).ao)
            EXPECT_NEAR(ao, 1.0f, 0.01f);
    const Baked together = bake({"pair.ply", "--radius", "0.5", "--voxel", "1%"});
    EXPECT_LT(*std::min_element(together.ao.begin(), together.ao.end()), 0.5f);
}

TEST_F(BakeSurroundings, PartsByThemselvesStillStandOnTheGround) {
    Mesh pair;
    add_part(pair, sphere_mesh(3), 1.0, {0, 1, 0});
    add_part(pair, sphere_mesh(3), 0.5, {1.2, 0.5, 0});
    write_mesh(pair, folder_ / "work/pair.ply");
    const Baked baked = bake(
        {"pair.ply", "--self", "--ground", "--radius", "inf", "--method", "traced", "--rays", "1024", "--voxel", "1%"});
    const std::vector<Vec3> normals = normals_of(baked.mesh);
    for (std::size_t v = 0; v < baked.ao.size(); ++v)
        EXPECT_NEAR(baked.ao[v], 0.5 * (1.0 + normals[v].y), 0.02) << v;
}

TEST_F(BakeSurroundings, RaysOnTheMeshSeeWhatRaysThroughTheFieldSee) {
    write_part("box.ply", box_mesh(Vec3d(0.3), 1), 1.0, {0.6, 0.0, 0.1});
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--occluder", "box.ply"}, {"--ground"}, {"--self", "--ground"}}) {
        std::vector<std::string> arguments{real_mesh("elephant.off"), "--radius", "inf", "--rays", "256"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto by = [&](const char* method) {
            std::vector<std::string> all = arguments;
            all.insert(all.end(), {"--method", method});
            return bake(all);
        };
        const Baked traced = by("traced"), exact = by("exact");
        double squares = 0.0;
        for (std::size_t v = 0; v < exact.ao.size(); ++v)
            squares += std::pow(double(traced.ao[v]) - exact.ao[v], 2);
        EXPECT_LT(std::sqrt(squares / static_cast<double>(exact.ao.size())), 0.02) << more.front();
    }
}

TEST_F(BakeSurroundings, GivesTheSameBytesWithAnyNumberOfThreads) {
    write_part("sphere.ply", sphere_mesh(3), 1.0, {1, 1, 1});
    Mesh pair = sphere_mesh(3);
    add_part(pair, sphere_mesh(3), 0.7, {1, 0, 0});
    write_mesh(pair, folder_ / "work/pair.ply");
    for (const bool self : {false, true}) {
        std::vector<std::string> results;
        for (const char* threads : {"1", "3"}) {
            std::vector<std::string> arguments{"pair.ply", "--occluder", "sphere.ply", "--ground", "--voxel",
                                               "1%",       "--threads",  threads,      "--quiet"};
            if (self)
                arguments.emplace_back("--self");
            bake(arguments);
            results.push_back(bytes_of("out.ply"));
        }
        EXPECT_EQ(results[0], results[1]) << self;
    }
}

TEST_F(BakeSurroundings, RefusesWhatCannotBeMeant) {
    write("cube.off", cube_off);
    expect_refusal({"bake", "none.ply", "-o", "a.ply", "--ground", "--up", "0,0,0"}, usage, {"--up", "0,0,0"});
    expect_refusal({"bake", "none.ply", "-o", "a.ply", "--up", "up"}, usage, {"--up", "'up'"});
    expect_refusal({"bake", "cube.off", "-o", "a.ply", "--occluder", "none.ply"}, bad_input, {"none.ply"});
    expect_refusal({"bake", "none.ply", "-o", "a.ply", "--self", "--write-grid", "g.vdb"}, usage,
                   {"--self", "--write-grid"});
    EXPECT_EQ(files(), std::vector<std::string>{"cube.off"});
}

}
}
