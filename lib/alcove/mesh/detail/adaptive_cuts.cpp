#include "alcove/mesh/detail/adaptive_cuts.h"

#include "alcove/base/types.h"
#include "alcove/mesh/normals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace alcove {
namespace {

constexpr std::size_t batch_size = std::size_t(1) << 18; // points; limits the memory
constexpr int max_intervals = 64;

struct Edge {
    std::uint32_t a = 0, b = 0;
    std::uint32_t middle = 0; ///< number of the tested point at its midpoint, if there is one
    std::uint32_t pieces = 0; ///< number of pieces that use the edge, if it is marked
    Vec3d normal{0.0};        ///< area-weighted sum of the normals of its pieces
    bool tested = false;
    bool marked = false; ///< to be cut in this round
};

class AdaptiveCuts {
  public:
    AdaptiveCuts(Bisection& bisection, const Mesh& mesh, const SplitPredicate& split,
                 const AdaptiveTessellateOptions& options)
        : bisection_(bisection), mesh_(mesh), split_(split), options_(options),
          spacing_(bisection.scale() * options.spacing) {}

    bool run() {
        for (;;) {
            test_new_pieces();
            if (marked_.empty())
                return true;
            mark_longest();
            const bool all = keep_within_limit();
            cut();
            if (!all)
                return false;
        }
    }

  private:
    /// Tests the pieces that the last cut created and the new sides of these pieces. All pieces at a new side are new
    /// as well.
    void test_new_pieces() {
        for (const Piece& piece : bisection_.pieces())
            for (std::size_t i = 0; i < 3 && piece.is_new; ++i) {
                Edge& edge = edges_[key(piece, i)];
                edge.a = piece.vertices[i];
                edge.b = piece.vertices[(i + 1) % 3];
                if (!edge.tested)
                    edge.normal += area_normal(piece);
            }
        for (const Piece& piece : bisection_.pieces())
            if (piece.is_new)
                test(piece);
        flush();
    }

    void test(const Piece& piece) {
        for (std::size_t i = 0; i < 3; ++i) {
            Edge& edge = edges_[key(piece, i)];
            if (!edge.tested && can_cut(piece, i)) {
                add_points(piece, i, edge);
                edge.tested = true;
            }
        }
        if (const auto longest = longest_side(piece, [&](std::size_t i) { return can_cut(piece, i); }))
            add_points_inside(piece, *longest);
        if (points_.size() >= batch_size)
            flush();
    }

    static std::uint64_t key(const Piece& piece, std::size_t side) {
        return Bisection::key(piece.vertices[side], piece.vertices[(side + 1) % 3]);
    }

    Vec3d area_normal(const Piece& piece) const {
        const auto& [a, b, c] = piece.vertices;
        const std::vector<Vec3d>& p = bisection_.positions();
        return glm::cross(bisection_.scale() * (p[b] - p[a]), bisection_.scale() * (p[c] - p[a]));
    }

    void add_points(const Piece& piece, std::size_t side, Edge& edge) {
        const double length = std::sqrt(bisection_.squared_length(edge.a, edge.b));
        // A power of two, so that the midpoint, which may become a vertex, is among the points.
        int intervals = 2;
        while (spacing_ > 0.0 && length > spacing_ * intervals && intervals < max_intervals)
            intervals *= 2;
        for (int i = 1; i < intervals; ++i) {
            if (2 * i == intervals)
                edge.middle = next_number();
            const double along = double(i) / intervals;
            add_point(piece, side, {1.0 - along, along, 0.0}, edge.normal, edge);
        }
    }

    /// The number of intervals, at most as long as the spacing, that cover a length; limited to `max_intervals`.
    int intervals_of(double length) const {
        return length > 0.0 ? static_cast<int>(std::min(std::ceil(length / spacing_), double(max_intervals))) : 0;
    }

