#include "baked.h"
#include "program.h"

#include "alcove/mesh/files.h"
#include "alcove/mesh/formats/ply/ply_document.h"

#include <array>
#include <cmath>
#include <set>

namespace alcove::test {
namespace {

using BakeVerb = ProgramTest;

std::size_t count_of(const std::string& text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
        ++count;
    return count;
}

std::string header_of(const std::string& ply) {
    return ply.substr(0, ply.find("end_header"));
}

TEST_F(BakeVerb, PrintsOneObjectWithEveryKey) {
    const Outcome outcome = run({"bake", real_mesh("elephant.off"), "-o", "a.ply", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const nlohmann::json result = outcome.json();
    EXPECT_EQ(result.at("input"), real_mesh("elephant.off"));
    EXPECT_EQ(result.at("vertices"), 2775);
    EXPECT_EQ(result.at("faces"), 5558);
    EXPECT_TRUE(result.at("method").is_string());
    const double diagonal = read_mesh(real_mesh("elephant.off")).box().diagonal();
    EXPECT_NEAR(result.at("radius").get<double>(), 0.1 * diagonal, 1e-6 * diagonal);
    EXPECT_GT(result.at("voxel"), 0.0);
    EXPECT_LT(result.at("voxel").get<double>(), 0.1 * diagonal);
    EXPECT_GE(result.at("levels"), 1);
    EXPECT_GT(result.at("grid_bytes"), 0);
    EXPECT_TRUE(result.at("estimated_rmse").is_null() || result.at("estimated_rmse").is_number());
    for (const char* phase : {"read", "grid", "occlusion", "write"})
        EXPECT_GE(result.at("seconds").at(phase), 0.0) << phase;
    EXPECT_GT(result.at("peak_rss_bytes"), 1 << 20);
    EXPECT_TRUE(result.at("warnings").empty());
}

TEST_F(BakeVerb, IsSilentOnStderrWhenAllIsWellAndEverywhereWhenQuiet) {
    write("cube.off", cube_off);
    const Outcome outcome = run({"bake", "cube.off", "-o", "a.ply"});
    EXPECT_EQ(outcome.code, done);
    EXPECT_EQ(outcome.err, "");
    const Outcome quiet = run({"bake", "cube.off", "-o", "b.ply", "--quiet"});
    EXPECT_EQ(quiet.code, done);
    EXPECT_EQ(quiet.out + quiet.err, "");
    EXPECT_EQ(files(), (std::vector<std::string>{"a.ply", "b.ply", "cube.off"}));
}

TEST_F(BakeVerb, GivesTheSameBytesWithAnyNumberOfThreads) {
    for (const char* method : {"classic", "hemisphere", "traced"}) {
        std::set<std::string> results;
        for (const char* threads : {"1", "2", "3"}) {
            const Outcome outcome = run({"bake", real_mesh("elephant.off"), "-o", "a.ply", "--method", method,
                                         "--attributes", "ao,convexity,bent_normal,thickness", "--threads", threads});
            ASSERT_EQ(outcome.code, done) << outcome.err;
            results.insert(bytes_of("a.ply"));
        }
        EXPECT_EQ(results.size(), 1u) << method;
        EXPECT_GT(results.begin()->size(), 2775u * 16);
    }
}

TEST_F(BakeVerb, LeavesTheOldFileAsItWasAfterAFailure) {
    write("a.ply", "what was here before");
    write("cube.off", cube_off);
    write("broken.off", "OFF\n3 1 0\n0 0 0\n");
    expect_refusal({"bake", "broken.off", "-o", "a.ply"}, bad_input, {"broken.off"});
    expect_refusal({"bake", "cube.off", "-o", "a.ply", "--voxel", "1e-9"}, bad_input, {"--voxel"});
    expect_refusal({"bake", "cube.off", "-o", "a.ply", "--method", "none at all"}, usage, {"none at all"});
    max_file_size_ = 4096;
    expect_refusal({"bake", real_mesh("elephant.off"), "-o", "a.ply"}, failure, {"a.ply: cannot be written"});
    EXPECT_EQ(bytes_of("a.ply"), "what was here before");
    EXPECT_EQ(files(), (std::vector<std::string>{"a.ply", "broken.off", "cube.off"}));
}

TEST_F(BakeVerb, WorksInPlaceAndAddsNothingTwice) {
    write("cube.off", cube_off);
    ASSERT_EQ(run({"bake", "cube.off", "-o", "a.ply"}).code, done);
    const std::string once = bytes_of("a.ply");
    for (int again = 0; again < 2; ++again) {
        const Outcome outcome = run({"bake", "a.ply", "-o", "a.ply"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        EXPECT_EQ(bytes_of("a.ply"), once);
    }
    ASSERT_EQ(run({"bake", "a.ply", "-o", "a.ply", "--color", "ao"}).code, done);
    const std::string header = header_of(bytes_of("a.ply"));
    for (const char* name : {"ao", "quality", "red", "green", "blue", "alpha", "x"})
        EXPECT_EQ(count_of(header, std::string(" ") + name + "\n"), 1u) << name << " in " << header;
    EXPECT_EQ(files(), (std::vector<std::string>{"a.ply", "cube.off"}));
}

TEST_F(BakeVerb, WritesVisibilityUnderTheNamesOthersRead) {
    // A cube is convex: nothing occludes any vertex.
    write("cube.off", cube_off);
    ASSERT_EQ(run({"bake", "cube.off", "-o", "a.ply"}).code, done);
    const Mesh mesh = read_mesh(folder_ / "work/a.ply");
    const auto& document = dynamic_cast<const PlyDocument&>(*mesh.source);
    const PlyElement& vertices = *document.find("vertex");
    for (const char* name : {"ao", "quality"}) {
        ASSERT_NE(vertices.find(name), nullptr);
        EXPECT_EQ(vertices.find(name)->type, PlyType::float32);
    }
    ASSERT_EQ(mesh.vertex_colors.size(), 8u);
    for (const Color& color : mesh.vertex_colors)
        EXPECT_GE(color[0], 250);
    ASSERT_EQ(mesh.face_count(), 6u);
    for (std::size_t f = 0; f < 6; ++f)
        EXPECT_EQ(mesh.face(f).size(), 4u);
}

TEST_F(BakeVerb, KeepsTheColoursAndQualityOfTheInput) {
    write("own.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                     "property float z\nproperty float quality\nelement face 2\n"
                     "property list uchar int vertex_indices\nend_header\n"
                     "0 0 0 0.25\n1 0 0 0.5\n1 1 0 0.75\n0 1 0 -3\n3 0 1 2\n3 0 2 3\n");
    ASSERT_EQ(run({"bake", "own.ply", "-o", "a.ply"}).code, done);
    const Mesh mesh = read_mesh(folder_ / "work/a.ply");
    EXPECT_TRUE(mesh.vertex_colors.empty());
    const auto& document = dynamic_cast<const PlyDocument&>(*mesh.source);
    const PlyElement& vertices = *document.find("vertex");
    ASSERT_EQ(vertices.properties.size(), 5u);
    const float wanted[] = {0.25f, 0.5f, 0.75f, -3.0f};
    for (std::size_t v = 0; v < 4; ++v)
        EXPECT_EQ(number_at(vertices.rows.data() + v * 20 + 12, PlyType::float32), wanted[v]);
}

/// A triangle with a property of its vertices.
std::string triangle_with(const std::string& property, const std::array<std::string, 3>& values) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
           property + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " + values[0] +
           "\n1 0 0 " + values[1] + "\n0 1 0 " + values[2] + "\n3 0 1 2\n";
}

TEST_F(BakeVerb, AnyComponentOfAColourIsTheInputsOwn) {
    for (const char* name : {"red", "green", "blue", "alpha"}) {
        write("own.ply", triangle_with("property uchar " + std::string(name) + "\n", {"10", "20", "30"}));
        const Outcome outcome = run({"bake", "own.ply", "-o", "a.ply", "--json"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        ASSERT_EQ(outcome.json().at("warnings").size(), 1u) << outcome.err;
        EXPECT_NE(outcome.err.find("the vertex colour of the input is kept"), std::string::npos) << outcome.err;
        const std::string baked = bytes_of("a.ply"), header = header_of(baked);
        EXPECT_EQ(count_of(header, "property uchar "), 1u) << header;
        const float one[] = {1.0f, 0.0f, 0.0f};
        const std::string row = std::string(reinterpret_cast<const char*>(one), sizeof one) + '\x14';
        EXPECT_NE(baked.find(row), std::string::npos) << name;
        EXPECT_EQ(run({"bake", "own.ply", "-o", "a.ply", "--color", "ao", "--json"}).json().at("warnings"),
                  nlohmann::json({"the property '" + std::string(name) + "' of the input is replaced"}));
    }
}

TEST_F(BakeVerb, NamesThePropertiesOfOtherProgramsThatItReplaces) {
    write("own.ply", triangle_with("property uchar ao\nproperty float convexity\n", {"11 0", "22 0", "33 0"}));
    const Outcome first = run({"bake", "own.ply", "-o", "a.ply", "--json"});
    ASSERT_EQ(first.code, done) << first.err;
    EXPECT_EQ(first.json().at("warnings"), nlohmann::json({"the property 'ao' of the input is replaced"}));
    EXPECT_TRUE(run({"bake", "a.ply", "-o", "b.ply", "--json"}).json().at("warnings").empty());
    const nlohmann::json both = run({"bake", "a.ply", "-o", "b.ply", "--attributes", "ao,convexity", "--json"}).json();
    EXPECT_NE(both.at("warnings").dump().find("the property 'convexity' of the input is replaced"), std::string::npos);
    EXPECT_EQ(both.at("warnings").dump().find("'ao'"), std::string::npos) << both;
}

TEST_F(BakeVerb, QualityOfTheInputOutlivesSeveralBakes) {
    write("own.ply", triangle_with("property float quality\n", {"7", "8", "9"}));
    ASSERT_EQ(run({"bake", "own.ply", "-o", "a.ply"}).code, done);
    ASSERT_EQ(run({"bake", "a.ply", "-o", "a.ply"}).code, done);
    const float second[] = {1.0f, 0.0f, 0.0f, 8.0f};
    EXPECT_NE(bytes_of("a.ply").find(std::string(reinterpret_cast<const char*>(second), sizeof second)),
              std::string::npos);
}

TEST_F(BakeVerb, ColoursOfAnEarlierBakeStayWithAWarning) {
    write("corner.off", "OFF\n6 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n0 1 1\n3 0 1 2\n3 0 2 3\n3 0 3 5\n3 0 5 4\n");
    ASSERT_EQ(run({"bake", "corner.off", "-o", "a.ply", "--radius", "0.01%", "--method", "exact"}).code, done);
    const Mesh before = read_mesh(folder_ / "work/a.ply");
    for (const std::vector<std::string>& color : {std::vector<std::string>{}, {"--color", "none"}}) {
        std::vector<std::string> arguments{"bake", "a.ply",    "-o",    "b.ply", "--radius",
                                           "inf",  "--method", "exact", "--json"};
        arguments.insert(arguments.end(), color.begin(), color.end());
        const Outcome kept = run(arguments);
        ASSERT_EQ(kept.code, done) << kept.err;
        EXPECT_NE(kept.err.find("the vertex colours are kept, but they do not show this ao"), std::string::npos)
            << kept.err;
        EXPECT_EQ(read_mesh(folder_ / "work/b.ply").vertex_colors, before.vertex_colors);
    }
    const Outcome replaced =
        run({"bake", "a.ply", "-o", "b.ply", "--radius", "inf", "--method", "exact", "--color", "ao"});
    EXPECT_EQ(replaced.err.find("colours"), std::string::npos) << replaced.err;
    EXPECT_NE(read_mesh(folder_ / "work/b.ply").vertex_colors, before.vertex_colors);
}

TEST_F(BakeVerb, WeldJoinsVerticesButKeepsThemInTheOutput) {
    // A closed tetrahedron whose faces have vertices of their own, 2e-5 apart.
    const std::string soup = "12 4 0\n0 0 0\n0 1 0\n1 0 0\n0 0 1e-5\n1 0 0\n0 0 1\n1e-5 0 0\n0 0 1\n0 1 0\n1 0 0\n"
                             "0 1 0\n0 0 1.00001\n3 0 1 2\n3 3 4 5\n3 6 7 8\n3 9 10 11\n";
    write("soup.off", "OFF\n" + soup);
    const Outcome apart = run({"bake", "soup.off", "-o", "a.ply", "--json"});
    ASSERT_EQ(apart.code, done) << apart.err;
    EXPECT_NE(apart.err.find("open edges would close if vertices within 2e-05 were joined"), std::string::npos)
        << apart.err;
    const Outcome joined =
        run({"bake", "soup.off", "-o", "b.ply", "--weld", "2e-5", "--voxel", "2%", "--method", "traced", "--json"});
    ASSERT_EQ(joined.code, done) << joined.err;
    EXPECT_EQ(joined.json().at("sign"), "solid");
    EXPECT_EQ(joined.err.find("would close"), std::string::npos) << joined.err;
    const Mesh a = read_mesh(folder_ / "work/a.ply"), b = read_mesh(folder_ / "work/b.ply");
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.corners, b.corners);
    expect_refusal({"bake", "soup.off", "-o", "b.ply", "--weld", "inf"}, usage, {"--weld", "finite"});
    expect_refusal({"bake", "soup.off", "-o", "b.ply", "--weld", "2vx"}, usage, {"--weld", "0.2 (scene units)"});
    expect_refusal({"bake", "soup.off", "-o", "b.ply", "--weld", "5"}, bad_input,
                   {"soup.off: --weld: joins the corners of every face"});
}

/// The normals of the file differ where vertices coincide. If these normals are not used, they must not keep the
/// vertices apart.
TEST_F(BakeVerb, WeldJoinsVerticesWhoseNormalsAreComputed) {
    // Two faces of a valley of 90 degrees, each with vertices and a normal of its own.
    write("valley.obj", "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 0 0 0\nv 0 0 1\nv 0 1 1\nv 0 1 0\n"
                        "vn 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//1 4//1\nf 5//2 8//2 7//2 6//2\n");
    for (const char* normals : {"angle", "area"}) {
        const Outcome outcome = run({"bake", "valley.obj", "-o", "a.ply", "--weld", "1e-5", "--normals", normals,
                                     "--method", "exact", "--rays", "1024", "--radius", "0.01"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        // The valley ends at the vertices, so half of the sky is open. In the other half, the quadrant covers √½ of the
        // sky around the mean normal, but only half of it around the normal of a vertex that is not joined, which would
        // give 0.75.
        const std::vector<float> ao = read_baked(folder_ / "work/a.ply").ao;
        ASSERT_EQ(ao.size(), 8u);
        EXPECT_EQ(ao[0], ao[4]) << normals;
        EXPECT_NEAR(ao[0], 0.5 * (1.0 + std::sqrt(0.5)), 0.02) << normals;
        EXPECT_NEAR(ao[2], 1.0f, 0.01f) << normals;
    }
}

TEST_F(BakeVerb, WeldMakesTheVerticesOfAnStl) {
    const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
        return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
               "\nendloop\nendfacet\n";
    };
    write("soup.stl", "solid\n" + facet("0 0 0", "0 1 0", "1 0 0") + facet("0 0 1e-5", "1 0 0", "0 0 1") +
                          facet("1e-5 0 0", "0 0 1", "0 1 0") + facet("1 0 0", "0 1 0", "0 0 1.00001") + "endsolid\n");
    const nlohmann::json apart = run({"bake", "soup.stl", "-o", "a.ply", "--json"}).json();
    EXPECT_EQ(apart.at("vertices"), 7);
    EXPECT_NE(apart.at("warnings").dump().find("add --weld 2e-05"), std::string::npos) << apart;
    const nlohmann::json joined = run({"bake", "soup.stl", "-o", "b.ply", "--weld", "0.002%", "--json"}).json();
    EXPECT_EQ(joined.at("vertices"), 4);
    EXPECT_EQ(joined.at("warnings").dump().find("would close"), std::string::npos) << joined;
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"voxelize", "soup.stl", "-o", "a.vdb", "--voxel", "2%"},
          {"render", "soup.stl", "-o", "a.png", "--size", "8x8"},
          {"info", "soup.stl"}}) {
        const Outcome told = run(arguments);
        EXPECT_NE((told.out + told.err).find("add --weld 2e-05"), std::string::npos) << told.out << told.err;
        std::vector<std::string> with_weld = arguments;
        with_weld.insert(with_weld.end(), {"--weld", "2e-5"});
        const Outcome mended = run(with_weld);
        EXPECT_EQ(mended.code, done) << mended.err;
        EXPECT_EQ((mended.out + mended.err).find("would close"), std::string::npos) << mended.out << mended.err;
    }
    EXPECT_EQ(run({"info", "soup.stl", "--weld", "2e-5", "--json"}).json().at("sign"), "solid");
    EXPECT_EQ(run({"measure", "soup.stl", "--weld", "2e-5", "--methods", "exact:16"}).code, done);
}

TEST_F(BakeVerb, WritesObjWithColoursAndEveryOtherLineOfTheInput) {
    write("cube.obj", "# made by hand\nmtllib cube.mtl\no cube\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\n"
                      "f 1/1 2/1 3/1\n");
    ASSERT_EQ(run({"bake", "cube.obj", "-o", "a.obj"}).code, done);
    const std::string text = bytes_of("a.obj");
    for (const char* line : {"# made by hand\n", "mtllib cube.mtl\n", "o cube\n", "vt 0 0\n", "usemtl red\n",
                             "f 1/1 2/1 3/1\n", "v 0 0 0 ", "v 1 0 0 "})
        EXPECT_NE(text.find(line), std::string::npos) << line << " is not in " << text;
    EXPECT_EQ(read_mesh(folder_ / "work/a.obj").vertex_colors.size(), 3u);
}

}
}
