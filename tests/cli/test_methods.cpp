/// How users select estimators, their parameters and their channels.
#include "program.h"

#include "alcove/mesh/files.h"
#include "alcove/mesh/formats/ply/ply_document.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <tuple>

namespace alcove::test {
namespace {

using Methods = ProgramTest;

const std::set<std::string> names{"classic",    "exponential", "decay",      "multiplicative",
                                  "multiscale", "jittered",    "hemisphere", "hemisphere_random",
                                  "fibonacci",  "traced"};

TEST_F(Methods, AreListedWithAllTheirParameters) {
    const Outcome outcome = run({"methods", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    const Outcome text = run({"methods"});
    ASSERT_EQ(text.code, done);
    EXPECT_EQ(outcome.err + text.err, "");
    std::set<std::string> left = names;
    const nlohmann::json listed = outcome.json();
    for (const nlohmann::json& method : listed.at("methods")) {
        const std::string name = method.at("name");
        SCOPED_TRACE(name);
        left.erase(name);
        EXPECT_NE(text.out.find(name + ": "), std::string::npos);
        for (const char* key : {"summary", "formula", "source", "cost_in_map_calls", "good", "bad"}) {
            EXPECT_FALSE(method.at(key).get<std::string>().empty()) << key;
            EXPECT_NE(text.out.find(method.at(key).get<std::string>()), std::string::npos) << key;
        }
        EXPECT_FALSE(method.at("gives").empty());
        for (const nlohmann::json& parameter : method.at("parameters")) {
            const nlohmann::json &least = parameter.at("min"), &most = parameter.at("max"),
                                 &standard = parameter.at("default");
            EXPECT_LT(least, most) << parameter;
            EXPECT_LE(least, standard) << parameter;
            EXPECT_LE(standard, most) << parameter;
            EXPECT_FALSE(parameter.at("summary").get<std::string>().empty()) << parameter;
            EXPECT_NE(text.out.find(parameter.at("name").get<std::string>() + "="), std::string::npos);
        }
    }
    EXPECT_TRUE(left.empty()) << "not listed: " << *left.begin();
}

TEST_F(Methods, AllBakeAndTakeTheirParameters) {
    write("cube.off", cube_off);
    for (const std::string& name : names) {
        const Outcome outcome = run({"bake", "cube.off", "-o", "a.ply", "--method", name, "--voxel", "5%", "--json"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        EXPECT_EQ(outcome.json().at("method"), name);
    }
    // --set takes effect: an open vertex is as bright as the factor.
    ASSERT_EQ(run({"bake", "cube.off", "-o", "a.obj", "--method", "exponential", "--set", "factor=0", "--set",
                   "samples=7", "--voxel", "5%", "--color-encoding", "raw"})
                  .code,
              done);
    for (const Color& color : read_mesh(folder_ / "work/a.obj").vertex_colors)
        EXPECT_EQ(color[0], 0);
}

TEST_F(Methods, RefuseWhatTheyDoNotTake) {
    write("cube.off", cube_off);
    const auto refuse = [&](const std::string& method, const std::string& option, const std::string& value,
                            const std::vector<std::string>& parts) {
        expect_refusal({"bake", "cube.off", "-o", "b.ply", "--method", method, option, value}, usage, parts);
    };
    const nlohmann::json listed = run({"methods", "--json"}).json();
    for (const nlohmann::json& method : listed.at("methods")) {
        const std::string name = method.at("name");
        if (!names.contains(name))
            continue;
        std::set<std::string> takes;
        for (const nlohmann::json& parameter : method.at("parameters"))
            takes.insert(parameter.at("name").get<std::string>());
        for (const std::string option : {"samples", "rays", "seed"})
            if (!takes.contains(option))
                refuse(name, "--" + option, "5", {name, fmt::format("no parameter '{}'", option)});
        refuse(name, "--set", "nothing=1", {name, "no parameter 'nothing'"});
        for (const nlohmann::json& parameter : method.at("parameters")) {
            const std::string key = parameter.at("name");
            refuse(name, "--set", key + "=-0.5", {key, name});
        }
    }
    refuse("classic", "--set", "samples", {"name=value"});
    refuse("classic", "--set", "samples=", {"'samples='"});
    refuse("classic", "--set", "strength=3x", {"'strength=3x'"});
    refuse("classic", "--set", "strength=nan", {"strength", "0 to 100"});
    refuse("classic", "--attributes", "ao_short", {"multiscale"});
    EXPECT_EQ(files(), std::vector<std::string>{"cube.off"});
}

TEST_F(Methods, AttributesAreKnownNamesAndAnObjHoldsAoAlone) {
    const auto refuse = [&](const std::string& output, const std::string& attributes,
                            const std::vector<std::string>& parts) {
        expect_refusal({"bake", "none.ply", "-o", output, "--attributes", attributes}, usage, parts);
    };
    refuse("b.ply", "ao,curvature", {"'curvature'", "ao, ", "convexity", "bent_normal", "thickness"});
    refuse("b.ply", "AO", {"'AO'"});
    refuse("b.ply", "ao,,convexity", {"''"});
    refuse("b.ply", "ao, convexity", {"' convexity'"});
    refuse("b.ply", "", {"--attributes"});
    for (const char* channel : {"convexity", "bent_normal", "thickness"}) {
        refuse("b.obj", channel, {"b.obj", channel, ".ply"});
        refuse("b.obj", std::string("ao,") + channel, {"b.obj", channel, ".ply"});
    }
    EXPECT_TRUE(files().empty());
}

/// The values of a vertex property; empty if there is no such property.
std::vector<double> property(const Mesh& mesh, std::string_view name) {
    const auto& document = dynamic_cast<const PlyDocument&>(*mesh.source);
    const PlyElement& vertices = *document.find("vertex");
    std::size_t offset = 0;
    for (const PlyProperty& p : vertices.properties) {
        if (p.name == name) {
            EXPECT_EQ(p.type, PlyType::float32) << name;
            std::vector<double> values;
            for (std::size_t v = 0; v < vertices.count; ++v)
                values.push_back(number_at(vertices.rows.data() + v * vertices.smallest_row() + offset, p.type));
            return values;
        }
        offset += size_of(p.type);
    }
    return {};
}

/// A box of 1 x 2 x 0.2, times `scale`.
std::string box_off(double scale) {
    std::string text = "OFF\n8 6 0\n";
    for (const auto& [x, y, z] :
         {std::tuple(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
        text += fmt::format("{} {} {}\n", scale * x, scale * 2 * y, scale * 0.2 * z);
    return text + "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 0 4 7 3\n";
}

TEST_F(Methods, ChannelsBecomePropertiesInTheUnitsOfTheScene) {
    std::vector<std::vector<double>> thickness;
    for (const double scale : {1.0, 1000.0}) {
        write("box.off", box_off(scale));
        const Outcome outcome = run({"bake", "box.off", "-o", "a.ply", "--method", "classic", "--radius", "20%",
                                     "--attributes", "ao,convexity,bent_normal,thickness", "--voxel", "1%", "--json"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        EXPECT_EQ(outcome.json().at("attributes"), "ao, convexity, bent_normal, thickness");
        const Mesh mesh = read_mesh(folder_ / "work/a.ply");
        for (const char* name : {"ao", "quality", "convexity", "bent_x", "bent_y", "bent_z", "thickness"}) {
            const std::vector<double> values = property(mesh, name);
            ASSERT_EQ(values.size(), 8u) << name;
            for (const double value : values)
                EXPECT_TRUE(std::isfinite(value)) << name;
        }
        EXPECT_TRUE(property(mesh, "ao_short").empty());
        for (const double value : property(mesh, "convexity"))
            EXPECT_GT(value, 0.7);
        const std::vector<double> x = property(mesh, "bent_x"), y = property(mesh, "bent_y"),
                                  z = property(mesh, "bent_z");
        for (std::size_t v = 0; v < 8; ++v) {
            EXPECT_NEAR(std::hypot(x[v], y[v], z[v]), 1.0, 1e-5);
            EXPECT_EQ(x[v] > 0.0, mesh.positions[v].x > 0.0) << "out of the box";
        }
        thickness.push_back(property(mesh, "thickness"));
    }
    for (std::size_t v = 0; v < 8; ++v) {
        EXPECT_GT(thickness[0][v], 0.0);
        EXPECT_LE(thickness[0][v], 0.2 * std::sqrt(5.04) * 1.000001);
        EXPECT_NEAR(thickness[1][v], 1000.0 * thickness[0][v], 0.01 * thickness[1][v]);
    }
}

}
}
