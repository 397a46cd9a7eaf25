/// Bakes from file to file by the program, and what Embree alone takes for the same error.
#pragma once

#include "timing.h"

#include <alcove/alcove.h>

#include <filesystem>
#include <map>
#include <string>

namespace alcove::docs {

/// A method, what it is given and what it comes to.
struct Choice {
    MethodChoice method;
    float voxel; ///< unit space; 0 for none
    double rmse;

    std::string text() const; ///< "guided:4, voxel 1/64"
};

struct Bake {
    Choice choice{};
    double seconds = 0.0;
    std::map<std::string, double> phases{}; ///< wall clock of start, read, grid, occlusion and write
    std::size_t peak_rss_bytes = 0;
};

/// Of `alcove bake`, without its pilot.
Bake bake_once(const std::filesystem::path& file, const Choice& choice, double radius);

/// That of three runs whose seconds are in the middle.
Bake bake_median(const std::filesystem::path& file, const Choice& choice, double radius);

/// Seconds, memory and plan of a bake with --error and --json, in words.
std::string outcome_of(const Run& bake);

struct Comparison {
    Bake ours;
    double planned_seconds; ///< of --error
    int rays;               ///< of Embree alone
    double plain_rmse, plain_seconds;
};

/// What can be had on a mesh at a radius of 10 %.
class MeasuredChoices {
  public:
    explicit MeasuredChoices(const std::filesystem::path& file);

    std::size_t vertices() const { return mesh_.surfels.size(); }
    /// The cheapest of ours, and Embree alone with as many rays as it takes.
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