    /// Adds rows of points parallel to the longest side, or only the centre if the height of the triangle is below the
    /// spacing.
    void add_points_inside(const Piece& piece, std::size_t longest) {
        Edge& edge = edges_[key(piece, longest)];
        const Vec3d normal = area_normal(piece);
        const double length = std::sqrt(bisection_.squared_length(edge.a, edge.b));
        const double height = glm::length(normal) / length;
        const int rows = spacing_ > 0.0 ? intervals_of(height) : 1;
        if (rows < 2)
            add_point(piece, longest, Vec3d(1.0 / 3.0), normal, edge);
        for (int row = 1; row < rows; ++row) {
            const double up = double(row) / rows;
            const int count = intervals_of((1.0 - up) * length);
            for (int i = 0; i < count; ++i) {
                const double along = (i + 0.5) / count;
                add_point(piece, longest, {(1.0 - up) * (1.0 - along), (1.0 - up) * along, up}, normal, edge);
            }
        }
    }

    /// Adds the point that has `weights` for the two ends of a side and for the opposite corner. `edge` is cut if the
    /// predicate returns true for the point.
    void add_point(const Piece& piece, std::size_t side, const Vec3d& weights, const Vec3d& area, Edge& edge) {
        const std::array<std::size_t, 3> corners{side, (side + 1) % 3, weights[2] == 0.0 ? side : (side + 2) % 3};
        PointBetween point{Vec3d(0.0), Vec3(0.0f), piece.face, {}, weights};
        Vec3d on_face(0.0);
        for (int i = 0; i < 3; ++i) {
            const std::size_t corner = corners[std::size_t(i)];
            point.ends[std::size_t(i)] = number_of(piece.vertices[corner]);
            point.position += weights[i] * bisection_.positions()[piece.vertices[corner]];
            on_face += weights[i] * piece.weights[corner];
        }
        if (!mesh_.normals.empty())
            point.normal = unit_or_zero(blended(
                on_face, [&](int i) { return Vec3d(mesh_.normals[mesh_.corners[piece.corners[std::size_t(i)]]]); }));
        if (point.normal == Vec3(0.0f))
            point.normal = unit_or_zero(area);
        points_.push_back(point);
        edges_of_points_.push_back(&edge);
    }

    std::uint32_t next_number() const {
        const std::size_t number = mesh_.vertex_count() + tested_ + points_.size();
        if (number > std::numeric_limits<std::uint32_t>::max())
            throw LimitError("tessellation tests more than 2^32 points; increase the spacing or the shortest edge");
        return static_cast<std::uint32_t>(number);
    }

    std::uint32_t number_of(std::uint32_t vertex) const {
        return vertex < mesh_.vertex_count() ? vertex : numbers_[vertex - mesh_.vertex_count()];
    }

    void flush() {
        if (points_.empty())
            return;
        const std::vector<bool> answers = split_(points_);
        if (answers.size() != points_.size())
            throw std::invalid_argument("the split predicate did not return one value per point");
        for (std::size_t i = 0; i < answers.size(); ++i)
            if (answers[i] && !edges_of_points_[i]->marked) {
                edges_of_points_[i]->marked = true;
                marked_.push_back(edges_of_points_[i]);
            }
        tested_ += points_.size();
        points_.clear();
        edges_of_points_.clear();
    }

    const Edge* marked_edge(const Piece& piece, std::size_t side) const {
        // Check the ends first, because most sides are not marked and the lookup is slow.
        const std::uint32_t u = piece.vertices[side], v = piece.vertices[(side + 1) % 3];
        if (std::max(u, v) >= at_marked_.size() || !at_marked_[u] || !at_marked_[v])
            return nullptr;
        const auto found = edges_.find(key(piece, side));
        return found != edges_.end() && found->second.marked ? &found->second : nullptr;
    }

