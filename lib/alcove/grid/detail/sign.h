/// Decides whether a surface is a solid. Internal to grid/.
#pragma once

#include "alcove/grid/detail/winding.h"
#include "alcove/grid/grid_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/mesh.h"

#include <span>
#include <string>
#include <vector>

namespace alcove {

/// Whether each edge is run as often one way as the other, as far as a sum of 64 bits tells. Not so where coincident
/// vertices are kept apart. Cost: 5 ns a triangle.
bool balanced(std::span<const Triangle> triangles);

/// A closed surface is a solid, also where its parts run into each other: inside of any of them is inside.
/// Not so when a whole part would vanish in the inside of another: shells in shells, and parts inside out,
/// stay a sheet. The wall of a cavity, turned inward, bounds the solid and is kept. Warns of faces that turn the
/// wrong way, unless the columns find winding numbers of 0 and 1 alone, and no edge is run more often one way than
/// the other: 10 ns a triangle for nearly all meshes then, else those of closedness().
Sign choose_sign(SignChoice choice, const Mesh& mesh, const WindingColumns& columns,
                 std::span<const Vec3d> positions, std::span<const Triangle> triangles,
                 std::vector<std::string>& warnings);

}
