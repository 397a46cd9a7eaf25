#include "program.h"

#include "alcove/mesh/files.h"
#include "alcove/occlusion/catalog.h"

#include "shapes.h"

#include <fstream>
#include <set>

namespace alcove::test {
namespace {

using Json = nlohmann::ordered_json;

class Measure : public ProgramTest {
  protected:
    /// Two spheres that almost touch.
    void SetUp() override {
        Mesh mesh = sphere_mesh(2);
        add_part(mesh, sphere_mesh(2), 1.0, {2.1, 0, 0});
        write_mesh(mesh, folder_ / "work/spheres.ply");
    }

    Json results() const { return Json::parse(bytes_of("r.json")).at("measurements"); }
    void keep(const Json& measurements) const { write("r.json", Json{{"measurements", measurements}}.dump()); }
};

TEST_F(Measure, MeasuresEveryMethodAndReportsIt) {
    const Outcome outcome = run({"measure", "spheres.ply", "--voxel", "2%", "--json", "r.json", "--report", "r.html"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    const std::string page = bytes_of("r.html");
    std::set<std::string> measured;
    for (const Json& m : results()) {
        SCOPED_TRACE(m.at("asked").dump());
        measured.insert(m.at("method").get<std::string>());
        EXPECT_EQ(m.at("vertices"), 132);
        EXPECT_EQ(m.at("compared"), 132);
        EXPECT_GT(m.at("rmse"), 0.0);
        EXPECT_LT(m.at("rmse"), 1.0);
        EXPECT_GE(m.at("max"), m.at("percentile_99"));
        EXPECT_GE(m.at("percentile_99"), 0.0);
        EXPECT_GT(m.at("truth_deviation"), 0.02);
        EXPECT_GT(m.at("cpu_seconds").at("total"), 0.0);
        EXPECT_GT(m.at("map_calls").get<double>() + m.at("rays").get<double>(), 0.0);
        EXPECT_TRUE(m.at("picture").get<std::string>().starts_with("data:image/png;base64,"));
    }
    for (const Method& method : catalog())
        if (method.gives.has(Channel::ao)) {
            EXPECT_TRUE(measured.contains(std::string(method.name))) << method.name;
            EXPECT_NE(page.find("<td>" + std::string(method.name)), std::string::npos) << method.name;
            EXPECT_NE(outcome.out.find(method.name), std::string::npos) << method.name;
        }
}

TEST_F(Measure, TakesListsOfLengthsAndMethods) {
    const Outcome outcome = run({"measure", "spheres.ply", "--voxel", "2%,4%", "--radius", "10%,30%", "--methods",
                                 "exact:1024,classic,classic:5", "--json", "r.json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    std::multiset<std::string> asked;
    for (const Json& m : results()) {
        asked.insert(m.at("method").get<std::string>() + " " + m.at("asked").at("radius").get<std::string>() + " " +
                     m.at("asked").at("voxel").dump());
        if (m.at("method") == "exact") {
            EXPECT_LT(m.at("rmse"), 0.01);
            EXPECT_EQ(m.at("rays"), 1024);
        }
    }
    EXPECT_EQ(asked, (std::multiset<std::string>{"exact 10% null", "exact 30% null", "classic 10% \"2%\"",
                                                 "classic 10% \"4%\"", "classic 30% \"2%\"", "classic 30% \"4%\""}));
}

TEST_F(Measure, GoesOnWhereItWasCutOff) {
    const std::vector<std::string> command{
        "measure", "spheres.ply", "--voxel", "4%", "--methods", "classic,exact:4,decay,jittered", "--json", "r.json"};
    ASSERT_EQ(run(command).code, done);
    Json first = results();
    ASSERT_EQ(first.size(), 4u);
    // Marks distinguish cached results from new ones.
    first.erase(first.begin() + 2);
    for (Json& m : first)
        m["rmse"] = 0.125;
    keep(first);
    ASSERT_EQ(run(command).code, done);
    const Json second = results();
    ASSERT_EQ(second.size(), 4u);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(second[i], first[i]);
    EXPECT_NE(second[3].at("rmse"), 0.125);

    // Another radius, or another file of the same name, must not reuse cached results.
    std::vector<std::string> wider = command;
    wider.insert(wider.end(), {"--radius", "20%"});
    ASSERT_EQ(run(wider).code, done);
    EXPECT_EQ(results().size(), 8u);
    write("spheres.ply", bytes_of("spheres.ply") + "\n");
    ASSERT_EQ(run(command).code, done);
    EXPECT_EQ(results().size(), 12u);
}

TEST_F(Measure, LosesNothingToAMeshThatCannotBeMeasured) {
    write("broken.ply", "ply\nno\n");
    const Outcome outcome = run({"measure", "broken.ply", "none.ply", "spheres.ply", "--voxel", "4%", "--methods",
                                 "classic", "--json", "r.json", "--report", "r.html"});
    EXPECT_EQ(outcome.code, bad_input) << outcome.err;
    EXPECT_NE(outcome.err.find("broken.ply: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("none.ply: "), std::string::npos) << outcome.err;
    ASSERT_EQ(results().size(), 1u);
    EXPECT_EQ(results().front().at("mesh"), "spheres.ply");
    EXPECT_NE(bytes_of("r.html").find("spheres.ply"), std::string::npos);
}

TEST_F(Measure, RefusesWhatCannotBeMeantBeforeAnyWork) {
    const auto refused = [&](const std::string& option, const std::string& value, const std::string& part) {
        expect_refusal({"measure", "none.ply", option, value}, usage, {option, part});
    };
    refused("--methods", "multiscale:4", "multiscale takes no number");
    refused("--methods", "exact:0", "not 0");
    refused("--methods", "exact:x", "'exact:x'");
    refused("--radius", "10%,x", "'x'");
    refused("--radius", "", "''");
    refused("--radius", "3vx", "vx");
    refused("--voxel", "3vx", "'3vx'");
    refused("--voxel", "inf", "'inf'");
    expect_refusal({"measure", "none.ply", "--methods", "clasic"}, usage, {"no method 'clasic'", "classic"});
    expect_refusal({"measure", "none.ply", "--methods", ","}, usage, {"no method ''"});
    expect_refusal({"measure", "none.ply", "--report", "no/such/r.html"}, failure, {"no/such/r.html"});
    write("mine.json", "{\"my\": 1}");
    expect_refusal({"measure", "spheres.ply", "--json", "mine.json"}, bad_input, {"mine.json", "another file"});
    EXPECT_EQ(bytes_of("mine.json"), "{\"my\": 1}");
}

}
}
