#include "alcove/bake/detail/planner.h"

#include "alcove/bake/detail/plan_table.h"
#include "alcove/base/types.h"
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
    /// The first plan that meets the error if every bake has exactly its expected error.
    Expected expected(const PlanRequest& wanted) const {
        Planner planner(wanted, pilot_);
        Expected result{planner.next(), 0.0};
        result.seconds = result.plan.seconds;
        while (result.plan.rmse > wanted.error) { // trials before the plan that is expected to meet the error
            planner.update(result.plan, result.plan.rmse);
            result.plan = planner.next();
            result.seconds += result.plan.seconds;
        }
        return result;
    }

    MeasuredMesh mesh_{"bunny00", test::RealMesh("bunny00.off").mesh}; // the table was not measured on it
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
    wanted.surfels = 100; // a grid costs more than their rays
    EXPECT_EQ(Planner(wanted, pilot_).next().choice.method->name, "exact");
    wanted.surfels = mesh_.surfels.size();
    wanted.has_grid = true;
    EXPECT_TRUE(Planner(wanted, pilot_).next().choice.method->needs_grid);
    wanted.has_grid = false;
    wanted.error = 0.01;
    wanted.surfels = 100'000'000; // with the same triangles: rays dominate the cost, not the grid
    const Plan plan = Planner(wanted, pilot_).next();
    EXPECT_TRUE(plan.choice.method->needs_grid);
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
        wanted.method = &find_method("guided");
        wanted.has_grid = true;
        wanted.surfels = 100'000'000;
        const Plan plan = expected(wanted).plan;
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
    wanted.method = &find_method("guided");
    wanted.surfels = 100'000'000; // with the same triangles: rays dominate the cost, not the grid
    Planner planner(wanted, pilot_);
    const Plan few = planner.next();
    ASSERT_EQ(few.choice.method->name, "guided");
    EXPECT_GT(few.rmse, wanted.error);
    planner.update(few, few.rmse);
    const Plan as_expected = planner.next();
    EXPECT_EQ(as_expected.choice.method->name, "guided");
    EXPECT_LE(as_expected.rmse, wanted.error);
    EXPECT_GE(as_expected.choice.rays(), 3 * few.choice.rays());

    Planner lucky(wanted, pilot_);
    lucky.update(lucky.next(), 0.8 * few.rmse);
    EXPECT_LT(lucky.next().choice.rays(), as_expected.choice.rays());
}

TEST_F(Planning, TriesWhatIsFarCheaperAndMayHoldTheError) {
    PlanRequest wanted = request(0.0);
    wanted.surfels = 100'000'000;
    wanted.finest_voxel = 1.0 / 100.0; // leaves one grid
    static_assert(plan_table::radii[2] == 0.1);
    double least = INFINITY, most = 0.0; // errors of calibrated
    for (const plan_table::Row& row : plan_table::rows)
        if (row.method == "calibrated" && row.largest_voxel == 1.0f / 64) {
            least = std::min(least, row.error_per_difficulty[2] * pilot_.difficulty());
            most = std::max(most, row.error_per_difficulty[2] * pilot_.difficulty());
        }
    const auto is_calibrated = [](const Plan& plan) { return plan.choice.method->name == "calibrated"; };
    wanted.error = most / 0.95;
    EXPECT_TRUE(is_calibrated(Planner(wanted, pilot_).next()));
    wanted.error = least / 1.1; // a trial
    Planner planner(wanted, pilot_);
    const Plan trial = planner.next();
    EXPECT_TRUE(is_calibrated(trial));
    planner.update(trial, 1.5 * trial.rmse);
    EXPECT_FALSE(is_calibrated(planner.next())) << "it is ruled out";
    wanted.error = least / 2.0;
    EXPECT_FALSE(is_calibrated(Planner(wanted, pilot_).next())) << "too unlikely to meet the error";
}

