/// How exact a bake is to be, or is found to be.
#pragma once

#include "common.h"

#include <optional>

namespace alcove::cli {

struct PlanningRequest {
    std::optional<double> error{}; ///< RMSE to hold, > 0; else the method is chosen by name
    bool pilot = true;             ///< tells the error of what was baked
};

/// Adds --error and --no-pilot.
void add_planning_options(CLI::App& verb, PlanningRequest& request);

/// \throw UsageError where the other options leave nothing to plan, or nothing to hold the error by.
void check_planning(const PlanningRequest& request, const CLI::App& verb);

}
