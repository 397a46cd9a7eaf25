#include "alcove/bake/detail/planned_bake.h"

#include "alcove/bake/detail/plan_table.h"
#include "alcove/base/errors.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/measure/measure.h"
#include "real_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace alcove {
namespace {

constexpr float radius = 0.1f;

class Planning : public testing::Test {
  protected:
    PlanRequest request(double error) const {
        return {.error = error,
                .radius = radius,
                .surfels = mesh_.surfels.size(),
                .triangles = mesh_.triangles.size(),
                .area = surface_size(mesh_.mesh, mesh_.triangles).area};
    }

    struct Expected {
        Plan plan;
        double seconds; ///< of all bakes
    };
    /// Where each bake comes to what is expected.
    Expected expected(const PlanRequest& wanted) const {
        Planner planner(wanted, pilot_);
        Expected result{planner.next(), 0.0};
        result.seconds = result.plan.seconds;
        while (result.plan.rmse > wanted.error) { // tried before what is expected to hold the error
            planner.learn(result.plan, result.plan.rmse);
            result.plan = planner.next();
            result.seconds += result.plan.seconds;
        }
        return result;
    }

    MeasuredMesh mesh_{"bunny00", test::RealMesh("bunny00.off").mesh}; // the table never saw it
    Pilot pilot_{mesh_.surfels, mesh_.rays, radius};
};

TEST_F(Planning, CostsMoreTheSmallerTheError) {
    for (const bool has_grid : {false, true}) {
        double cheaper = 0.0;
        for (const double error : {0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005}) {
            PlanRequest wanted = request(error);
            wanted.has_grid = has_grid;
            const auto& [plan, seconds] = expected(wanted);
            EXPECT_GE(seconds, cheaper) << error;
            EXPECT_LE(plan.rmse, error);
            cheaper = seconds;
        }
    }
}

TEST_F(Planning, ProbesWhereAGridIsThereOrMeshesAreLarge) {
    PlanRequest wanted = request(0.03);
    EXPECT_EQ(Planner(wanted, pilot_).next().choice.method->name, "exact");
    wanted.has_grid = true;
    EXPECT_TRUE(Planner(wanted, pilot_).next().choice.method->needs_grid);
    wanted.has_grid = false;
    wanted.error = 0.01;
    wanted.surfels = 100'000'000; // of the same triangles: rays cost, the grid does not
    const Plan plan = Planner(wanted, pilot_).next();
    EXPECT_EQ(plan.choice.method->name, "guided");
    EXPECT_GT(plan.largest_voxel, 0.0f);
}

TEST_F(Planning, TakesNoGridThatDoesNotFit) {
    PlanRequest wanted = request(0.05);
    wanted.surfels = 100'000'000; // grids would be by far the cheapest
    EXPECT_GT(Planner(wanted, pilot_).next().largest_voxel, 0.0f);
    wanted.finest_voxel = INFINITY;
    EXPECT_EQ(Planner(wanted, pilot_).next().choice.method->name, "exact");
    wanted.finest_voxel = 1.0 / 100.0;
    EXPECT_EQ(Planner(wanted, pilot_).next().largest_voxel, 1.0f / 64.0f);
}

TEST_F(Planning, ChoosesCountsOfRaysBetweenThoseOfTheTable) {
    std::set<double> rays, of_table;
    for (const plan_table::Row& row : plan_table::rows)
        of_table.insert(row.samples);
    double last = 0.0;
    for (double error = 0.02; error > 0.009; error *= 0.98) {
        PlanRequest wanted = request(error);
        wanted.has_grid = true;
        wanted.surfels = 100'000'000;
        const Plan plan = expected(wanted).plan;
        ASSERT_EQ(plan.choice.method->name, "guided") << error;
        EXPECT_GE(plan.choice.rays(), last) << error;
        last = plan.choice.rays();
        if (!of_table.contains(last)) {
            EXPECT_NEAR(plan.rmse, 0.95 * error, 1e-9);
            rays.insert(last);
        }
    }
    EXPECT_GE(rays.size(), 5u);
}

TEST_F(Planning, TriesAFewRaysBeforeMany) {
    PlanRequest wanted = request(0.009);
    wanted.surfels = 100'000'000; // of the same triangles: rays cost, the grid does not
    Planner planner(wanted, pilot_);
    const Plan few = planner.next();
    ASSERT_EQ(few.choice.method->name, "guided");
    EXPECT_GT(few.rmse, wanted.error);
    planner.learn(few, few.rmse);
    const Plan as_expected = planner.next();
    EXPECT_EQ(as_expected.choice.method->name, "guided");
    EXPECT_LE(as_expected.rmse, wanted.error);
    EXPECT_GE(as_expected.choice.rays(), 3 * few.choice.rays());

    Planner lucky(wanted, pilot_);
    lucky.learn(lucky.next(), 0.8 * few.rmse);
    EXPECT_LT(lucky.next().choice.rays(), as_expected.choice.rays());
}

TEST_F(Planning, TriesWhatIsFarCheaperAndMayHoldTheError) {
    PlanRequest wanted = request(0.0);
    wanted.surfels = 100'000'000;
    wanted.finest_voxel = 1.0 / 100.0; // leaves one grid
    const auto calibrated =
        std::find_if(plan_table::rows.begin(), plan_table::rows.end(), [](const plan_table::Row& row) {
            return row.method == "calibrated" && row.largest_voxel == 1.0f / 64;
        });
    static_assert(plan_table::radii[2] == 0.1);
    const double rmse = calibrated->error_per_difficulty[2] * pilot_.difficulty();
    const MethodChoice choice = choose(find_method("calibrated"), calibrated->samples);
    for (const double over : {0.95, 1.1}) {
        wanted.error = rmse / over;
        EXPECT_EQ(Planner(wanted, pilot_).next().choice, choice) << over;
    }
    Planner planner(wanted, pilot_);
    planner.learn(planner.next(), rmse);
    const Plan sure = planner.next();
    EXPECT_LE(sure.rmse, wanted.error) << "only one of a method is hoped for";

    wanted.error = rmse / 2.0;
    EXPECT_NE(Planner(wanted, pilot_).next().choice, choice) << "too far from it";
}

TEST_F(Planning, LearnsFromWhatItTried) {
    PlanRequest wanted = request(0.03);
    wanted.has_grid = true;
    Planner planner(wanted, pilot_);
    std::set<std::string> tried;
    Plan plan = planner.next();
    while (plan.largest_voxel > 0.0f) {
        EXPECT_TRUE(tried.insert(plan.choice.label()).second) << "tried again: " << plan.choice.label();
        planner.learn(plan, 0.2);
        plan = planner.next();
    }
    EXPECT_EQ(plan.choice.method->name, "exact");
    EXPECT_LE(tried.size(), 2u) << "one of guided and one of calibrated tell that none will do";
}

TEST_F(Planning, KeepsToMethodsThatGiveWhatIsWanted) {
    PlanRequest wanted = request(0.1);
    wanted.has_grid = true;
    wanted.wanted = Channel::ao | Channel::bent_normal;
    EXPECT_NE(Planner(wanted, pilot_).next().choice.method->name, "calibrated");
}

TEST_F(Planning, BakesByExactRaysWhereNoGridCanBeMade) {
    int asked = 0;
    const MakeField refuse = [&](float) -> AnyField {
        ++asked;
        throw LimitError("too many triangles");
    };
    PlanRequest wanted = request(0.01);
    wanted.triangles = 1000; // as if grids were cheaper than they are
    const PlannedBake planned = bake_planned(mesh_.surfels, mesh_.rays, refuse, pilot_, wanted);
    EXPECT_EQ(planned.plan.choice.method->name, "exact");
    EXPECT_LE(planned.rmse, wanted.error);
    EXPECT_GE(asked, 1);
    EXPECT_LE(asked, 2) << "more than once for a voxel";
}

TEST_F(Planning, BakesHoldTheirErrorWhateverTheField) {
    const Truth truth = make_truth(mesh_, radius, {.rays = 1024, .most = 5000});
    int made = 0;
    for (const bool useful : {true, false}) {
        const MakeField make_field = [&](float voxel) -> AnyField {
            ++made;
            if (useful)
                return build_grid(mesh_, radius, chosen_voxel(radius, voxel)).field;
            return Plane{{0, 1, 0}, -10.0f};
        };
        for (const double error : {0.05, 0.03}) {
            PlanRequest wanted = request(error);
            wanted.has_grid = true;
            made = 0;
            const PlannedBake planned = bake_planned(mesh_.surfels, mesh_.rays, make_field, pilot_, wanted);
            std::vector<float> values;
            for (const std::uint32_t vertex : truth.vertices)
                values.push_back(planned.values[Channel::ao][vertex]);
            const double rmse = compare(values, truth.ao).rmse;
            EXPECT_LE(rmse, 1.15 * error) << planned.plan.choice.label();
            EXPECT_NEAR(planned.rmse, rmse, 0.3 * rmse) << planned.plan.choice.label();
            EXPECT_EQ(made, 1);
            if (useful)
                EXPECT_NE(planned.plan.choice.method->name, "exact") << error;
            else
                EXPECT_FALSE(planned.failed.empty()) << error;
        }
    }
}

}
}