    /// Marks the longest side of each piece that has a marked side. Cutting the longest side first keeps the angles
    /// bounded from below (Rivara 1984).
    void mark_longest() {
        at_marked_.assign(bisection_.positions().size(), false);
        for (const Edge* edge : marked_)
            at_marked_[edge->a] = at_marked_[edge->b] = true;
        for (std::size_t before = 0; before != marked_.size();) {
            before = marked_.size();
            for (const Piece& piece : bisection_.pieces()) {
                if (!marked_edge(piece, 0) && !marked_edge(piece, 1) && !marked_edge(piece, 2))
                    continue;
                Edge& edge = edges_[key(piece, *longest_side(piece, [&](std::size_t i) { return can_cut(piece, i); }))];
                if (!edge.marked) {
                    edge.marked = true;
                    marked_.push_back(&edge);
                    at_marked_[edge.a] = at_marked_[edge.b] = true;
                }
            }
        }
    }

    bool can_cut(const Piece& piece, std::size_t side) const {
        return bisection_.can_cut(piece.vertices[side], piece.vertices[(side + 1) % 3], options_.shortest);
    }

    /// The longest of the sides for which `counts(side)` is true.
    template <class Counts>
    std::optional<std::size_t> longest_side(const Piece& piece, Counts&& counts) const {
        std::optional<std::size_t> longest;
        double largest = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double square = bisection_.squared_length(piece.vertices[i], piece.vertices[(i + 1) % 3]);
            if (square > largest && counts(i)) {
                largest = square;
                longest = i;
            }
        }
        return longest;
    }

    /// Unmarks the shortest edges if cutting all marked ones would exceed the limit. \return whether all stay marked.
    bool keep_within_limit() {
        // Cutting an edge adds one face for each piece that uses it; the first cut in a polygon also replaces the
        // polygon by its triangles.
        std::size_t count = bisection_.face_count(), cuts = 0;
        const std::vector<Piece>& pieces = bisection_.pieces();
        for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
            const std::size_t before = cuts;
            for (; end < pieces.size() && pieces[end].face == pieces[begin].face; ++end)
                for (std::size_t i = 0; i < 3; ++i)
                    if (marked_edge(pieces[end], i)) {
                        ++edges_[key(pieces[end], i)].pieces;
                        ++cuts;
                    }
            if (cuts > before && !bisection_.is_cut(pieces[begin].face))
                count += end - begin - 1;
        }
        if (count + cuts <= options_.most_faces)
            return true;
        std::stable_sort(marked_.begin(), marked_.end(), [&](const Edge* x, const Edge* y) {
            return bisection_.squared_length(x->a, x->b) > bisection_.squared_length(y->a, y->b);
        });
        const auto first_unmarked = std::find_if(marked_.begin(), marked_.end(), [&](const Edge* edge) {
            count += edge->pieces;
            return count > options_.most_faces;
        });
        for (auto edge = first_unmarked; edge != marked_.end(); ++edge)
            (*edge)->marked = false;
        marked_.erase(first_unmarked, marked_.end());
        return false;
    }

    void cut() {
        bisection_.cut([&](const Piece& piece) {
            return longest_side(piece, [&](std::size_t i) { return marked_edge(piece, i) != nullptr; });
        });
        numbers_.resize(bisection_.added().size());
        for (const Edge* edge : marked_) {
            numbers_[bisection_.middle(edge->a, edge->b) - mesh_.vertex_count()] = edge->middle;
            edges_.erase(Bisection::key(edge->a, edge->b));
        }
        marked_.clear();
    }

    Bisection& bisection_;
    const Mesh& mesh_;
    const SplitPredicate& split_;
    const AdaptiveTessellateOptions& options_;
    const double spacing_; ///< in the scaled mesh
    std::unordered_map<std::uint64_t, Edge> edges_;
    std::vector<Edge*> marked_;
    std::vector<bool> at_marked_;        ///< per vertex before the cut: whether a marked edge ends there
    std::vector<std::uint32_t> numbers_; ///< per added vertex: its number as a tested point
    std::size_t tested_ = 0;
    std::vector<PointBetween> points_;   ///< not tested yet
    std::vector<Edge*> edges_of_points_; ///< per point of `points_`: the edge to cut
};

}

bool cut_where(Bisection& bisection, const Mesh& mesh, const SplitPredicate& split,
               const AdaptiveTessellateOptions& options) {
    return AdaptiveCuts(bisection, mesh, split, options).run();
}

}
