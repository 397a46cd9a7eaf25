#include "planning.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace alcove::cli {

void add_planning_options(CLI::App& verb, PlanningRequest& request) {
    verb.add_option_function<double>(
            "--error",
            [&request](const double& error) {
                if (!(error >= 1e-3 && error < 1.0))
                    throw UsageError(fmt::format("--error takes an RMSE from 0.001 to 1, not '{:g}'", error));
                request.error = error;
            },
            "Choose the cheapest method, rays and voxel whose RMSE against exact rays is at most E, "
            "0.001 to 1; goes without --method, --samples, --rays, --set, --voxel and --self")
        ->type_name("E");
    verb.add_flag_callback(
        "--no-pilot", [&request] { request.pilot = false; },
        "Do not measure the error of the bake at a few of its vertices");
}

void check_planning(const PlanningRequest& request, const CLI::App& verb) {
    if (!request.error)
        return;
    if (!request.pilot)
        throw UsageError("--error needs the pilot to hold it: leave out --no-pilot");
    for (const char* chosen : {"--method", "--samples", "--rays", "--set", "--voxel"})
        if (verb.count(chosen) > 0)
            throw UsageError(
                fmt::format("--error chooses method, rays and voxel itself: leave out {}", chosen));
    if (verb.get_option("--radius")->as<std::string>().ends_with("vx"))
        throw UsageError(
            "--error chooses the voxel that vx stands for: give --radius as 0.2 (scene units) or 10%");
    if (verb.count("--self") > 0)
        throw UsageError("--error plans the whole mesh, --self bakes its parts: leave out either");
}

}
