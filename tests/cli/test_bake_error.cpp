#include "baked.h"
#include "extreme.h"
#include "program.h"

#include "alcove/measure/measure.h"
#include "alcove/mesh/files.h"

#include <cmath>

namespace alcove::test {
namespace {

class BakeError : public ProgramTest {
  protected:
    /// The RMSE of a bake at a radius of 10 %, against 1,024 exact rays per vertex.
    double error_of(const std::string& mesh_file, const std::string& output) const {
        const MeasuredMesh mesh(mesh_file, read_mesh(folder_ / mesh_file)); // an absolute path stays as it is
        const Truth truth = make_truth(mesh, 0.1f);
        const std::vector<float> ao = read_baked(folder_ / "work" / output).ao;
        std::vector<float> values;
        for (const std::uint32_t vertex : truth.vertices)
            values.push_back(ao[vertex]);
        return compare(values, truth.ao).rmse;
    }
};

TEST_F(BakeError, IsHeldAndTold) {
    const std::string mesh = real_mesh("elephant.off");
    for (const char* error : {"0.03", "0.01", "0.005"}) {
        const Outcome outcome = run({"bake", mesh, "-o", "a.ply", "--error", error, "--json"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        const double rmse = error_of(mesh, "a.ply"), wanted = std::stod(error);
        EXPECT_LE(rmse, 1.15 * wanted);
        EXPECT_GT(rmse, 0.3 * wanted) << "more exact than requested, and so more expensive";
        EXPECT_NEAR(outcome.json().at("estimated_rmse").get<double>(), rmse, 0.3 * rmse);
        EXPECT_GT(outcome.json().at("samples"), 0);
    }
}

TEST_F(BakeError, IsToldOfEveryMethodAndPartByDefault) {
    const std::string mesh = real_mesh("elephant.off");
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--method", "classic"}, {"--method", "guided"}, {"--self"}}) {
        std::vector<std::string> arguments{"bake", mesh, "-o", "a.ply", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.code, done) << outcome.err;
        const double rmse = error_of(mesh, "a.ply");
        EXPECT_NEAR(outcome.json().at("estimated_rmse").get<double>(), rmse, 0.3 * rmse) << more.back();
        EXPECT_GT(outcome.json().at("seconds").at("pilot"), 0.0);
    }
    const Outcome bare = run({"bake", mesh, "-o", "a.ply", "--json", "--no-pilot", "--method", "traced"});
    EXPECT_TRUE(bare.json().at("estimated_rmse").is_null());
    EXPECT_EQ(run({"bake", mesh, "-o", "a.ply", "--json", "--attributes", "convexity", "--method", "classic"})
                  .json()
                  .at("estimated_rmse"),
              nullptr);
}

TEST_F(BakeError, CountsSurroundingsAndGoesWithOtherAttributes) {
    const std::string mesh = real_mesh("elephant.off");
    const Outcome outcome = run({"bake", mesh, "-o", "a.ply", "--error", "0.02", "--json", "--ground", "--attributes",
                                 "ao,bent_normal,thickness"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_LE(outcome.json().at("estimated_rmse"), 0.02);
    const Baked baked = read_baked(folder_ / "work/a.ply");
    EXPECT_EQ(baked.ao.size(), 2775u);
}

/// Rays miss fins thinner than a voxel. The warning names a voxel that resolves them, or a method that does not depend
/// on it. The bake uses the normals of the faces: with other normals, the grid's rounding of the rims causes a larger
/// error than thin walls do.
TEST_F(BakeError, OfThinWallsComesWithTheVoxelThatMendsIt) {
    write_mesh(extremes::comb(24, 0.5 / 256, 2.0 / 256, true), folder_ / "work/fins.ply");
    const std::vector<std::string> bake{"bake", "fins.ply", "-o", "a.ply", "--json", "--normals", "area"};
    const auto baked = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = bake;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done) << outcome.err;
        return outcome.json();
    };
    const auto coarse = baked({"--method", "traced"});
    EXPECT_GT(coarse.at("estimated_rmse"), 0.1);
    const auto warnings = coarse.at("warnings");
    ASSERT_EQ(warnings.size(), 1u);
    const auto warning = warnings.front().get<std::string>();
    const auto at = warning.find("--voxel ");
    ASSERT_NE(at, std::string::npos) << warning;
    const std::string voxel = warning.substr(at + 8, warning.find(',', at) - at - 8);
    for (const std::vector<std::string>& fix : {std::vector<std::string>{"--method", "traced", "--voxel", voxel},
                                                {"--method", "guided"},
                                                {"--error", "0.03"}}) {
        const auto fixed = baked(fix);
        EXPECT_TRUE(fixed.at("warnings").empty()) << fixed.dump();
        EXPECT_LE(fixed.at("estimated_rmse"), 0.035) << fix.front();
    }
}

TEST_F(BakeError, GoesWithWhatLeavesSomethingToChoose) {
    write("cube.off", cube_off);
    const std::vector<std::string> planned{"bake", "cube.off", "-o", "a.ply", "--error", "0.02"};
    const std::vector<std::vector<std::string>> chosen{{"--rays", "4"},     {"--samples", "4"},
                                                       {"--set", "rays=4"}, {"--no-pilot"},
                                                       {"--radius", "8vx"}, {"--attributes", "convexity"}};
    for (const std::vector<std::string>& more : chosen) {
        std::vector<std::string> arguments = planned;
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_refusal(arguments, usage, {});
    }
    for (const char* error : {"--error=0.02", "--quality=draft"})
        for (const char* method : {"guided", "traced"})
            expect_refusal({"bake", "cube.off", "-o", "a.ply", "--method", method, "--rays", "4", error}, usage,
                           {"--rays cannot be combined with --error or --quality"});
    for (const char* error : {"0", "-1", "2", "nan"})
        expect_refusal({"bake", "cube.off", "-o", "a.ply", "--error", error}, usage, {"0.001"});
}

}
}
