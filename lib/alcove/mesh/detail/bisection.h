/// Bisects the triangles of a mesh at the midpoints of their sides.
///
/// OpenMesh's LongestEdgeT produces the same triangles but is not used: OpenMesh cannot represent non-manifold edges,
/// and LongestEdgeT neither limits the number of faces nor interpolates corner values. Here each triangle is split
/// independently. Adjacent faces still match, because whether a side is split depends only on its two ends, and these
/// identify the new vertex.
#pragma once

#include "alcove/mesh/mesh.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

namespace alcove {

/// A new vertex, as a weighted sum of vertices of the mesh.
struct AddedVertex {
    Triangle between; ///< vertices of the mesh
    Vec3d weights;    ///< of `between`; sum to 1
};

/// A triangle of a triangulated face, or a part of such a triangle.
struct Piece {
    Triangle vertices;
    Triangle corners;             ///< indices into Mesh::corners of the corners of the whole triangle
    std::array<Vec3d, 3> weights; ///< barycentric coordinates of each vertex in the whole triangle
    std::uint32_t face;           ///< index of its face in the mesh
    bool is_new = true;           ///< created by the last cut()
};

/// The weighted sum of value_at(0..2). Values of weight 0 are skipped, as they may be NaN.
template <class ValueAt>
auto blended(const Vec3d& weights, ValueAt&& value_at) {
    decltype(value_at(0)) sum(0.0);
    for (int i = 0; i < 3; ++i)
        if (weights[i] != 0.0)
            sum += weights[i] * value_at(i);
    return sum;
}

class Bisection {
  public:
    /// Triangulates the faces that have a side longer than `length`, or a corner farther than 2 × `length` from the
    /// first one.
    /// \throw InputError if the mesh has infinite extent.
    Bisection(const Mesh& mesh, double length);

    const std::vector<Piece>& pieces() const { return pieces_; } ///< in face order
    const std::vector<AddedVertex>& added() const { return added_; }
    const std::vector<Vec3d>& positions() const { return positions_; } ///< of all vertices; the added ones are last
    bool is_cut(std::uint32_t face) const { return cut_[face]; }

    /// The number of faces after cut_longer_than(longest); if it exceeds `most`, an arbitrary number above `most`.
    std::size_t count_faces(double longest, std::size_t most) const;
    std::size_t face_count() const; ///< the number of faces so far
    double longest_side() const;
    double scale() const { return scale_; } ///< factor that prevents overflow and underflow of squared lengths

    /// Whether the side between two vertices is longer than `length`, and its rounded midpoint differs from both of
    /// them.
    bool can_cut(std::uint32_t a, std::uint32_t b, double length) const;
    double squared_length(std::uint32_t a, std::uint32_t b) const; ///< in the scaled mesh
    void cut_longer_than(double length);

    /// Bisects each piece at the side that `choose(piece)` returns, then the halves in the same way, until `choose`
    /// returns none. Side i is between the vertices i and (i + 1) % 3.
    template <class Choose>
    void cut(Choose&& choose) {
        std::vector<Piece> done, todo;
        for (const Piece& piece : pieces_) {
            todo.push_back(piece);
            todo.back().is_new = false;
            while (!todo.empty()) {
                const Piece whole = todo.back();
                todo.pop_back();
                if (const std::optional<std::size_t> side = choose(whole)) {
                    const auto [first, second] = halves(whole, *side);
                    todo.push_back(second);
                    todo.push_back(first);
                } else {
                    done.push_back(whole);
                }
            }
        }
        pieces_ = std::move(done);
    }

    /// The vertex at the midpoint of an edge that was cut.
    std::uint32_t middle(std::uint32_t a, std::uint32_t b) const { return middles_.at(key(a, b)); }

    static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
    }

  private:
    void add_pieces(const std::vector<std::uint32_t>& faces);
    std::pair<Piece, Piece> halves(const Piece& whole, std::size_t side);
    std::uint32_t middle_of(const Piece& piece, std::size_t side);

    const Mesh& mesh_;
    double scale_;
    std::vector<Vec3d> positions_;
    std::vector<Piece> pieces_;
    std::vector<AddedVertex> added_;
    std::vector<bool> cut_;                                    ///< one per face of the mesh
    std::unordered_map<std::uint64_t, std::uint32_t> middles_; ///< by key()
};

}
