/// The extremes that results must stand, as one table: what is done to a mesh, what must come of it, and what does.
#pragma once

#include "alcove/grid/voxelize.h"
#include "alcove/measure/measure.h"
#include "alcove/occlusion/detail/thin_walls.h"

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace alcove::extremes {

/// A number, and what it may be at most.
struct Figure {
    std::string of; ///< the method, as a rule
    double value = 0.0, bound = 0.0;

    bool holds() const { return value <= bound; } ///< NaN never does
};

struct Result {
    std::vector<Figure> figures{};
    std::string note{}; ///< a refusal or a warning in its own words, or what was lost beforehand
};

/// One row of the table.
struct Extreme {
    std::string group, name; ///< "scale", "1e-30"
    std::string must;        ///< an invariance, an analytic value, a bound or a refusal
    std::function<Result()> run;
};

/// All rows, group by group.
std::vector<Extreme> all_extremes();

std::vector<Extreme> scales();
std::vector<Extreme> offsets();
std::vector<Extreme> shapes();
std::vector<Extreme> damages();
std::vector<Extreme> thin_features();
std::vector<Extreme> settings();

/// How a mesh is baked; lengths in unit space.
struct Baking {
    float radius = 0.1f, voxel = 0.0f;
    SignChoice sign = SignChoice::automatic;
    int rays = 0; ///< 0: as many as is standard
};

/// Names of methods.
using Methods = std::vector<std::string_view>;
inline const Methods all_kinds = {"traced", "guided", "exact", "calibrated", "classic"};

/// A mesh with its grids, baked by one method after the other.
class Baked {
  public:
    explicit Baked(const Mesh& mesh, const Baking& baking = {});

    /// One a vertex. The first value that is not in [0, 1] is told by an exception.
    std::vector<float> by(std::string_view method) const;
    /// Whether a vertex is inside of the solid: so is a place within a voxel above it.
    std::vector<bool> buried() const;
    /// By 1,024 exact rays.
    std::vector<float> truth() const;
    std::vector<std::string> warnings() const;
    /// That walls too thin for the grid would take, unit space; 0 where there are none.
    float resolving_voxel() const { return walls_.noticeable() ? walls_.voxel : 0.0f; }
    const MeasuredMesh& mesh() const { return mesh_; }

  private:
    Baking baking_;
    MeasuredMesh mesh_;
    GridStack stack_;
    Occluders occluders_;
    ThinWalls walls_;
};

/// The RMSE of each method against exact rays, with the warnings as its note.
Result against_exact(const Baked& baked, const Methods& methods, double bound);

/// The largest difference of each method from one value, with the warnings as its note.
Result against_value(const Baked& baked, float value, const Methods& methods, double bound);

/// The largest difference of each method, or the RMSE, at the vertices of `reference`, which are the first of the mesh.
Result against(const Mesh& reference, const Mesh& mesh, const Methods& methods, double bound);
Result rmse_against(const Mesh& reference, const Mesh& mesh, const Methods& methods, double bound);

/// A figure of 0 where `attempt` throws an E, with its message as the note; else infinity.
template <class E>
Result refused(const std::function<void()>& attempt) {
    try {
        attempt();
    } catch (const E& refusal) {
        return {{{"refused", 0.0, 0.0}}, refusal.what()};
    }
    return {{{"refused", std::numeric_limits<double>::infinity(), 0.0}}};
}

/// A closed surface with bumps and hollows, 4,098 vertices around the origin, about 1 from it.
Mesh bumpy();

/// A block with thin walls on it: `fins` of that thickness, with gaps between, on a foot; all walls 0.1 high, D about 1.
/// Lengths in scene units. Off the axes of the grid where `turned`.
Mesh comb(int fins, double thickness, double gap, bool turned);

}
