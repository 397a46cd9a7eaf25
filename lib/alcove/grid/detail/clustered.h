/// Reduces the triangles of a dense surface by vertex clustering.
#pragma once

#include "alcove/base/detail/memory.h"
#include "alcove/mesh/detail/edge_table.h"
#include "alcove/mesh/mesh.h"

#include <span>
#include <vector>

namespace alcove {

struct Surface {
    std::span<const Vec3d> positions;
    std::span<const Triangle> triangles;
};

/// Vertex clustering (Rossignac and Borrel 1993): merges the vertices in a cube of side `cell` into
/// their mean and removes the triangles that collapse. Unlike the original, it merges only vertices that are
/// connected within the cube, by edges or because they coincide; otherwise the two sides of a thin wall would
/// merge.
///
/// Some collapsed triangles are kept unchanged: those whose new vertices belong to no other triangle (spikes, and
/// parts smaller than a cube), and those whose corners are more than 2√3 cells apart (struts and wires). No point
/// of the surface moves by more than 2√3 cells, and triangles keep their orientation. The result does not depend on
/// the number of threads. Cost: about 20 ns per triangle, plus 50 ns per vertex where edges are open.
class ClusteredSurface {
  public:
    /// `is_balanced`: the result of balanced(). If false, coincident vertices are joined first.
    /// \pre finite positions are in [0, 2^21) cells
    ClusteredSurface(const Surface& surface, bool is_balanced, double cell);

    Surface surface() const { return {positions_, triangles_}; }

  private:
    std::vector<std::uint32_t> merge(std::span<const Vec3d> positions, DisjointSets clusters);

    HugeVector<Vec3d> positions_;
    HugeVector<Triangle> triangles_;
};

}
