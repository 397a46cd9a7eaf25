/// bake(), add() and check().
#include "alcove/bake/bake.h"

#include "alcove/base/types.h"
#include "alcove/measure/measure.h"
#include "alcove/mesh/triangulate.h"
#include "real_mesh.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

namespace alcove {
namespace {

using test::add_part;
using test::box_mesh;
using test::sphere_mesh;

double rmse_of_ao(const Mesh& mesh, const std::vector<float>& ao, float radius) {
    const MeasuredMesh measured("mesh", mesh);
    const Truth truth = make_truth(measured, radius);
    std::vector<float> values;
    for (const std::uint32_t vertex : truth.vertices)
        values.push_back(ao[vertex]);
    return compare(values, truth.ao).rmse;
}

TEST(Bake, MeetsTheErrorOfEachQualityAndNamesItsMethod) {
    const Mesh mesh = test::RealMesh("elephant.off").mesh;
    for (const Quality quality : {Quality::draft, Quality::good, Quality::fine}) {
        const Baked baked = bake(mesh, {.radius = "10%", .quality = quality});
        ASSERT_EQ(baked.ao().size(), mesh.vertex_count());
        ASSERT_TRUE(baked.rmse && baked.target);
        EXPECT_EQ(*baked.target, rmse_of(quality));
        EXPECT_LE(*baked.rmse, *baked.target);
        EXPECT_FALSE(baked.missed());
        const double rmse = rmse_of_ao(mesh, baked.ao(), 0.1f);
        EXPECT_LE(rmse, 1.15 * *baked.target) << baked.method;
        EXPECT_NEAR(*baked.rmse, rmse, std::max(0.3 * rmse, 0.002)) << baked.method;
        EXPECT_NE(baked.method, "");
        EXPECT_NEAR(baked.radius, 0.1 * mesh.box().diagonal(), 1e-6 * mesh.box().diagonal());
    }
}

TEST(Bake, PlansAsViaAllows) {
    const Mesh mesh = test::RealMesh("elephant.off").mesh;
    const Baked grid = bake(mesh), rays = bake(mesh, {.via = Via::mesh}), any = bake(mesh, {.via = Via::automatic});
    EXPECT_TRUE(grid.method.starts_with("guided") || grid.method.starts_with("calibrated")) << grid.method;
    EXPECT_GT(grid.grid_summary.levels, 0u);
    EXPECT_TRUE(rays.method.starts_with("exact:")) << rays.method;
    EXPECT_EQ(rays.grid_summary.levels, 0u);
    for (const Baked* baked : {&grid, &rays, &any}) {
        EXPECT_LE(*baked->rmse, 0.02);
        EXPECT_EQ(baked->reason, "");
    }
}

TEST(Bake, TunesTheNamedMethodToAnError) {
    const Mesh mesh = test::RealMesh("elephant.off").mesh;
    for (const char* method : {"exact", "guided", "traced"}) {
        const Baked baked = bake(mesh, {.error = 0.04, .method = method});
        EXPECT_TRUE(baked.method.starts_with(method)) << baked.method;
        EXPECT_LE(*baked.rmse, 0.04) << baked.method;
        EXPECT_TRUE(baked.warnings.empty()) << baked.warnings.front();
    }
    const Baked missed = bake(mesh, {.error = 0.01, .method = "classic"});
    EXPECT_TRUE(missed.missed());
    ASSERT_FALSE(missed.warnings.empty());
    EXPECT_NE(missed.warnings.front().find("reaches only"), std::string::npos) << missed.warnings.front();
}

TEST(Bake, FitsTheNetworkToTheMesh) {
    const Mesh mesh = test::RealMesh("elephant.off").mesh;
    for (const double probes : {13.0, 38.0, 63.0}) {
        const BakeOptions options{.method = "calibrated", .parameters = {{"samples", probes}}};
        BakeOptions unfitted = options;
        unfitted.pilot = false;
        const Baked baked = bake(mesh, options);
        const double rmse = rmse_of_ao(mesh, baked.ao(), 0.1f);
        EXPECT_LT(rmse, 0.9 * rmse_of_ao(mesh, bake(mesh, unfitted).ao(), 0.1f)) << probes;
        EXPECT_NEAR(*baked.rmse, rmse, 0.2 * rmse) << probes;
    }
}

/// Other attributes need wider bands, whose distances the networks were not trained on.
TEST(Bake, AoDoesNotDependOnTheOtherAttributes) {
    const Mesh mesh = test::RealMesh("elephant.off").mesh;
    for (const double probes : {13.0, 38.0, 63.0}) {
        BakeOptions options{
            .radius = "50%", .method = "calibrated", .parameters = {{"samples", probes}}, .pilot = false};
        const Baked alone = bake(mesh, options);
        options.attributes = Channel::ao | Channel::thickness;
        const Baked together = bake(mesh, options);
        double squares = 0.0;
        for (std::size_t v = 0; v < alone.ao().size(); ++v)
            squares += std::pow(double(alone.ao()[v]) - together.ao()[v], 2);
        EXPECT_LT(std::sqrt(squares / static_cast<double>(alone.ao().size())), 0.002) << probes;
    }
}

TEST(Bake, PointsAtTheVerticesHaveTheirValues) {
    // Smooth, so that the faces of a vertex are within 60° of its normal and count as the point's own faces.
    Mesh mesh = sphere_mesh(4);
    add_part(mesh, sphere_mesh(4), 0.7, {1.9, 0.3, 0.2});
    const std::vector<Vec3> normals = angle_weighted_normals(mesh, triangulate(mesh).triangles);
    std::vector<SurfacePoint> points;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        points.push_back({mesh.positions[v], normals[v]});
    for (const char* method : {"exact", "traced", "guided", "classic"})
        EXPECT_EQ(bake(mesh, points, {.method = method}).ao(), bake(mesh, {.method = method}).ao()) << method;
}

TEST(Bake, APointWithoutANormalTakesThatOfItsFace) {
    Mesh room = box_mesh(Vec3d(1.0), 4); // seen from the inside
    for (std::size_t f = 0; f < room.face_count(); ++f)
        std::reverse(room.corners.begin() + room.face_begin[f], room.corners.begin() + room.face_begin[f + 1]);
    const auto middle_of = [&](std::uint32_t f) {
        Vec3d sum(0.0);
        for (const std::uint32_t v : room.face(f))
            sum += room.positions[v];
        return sum / double(room.face(f).size());
    };
    std::vector<SurfacePoint> points;
    for (std::uint32_t f = 0; f < room.face_count(); ++f)
        points.push_back({middle_of(f), Vec3(0.0f), f});
    points.push_back({Vec3d(0.0), Vec3(0.0f)}); // neither a normal nor a face
    const Baked baked = bake(room, points, {.radius = "inf", .via = Via::mesh});
    for (std::uint32_t f = 0; f < room.face_count(); ++f)
        EXPECT_EQ(baked.ao()[f], 0.0f) << "everything in a closed room is occluded";
    EXPECT_EQ(baked.ao().back(), 1.0f);
    ASSERT_EQ(baked.warnings.size(), 1u);
    EXPECT_NE(baked.warnings.front().find("1 of "), std::string::npos) << baked.warnings.front();
    points.front().face = 1000;
    EXPECT_THROW(bake(room, points), InputError);
}

TEST(Bake, PartsByThemselvesArePlannedToo) {
    Mesh pair;
    add_part(pair, sphere_mesh(3), 1.0, {0, 0, 0});
    add_part(pair, sphere_mesh(3), 1.0, {1.5, 0, 0});
    for (const float ao : bake(pair, {.radius = "0.5", .self = true}).ao())
        EXPECT_NEAR(ao, 1.0f, 0.03f);
    const Baked together = bake(pair, {.radius = "0.5"});
    EXPECT_LT(*std::min_element(together.ao().begin(), together.ao().end()), 0.5f);
}

TEST(Bake, DoesNotDependOnThreads) {
    const Mesh mesh = test::RealMesh("elephant.off").mesh;
    const Baked one = bake(mesh, {.attributes = Channel::ao | Channel::bent_normal | Channel::thickness, .threads = 1});
    const Baked three =
        bake(mesh, {.attributes = Channel::ao | Channel::bent_normal | Channel::thickness, .threads = 3});
    EXPECT_EQ(one.method, three.method);
    for (const Channel channel : {Channel::ao, Channel::bent_normal, Channel::thickness})
        EXPECT_EQ(one[channel], three[channel]);
    EXPECT_EQ(one.rmse, three.rmse);
}

TEST(Bake, ReportsProgressAndStopsWhereThatThrows) {
    const Mesh mesh = test::RealMesh("elephant.off").mesh;
    std::set<std::string, std::less<>> works;
    bake(mesh, {.progress = [&](std::string_view work, double done) {
             works.emplace(work);
             EXPECT_TRUE(done >= 0.0 && done <= 1.0);
         }});
    EXPECT_EQ(works, (std::set<std::string, std::less<>>{"baking", "voxelizing"}));
    struct Cancelled : std::exception {};
    EXPECT_THROW(bake(mesh, {.progress = [](std::string_view, double) { throw Cancelled(); }}), Cancelled);
}

TEST(Bake, RefusesWhatWouldClearlyTakeTooLong) {
    const Mesh mesh = test::RealMesh("armadillo.off").mesh;
    const BakeOptions options{.method = "exact", .parameters = {{"rays", 1e6}}, .pilot = false, .time_limit = 1.0};
    try {
        bake(mesh, options);
        FAIL() << "26 billion rays in a second";
    } catch (const TimeLimitError& error) {
        EXPECT_NE(std::string(error.what()).find("use --rays "), std::string::npos) << error.what();
    }
}

TEST(Bake, WarnsOfFilesNormalsThatFaceAgainstTheirFaces) {
    Mesh sphere = sphere_mesh(4);
    for (const Vec3& n : angle_weighted_normals(sphere, triangulate(sphere).triangles))
        sphere.normals.push_back(-n);
    const Baked baked = bake(sphere, {.method = "classic"});
    ASSERT_TRUE(baked.rmse);
    ASSERT_GT(*baked.rmse, 0.1);
    ASSERT_FALSE(baked.warnings.empty());
    EXPECT_NE(baked.warnings.front().find("normals of the file point away from the front of the faces at 100 %"),
              std::string::npos)
        << baked.warnings.front();
}

bool warns_of(const Baked& baked, const std::string& text) {
    return std::any_of(baked.warnings.begin(), baked.warnings.end(),
                       [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

TEST(Bake, AFarVertexThatNoFaceUsesChangesNothing) {
    Mesh mesh = sphere_mesh(3);
    add_part(mesh, sphere_mesh(3), 0.7, {1.9, 0.3, 0.2});
    Mesh more = mesh;
    more.positions.insert(more.positions.begin(), {1e6, -1e6, 5e5});
    for (std::uint32_t& v : more.corners)
        ++v;
    const BakeOptions options{.ground = true};
    const Baked baked = bake(mesh, options), far = bake(more, options);
    EXPECT_EQ(std::vector(far.ao().begin() + 1, far.ao().end()), baked.ao());
    EXPECT_EQ(far.ao().front(), 1.0f);
    EXPECT_EQ(far.radius, baked.radius);
    EXPECT_TRUE(warns_of(far, "1 of 517 vertices has no normal (no face uses it, or its face normals cancel out)"));
}

TEST(Bake, WarnsOfAFewFacesThatDetermineTheBoundingBox) {
    Mesh mesh = sphere_mesh(3);
    const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.positions.insert(mesh.positions.end(), {{1000, 0, 0}, {1000, 1e-3, 0}, {1000, 0, 1e-3}});
    mesh.add_face(Triangle{first, first + 1, first + 2});
    EXPECT_FALSE(warns_of(bake(sphere_mesh(3)), "bounding box"));
    EXPECT_FALSE(warns_of(bake(mesh, {.radius = "0.3"}), "bounding box"));
    const Baked baked = bake(mesh);
    EXPECT_TRUE(warns_of(baked, "1 of 513 faces, face 513, makes the diagonal of the bounding box"))
        << baked.warnings.size();
    EXPECT_TRUE(warns_of(baked, "--radius 0.35"));
}

/// A floor of one quad under a box. Its corners are unoccluded, so no vertex represents the shadow under the box.
Mesh box_over_quad() {
    Mesh mesh;
    mesh.positions = {{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}};
    mesh.add_face(std::vector<std::uint32_t>{0, 3, 2, 1});
    add_part(mesh, box_mesh(Vec3d(1.0), 1), 1.0, {0, 1.3, 0});
    return mesh;
}

TEST(Bake, JoinedVerticesShareTheirValues) {
    const Mesh box = box_mesh({1, 1, 1}, 2);
    Mesh soup; // a vertex of its own for each corner of a face
    for (const std::uint32_t corner : box.corners)
        soup.positions.push_back(box.positions[corner]);
    for (std::uint32_t v = 0; v < soup.positions.size(); v += 4)
        soup.add_face(std::array{v, v + 1, v + 2, v + 3});
    const BakeOptions options{.radius = "inf", .method = "exact", .ground = true, .weld = "1e-6"};
    const Baked whole = bake(box, options), joined = bake(soup, options);
    ASSERT_EQ(joined.ao().size(), soup.vertex_count());
    for (std::size_t v = 0; v < soup.vertex_count(); ++v)
        EXPECT_EQ(joined.ao()[v], whole.ao()[box.corners[v]]);
    EXPECT_THROW(bake(soup, {.weld = "100"}), InputError); // joins all vertices
    EXPECT_THROW(bake(soup, {.weld = "1vx"}), InputError);
}

TEST(Bake, WarnsOfFacesTooLargeForWhatHappensBetweenTheirVertices) {
    const auto warnings = bake(box_over_quad(), {.radius = "1"}).warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings.front().find("--tessellate"), std::string::npos) << warnings.front();
    EXPECT_TRUE(bake(box_mesh(Vec3d(1.0), 1), {.radius = "0.2"}).warnings.empty())
        << "large faces without occlusion are not a problem";
}

TEST(Bake, ChecksItsOptions) {
    const auto message_of = [](const BakeOptions& options) {
        try {
            check(options);
            return std::string();
        } catch (const InputError& error) {
            return std::string(error.what());
        }
    };
    EXPECT_EQ(message_of({}), "");
    EXPECT_NE(message_of({.error = 0.0}).find("0.001"), std::string::npos);
    EXPECT_NE(message_of({.method = "clasic"}).find("no method 'clasic'"), std::string::npos);
    EXPECT_NE(message_of({.parameters = {{"rays", 3}}}).find("method"), std::string::npos);
    EXPECT_NE(message_of({.method = "classic", .parameters = {{"rays", 3}}}).find("no parameter 'rays'"),
              std::string::npos);
    EXPECT_NE(message_of({.pilot = false}).find("pilot"), std::string::npos);
    EXPECT_NE(message_of({.radius = "3vx"}).find("voxel"), std::string::npos);
    EXPECT_NE(message_of({.voxel = Length("2vx")}).find("vx"), std::string::npos);
    EXPECT_NE(message_of({.up = Vec3d(0.0)}).find("0,0,0"), std::string::npos);
    EXPECT_NE(message_of({.attributes = Channel::ao_short}).find("multiscale"), std::string::npos);
    EXPECT_NE(message_of({.attributes = {}}).find("attributes"), std::string::npos);
    EXPECT_NE(message_of({.error = 0.1, .attributes = Channel::convexity}).find("ao"), std::string::npos);
    EXPECT_NE(message_of({.self = true, .keep_grid = true}).find("grid"), std::string::npos);
}

TEST(Bake, WarnsOfVerticesThatShareAPlaceOnASmoothSurface) {
    const auto warning_of = [](const Mesh& mesh, const BakeOptions& options) {
        for (const std::string& warning : bake(mesh, options).warnings)
            if (warning.find("share positions") != std::string::npos)
                return warning;
        return std::string();
    };
    const auto split = [](const Mesh& mesh) {
        Mesh result;
        for (const auto& [a, b, c] : triangulate(mesh).triangles) {
            const auto next = static_cast<std::uint32_t>(result.positions.size());
            result.positions.insert(result.positions.end(), {mesh.positions[a], mesh.positions[b], mesh.positions[c]});
            result.add_face(std::array{next, next + 1, next + 2});
        }
        return result;
    };
    const BakeOptions options{.method = "classic", .pilot = false};
    Mesh soup = split(sphere_mesh(2));
    EXPECT_TRUE(warning_of(soup, options).starts_with(std::to_string(soup.vertex_count()) + " vertices share"));
    EXPECT_EQ(warning_of(sphere_mesh(2), options), "");
    EXPECT_EQ(warning_of(split(box_mesh(Vec3d(1.0), 2)), options), "") << "its faces are flat, its edges sharp";
    for (const Vec3d& p : soup.positions)
        soup.normals.push_back(Vec3(glm::normalize(p)));
    EXPECT_EQ(warning_of(soup, options), "");
    EXPECT_NE(warning_of(soup, {.method = "classic", .normals = NormalSource::area, .pilot = false}), "");
}

TEST(Bake, AddsWhatItBaked) {
    Mesh cube = box_mesh(Vec3d(1.0), 1);
    const Baked baked = bake(cube, {.attributes = Channel::ao | Channel::bent_normal});
    EXPECT_TRUE(add(cube, baked));
    EXPECT_EQ(cube.find_attribute("ao")->values, baked.ao());
    EXPECT_EQ(cube.find_attribute("quality")->values, baked.ao());
    EXPECT_EQ(cube.find_attribute("bent_normal")->components, 3);
    EXPECT_EQ(cube.added_colors.size(), cube.vertex_count());
    ASSERT_EQ(cube.added_comments.size(), 1u);
    EXPECT_TRUE(cube.added_comments.front().starts_with("alcove ")) << cube.added_comments.front();

    Mesh painted = box_mesh(Vec3d(1.0), 1);
    painted.vertex_colors.assign(painted.vertex_count(), Color{1, 2, 3, 255});
    EXPECT_FALSE(add(painted, baked)) << "the mesh has its own colours";
    EXPECT_TRUE(painted.added_colors.empty());
    EXPECT_TRUE(add(painted, baked, {.color = ColorUse::ao}));

    Mesh other = sphere_mesh(2);
    EXPECT_THROW(add(other, baked), InputError);
}

TEST(Bake, PointsGetTheClosedFormOfTheirSurface) {
    // Points of a sphere of radius 1 that face inward: within R, the sphere covers the share R²/4 of the
    // cosine-weighted hemisphere.
    Mesh points;
    for (std::size_t i = 0; i < 20000; ++i) {
        const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / 20000.0, angle = 2.399963229728653 * double(i);
        const Vec3d n(std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z);
        points.positions.push_back(n);
        points.normals.emplace_back(-n);
    }
    const double reach = 1.0;
    const Baked baked = bake(points, {.radius = "1"});
    ASSERT_EQ(baked.ao().size(), 20000u);
    double squares = 0.0;
    for (const float ao : baked.ao())
        squares += std::pow(ao - (1.0 - reach * reach / 4.0), 2);
    EXPECT_LT(std::sqrt(squares / 20000.0), 0.03);
    EXPECT_TRUE(baked.warnings.empty()) << baked.warnings.front();
}

}
}
