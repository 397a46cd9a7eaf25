/// Measures methods on several meshes, at several radii and voxels.
#pragma once

#include "alcove/measure/measure.h"

#include <optional>
#include <string>
#include <vector>

namespace alcove {

/// A length, and its text, by which the file of results identifies the length.
struct WrittenLength {
    std::string text;
    Length length;
};

struct SweepOptions {
    std::vector<std::string> meshes;   ///< files; .vdb: the zero isosurface of its level sets
    std::vector<WrittenLength> radii;  ///< not in voxels
    std::vector<WrittenLength> voxels; ///< of the finest level, not in voxels; 0: chosen automatically
    std::vector<MethodChoice> methods; ///< those that need no grid are measured once per radius
    std::optional<Length> weld{};      ///< join vertices first, as join_vertices()
    std::string results{};             ///< JSON file: its measurements are reused, and new ones added; empty: none
    Pictures pictures = Pictures::none;
    Progress progress{};
};

struct Sweep {
    std::vector<Measurement> measurements; ///< without duplicates; measurements of the same mesh are adjacent
    std::vector<std::string> failures;     ///< one message per mesh that cannot be measured
    bool bad_input = false;                ///< whether any failure was not a MemoryError
};

/// Measures every method at every radius and voxel on every mesh. Builds each grid and each reference once. \throw
/// InputError and IoError for the file of results. Not thread-safe, see measure.h.
Sweep sweep(const SweepOptions& options);

}
