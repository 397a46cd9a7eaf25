/// A table of extreme cases: the change to a mesh, the required result, and the actual one.
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

/// A number and its upper bound.
struct Figure {
    std::string of; ///< usually the method
    double value = 0.0, bound = 0.0;

    bool holds() const { return value <= bound; } ///< false for NaN
};

struct Result {
    std::vector<Figure> figures{};
    std::string note{}; ///< the text of an error or warnings, or what was lost beforehand
};

/// One row of the table.
struct Extreme {
    std::string group, name; ///< "scale", "1e-30"
    std::string must;        ///< an invariance, an analytic value, a bound or an error
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

/// How a mesh is baked. Lengths are in unit space.
struct Baking {
    float radius = 0.1f, voxel = 0.0f;
    SignChoice sign = SignChoice::automatic;
    int rays = 0; ///< 0: the default of the method
};

/// Names of methods.
using Methods = std::vector<std::string_view>;
inline const Methods all_kinds = {"traced", "guided", "exact", "calibrated", "classic"};

/// A mesh with its grids, to be baked by several methods.
class Baked {
  public:
    explicit Baked(const Mesh& mesh, const Baking& baking = {});

    /// One value per vertex. \throw std::runtime_error if a value is not in [0, 1].
    std::vector<float> by(std::string_view method) const;
    /// Whether each vertex is inside the solid. It counts as inside if a point above it, within a voxel, is inside.
    std::vector<bool> buried() const;
    /// The ao by 1,024 exact rays.
    std::vector<float> truth() const;
    std::vector<std::string> warnings() const;
    /// The voxel that resolves the walls too thin for the grid, in unit space; 0 if there are none.
    float resolving_voxel() const { return walls_.noticeable() ? walls_.voxel : 0.0f; }
    const MeasuredMesh& mesh() const { return mesh_; }

  private:
    Baking baking_;
    MeasuredMesh mesh_;
    GridStack stack_;
    Occluders occluders_;
    ThinWalls walls_;
};

/// The RMSE of each method against exact rays, with the warnings as the note.
Result against_exact(const Baked& baked, const Methods& methods, double bound);

/// The largest difference of each method from one value, with the warnings as the note.
Result against_value(const Baked& baked, float value, const Methods& methods, double bound);

/// For each method, the largest difference between the values on both meshes, or the RMSE, at the vertices of
/// `reference`. These must be the first vertices of `mesh`.
Result against(const Mesh& reference, const Mesh& mesh, const Methods& methods, double bound);
Result rmse_against(const Mesh& reference, const Mesh& mesh, const Methods& methods, double bound);

/// A figure of 0 if `attempt` throws an E, with its message as the note; otherwise infinity.
template <class E>
Result refused(const std::function<void()>& attempt) {
    try {
        attempt();
    } catch (const E& refusal) {
        return {{{"refused", 0.0, 0.0}}, refusal.what()};
    }
    return {{{"refused", std::numeric_limits<double>::infinity(), 0.0}}};
}

/// A closed surface with bumps and hollows. Its 4,098 vertices are about 1 from the origin.
Mesh bumpy();

/// A base with `fins` walls on it, which are 0.1 high and `thickness` thick, with gaps of `gap` between them. D is
/// about 1; lengths are in scene units. `turned` rotates it off the axes of the grid.
Mesh comb(int fins, double thickness, double gap, bool turned);

}
