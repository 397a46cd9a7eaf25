/// Measures bakes from file to file: by the program, and by Embree alone at the same error.
#pragma once

#include "timing.h"

#include "alcove/measure/measure.h"

#include <alcove/alcove.h>

#include <filesystem>
#include <map>
#include <string>

namespace alcove::docs {

/// A method with its samples and voxel, and the RMSE it reaches.
struct Choice {
    MethodChoice method;
    float voxel; ///< in unit space; 0 without a grid
    double rmse;

    std::string text() const; ///< "guided:4, voxel 1/64"
};

struct Bake {
    Choice choice{};
    double seconds = 0.0;
    std::map<std::string, double> phases{}; ///< wall-clock seconds of start, read, grid, occlusion and write
    std::size_t peak_rss_bytes = 0;
};

/// Runs `alcove bake` without its pilot.
Bake bake_once(const std::filesystem::path& file, const Choice& choice, double radius);

/// Returns the run of median time out of three.
Bake bake_median(const std::filesystem::path& file, const Choice& choice, double radius);

/// Describes time, memory and plan of a bake with --error and --json.
std::string outcome_of(const Run& bake);

struct Comparison {
    Bake ours;
    double planned_seconds;           ///< of a bake with --error
    int rays;                         ///< per vertex, of Embree alone
    double plain_rmse, plain_seconds; ///< of Embree alone
};

/// Measures the error of choices on a mesh at a radius of 10 %.
class MeasuredChoices {
  public:
    explicit MeasuredChoices(const std::filesystem::path& file);

    std::size_t vertices() const { return mesh_.surfels.size(); }
    /// Compares the cheapest of our choices that meets the error with Embree alone, with as many rays as it needs to
    /// meet the error.
    Comparison compare(double error) const;

  private:
    double rmse(const MethodChoice& choice, float voxel) const;
    int rays_for(double error) const;

    std::filesystem::path file_;
    MeasuredMesh mesh_;
    Truth truth_;
    std::map<float, MeasuredGrid> grids_;
};

}
