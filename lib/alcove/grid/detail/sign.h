/// Decides whether a surface is a solid.
#pragma once

#include "alcove/grid/detail/winding.h"
#include "alcove/grid/grid_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/mesh.h"

#include <span>
#include <string>
#include <vector>

namespace alcove {

/// Whether the faces traverse each edge equally often in both directions, up to collisions of a 64-bit hash. Compares
/// indices, so the result is false if coincident vertices are not joined. Cost: 5 ns per triangle.
bool balanced(std::span<const Triangle> triangles);

/// A closed surface is a solid, even if its parts overlap: the inside is the union of their insides. But it is a sheet
/// if a whole part would vanish inside another (nested shells, parts turned inside out), or walls would vanish where
/// the surface crosses itself and encloses regions from the back. An inward-facing cavity wall bounds the solid and is
/// kept. Adds warnings about faces with the wrong orientation. Cost: if edges are balanced (`is_balanced`), 5 ns per
/// triangle, or 20 ns if there are winding numbers other than 0 and 1. If edges are not balanced, or if a part is
/// inverted or hidden inside others, the cost of closedness().
Sign choose_sign(SignChoice choice, const Mesh& mesh, const WindingColumns& columns, bool is_balanced,
                 std::span<const Vec3d> positions, std::span<const Triangle> triangles,
                 std::vector<std::string>& warnings);

}