TEST_F(Planning, LearnsFromWhatItTried) {
    PlanRequest wanted = request(0.03);
    wanted.has_grid = true;
    Planner planner(wanted, pilot_);
    std::set<std::string> tried;
    Plan plan = planner.next();
    while (plan.largest_voxel > 0.0f) {
        EXPECT_TRUE(tried.insert(plan.choice.label()).second) << "tried again: " << plan.choice.label();
        planner.update(plan, 0.2);
        plan = planner.next();
    }
    EXPECT_EQ(plan.choice.method->name, "exact");
    EXPECT_LE(tried.size(), 2u) << "one bake each of guided and calibrated rules out the rest";
}

TEST_F(Planning, KeepsToMethodsThatGiveWhatIsWanted) {
    PlanRequest wanted = request(0.1);
    wanted.has_grid = true;
    wanted.wanted = Channel::ao | Channel::bent_normal;
    EXPECT_NE(Planner(wanted, pilot_).next().choice.method->name, "calibrated");
}

TEST_F(Planning, ViaGridAvoidsExactRaysUnlessTheFieldCostsFarMore) {
    PlanRequest wanted = request(0.03);
    wanted.via = Via::grid;
    const Plan field = Planner(wanted, pilot_).next();
    EXPECT_TRUE(field.choice.method->needs_grid) << "a fraction of a second more is allowed";
    EXPECT_EQ(field.reason, "");

    wanted.area = 1e4; // a grid that takes many seconds, for few surfels
    const Plan exact = Planner(wanted, pilot_).next();
    EXPECT_EQ(exact.choice.method->name, "exact");
    EXPECT_NE(exact.reason.find("would cost about"), std::string::npos) << exact.reason;

    wanted = request(0.03);
    wanted.via = Via::grid;
    wanted.finest_voxel = INFINITY;
    EXPECT_NE(Planner(wanted, pilot_).next().reason.find("no grid"), std::string::npos);
}

TEST_F(Planning, ViaGridRaisesRaysOfGuidedAndThenTakesExact) {
    PlanRequest wanted = request(0.02);
    wanted.via = Via::grid;
    wanted.allowed_seconds = INFINITY;
    Planner planner(wanted, pilot_);
    Plan plan = planner.next();
    int tries = 0;
    for (; plan.largest_voxel > 0.0f && tries < 50; ++tries) {
        EXPECT_FALSE(planner.is_last(plan));
        planner.update(plan, 0.2);
        plan = planner.next();
    }
    EXPECT_EQ(plan.choice.method->name, "exact");
    EXPECT_TRUE(planner.is_last(plan));
    EXPECT_NE(plan.reason.find("missed"), std::string::npos) << plan.reason;
    EXPECT_LE(tries, 4) << "calibrated, then guided with more and more rays";

    Planner close(wanted, pilot_);
    const Plan first = close.next();
    close.update(first, 1.05 * wanted.error);
    EXPECT_NE(close.next().choice.method->name, "exact") << "a few more rays suffice";
}

TEST_F(Planning, ViaMeshTakesExactRays) {
    PlanRequest wanted = request(0.05);
    wanted.via = Via::mesh;
    wanted.surfels = 100'000'000;
    const Plan plan = Planner(wanted, pilot_).next();
    EXPECT_EQ(plan.choice.method->name, "exact");
    EXPECT_EQ(plan.reason, "");
}

TEST_F(Planning, KeepsToTheNamedMethod) {
    for (const char* name : {"exact", "guided", "calibrated"}) {
        PlanRequest wanted = request(0.02);
        wanted.via = Via::grid;
        wanted.method = &find_method(name);
        Planner planner(wanted, pilot_);
        for (int tries = 0; tries < 40; ++tries) {
            const Plan plan = planner.next();
            ASSERT_EQ(plan.choice.method->name, name);
            if (planner.is_last(plan))
                break;
            planner.update(plan, 0.2);
        }
    }
}

}
}
