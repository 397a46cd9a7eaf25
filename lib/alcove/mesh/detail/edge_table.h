/// The edges of a polygon soup with any number of faces per edge.
///
/// Not OpenMesh's half-edges: these cannot represent an edge of three faces without duplicating its vertices, and
/// building them takes 350 ns per triangle, more than twice the time of closedness() as a whole.
#pragma once

#include "alcove/mesh/mesh.h"

#include <algorithm>

namespace alcove {

/// The valid faces, as loops of joined vertices.
struct SoundFaces {
    std::vector<std::uint32_t> begin{0}; ///< faces + 1 offsets into `corners`
    std::vector<std::uint32_t> corners;  ///< no corner equals the next one, cyclically
    std::vector<std::uint32_t> face_of;  ///< one per corner
    std::vector<std::uint32_t> source;   ///< one per face: its index in the mesh
    std::size_t collapsed = 0;           ///< finite faces left out because fewer than three corners remain

    std::size_t count() const { return begin.size() - 1; }
    std::span<const std::uint32_t> face(std::size_t f) const {
        return {corners.data() + begin[f], corners.data() + begin[f + 1]};
    }
    std::uint32_t next(std::uint32_t corner) const {
        const std::uint32_t f = face_of[corner];
        return corner + 1 == begin[f + 1] ? begin[f] : corner + 1;
    }
};

/// `joined` maps each vertex to its representative, as from weld(), or to itself.
SoundFaces sound_faces(const Mesh& mesh, std::span<const std::uint32_t> joined);

/// One side of a face, from `corner` to the next.
struct EdgeUse {
    std::uint32_t high;        ///< the larger of the edge's vertices
    std::uint32_t corner : 31; ///< where the side starts
    std::uint32_t forward : 1; ///< from the smaller vertex to the larger
};

/// All sides of all faces, grouped by edge. Their order depends only on the faces. Takes 8 bytes per side.
class EdgeTable {
  public:
    EdgeTable(const SoundFaces& faces, std::size_t vertex_count);

    /// Calls `visit(std::span<const EdgeUse>)` once per edge.
    template <class Visit>
    void for_each_edge(Visit&& visit) const {
        for (std::size_t v = 0; v + 1 < begin_.size(); ++v)
            for (std::size_t at = begin_[v], after = at; at < begin_[v + 1]; at = after) {
                while (after < begin_[v + 1] && uses_[after].high == uses_[at].high)
                    ++after;
                visit(std::span(uses_).subspan(at, after - at));
            }
    }

  private:
    std::vector<std::uint32_t> begin_; // offsets into uses_, by the smaller vertex
    std::vector<EdgeUse> uses_;
};

/// Disjoint sets of the numbers below `count`. The smallest member represents a set.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count);
    std::size_t size() const { return parent_.size(); }
    const std::uint32_t* data() const { return parent_.data(); } ///< one value per number, to be prefetched
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// A fast test: if true, both numbers are in one set; if false, they may be in one set or not.
    bool surely_joined(std::uint32_t a, std::uint32_t b) const { return parent_[a] == parent_[b]; }
    void join(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t of_a = root(a), of_b = root(b);
        parent_[of_a] = parent_[of_b] = parent_[a] = parent_[b] = std::min(of_a, of_b);
    }

  private:
    /// Most parents are roots, so the number of iterations is easy to predict.
    std::uint32_t root(std::uint32_t i) const {
        i = parent_[i];
        while (parent_[i] != i)
            i = parent_[i];
        return i;
    }

    std::vector<std::uint32_t> parent_;
};

}
