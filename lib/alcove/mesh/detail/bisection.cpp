#include "alcove/mesh/detail/bisection.h"

#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

double squared(const Vec3d& v) {
    return glm::dot(v, v);
}

/// Halves the coordinates before adding, because the sum of two large ones may overflow.
Vec3d middle_between(const Vec3d& a, const Vec3d& b) {
    return 0.5 * a + 0.5 * b;
}

bool has_middle(const Vec3d& a, const Vec3d& b) {
    const Vec3d middle = middle_between(a, b);
    return middle != a && middle != b;
}

bool is_larger(const Mesh& mesh, std::span<const std::uint32_t> face, double scale, double length) {
    if (face.size() < 3 ||
        !std::all_of(face.begin(), face.end(), [&](std::uint32_t v) { return is_finite(mesh.positions[v]); }))
        return false;
    const double limit = (scale * length) * (scale * length);
    const Vec3d& first = mesh.positions[face[0]];
    for (std::size_t i = 0; i < face.size(); ++i) {
        const Vec3d& a = mesh.positions[face[i]];
        const Vec3d& b = mesh.positions[face[(i + 1) % face.size()]];
        if (squared(scale * (b - a)) > limit || squared(scale * (a - first)) > 4.0 * limit)
            return true;
    }
    return false;
}

/// The longest side that is longer than `length` and can be cut.
std::optional<std::size_t> side_to_cut(const std::array<Vec3d, 3>& corners, double scale, double length) {
    std::optional<std::size_t> longest;
    double largest = (scale * length) * (scale * length);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d &a = corners[i], &b = corners[(i + 1) % 3];
        const double square = squared(scale * (b - a));
        if (square > largest && has_middle(a, b)) {
            largest = square;
            longest = i;
        }
    }
    return longest;
}

template <class T>
std::array<T, 3> from_side(const std::array<T, 3>& values, std::size_t side) {
    return {values[side], values[(side + 1) % 3], values[(side + 2) % 3]};
}

/// The number of pieces that a triangle is cut into. Stops counting above `most`.
std::size_t count_pieces(const std::array<Vec3d, 3>& corners, double scale, double length, std::size_t most) {
    std::vector<std::array<Vec3d, 3>> todo{corners};
    std::size_t count = 0;
    while (!todo.empty() && count <= most) {
        const std::array<Vec3d, 3> whole = todo.back();
        todo.pop_back();
        if (const std::optional<std::size_t> side = side_to_cut(whole, scale, length)) {
            const auto [a, b, c] = from_side(whole, *side);
            const Vec3d m = middle_between(a, b);
            todo.push_back({m, b, c});
            todo.push_back({a, m, c});
        } else {
            ++count;
        }
    }
    return count;
}

}

Bisection::Bisection(const Mesh& mesh, double length)
    : mesh_(mesh), scale_(exact_scale(mesh)), positions_(mesh.positions), cut_(mesh.face_count(), false) {
    std::vector<std::uint32_t> larger;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        if (is_larger(mesh, mesh.face(f), scale_, length))
            larger.push_back(f);
    add_pieces(larger);
}

/// Triangulates a copy of the faces in which each corner is a separate vertex, because pieces must refer to corners.
void Bisection::add_pieces(const std::vector<std::uint32_t>& faces) {
    Mesh apart;
    std::vector<std::uint32_t> corner_of, face_of;
    for (const std::uint32_t f : faces) {
        for (std::uint32_t c = mesh_.face_begin[f]; c < mesh_.face_begin[f + 1]; ++c) {
            apart.corners.push_back(static_cast<std::uint32_t>(apart.positions.size()));
            apart.positions.push_back(mesh_.positions[mesh_.corners[c]]);
            corner_of.push_back(c);
            face_of.push_back(f);
        }
        apart.face_begin.push_back(static_cast<std::uint32_t>(apart.corners.size()));
    }
    for (const Triangle& t : triangulate(apart).triangles) {
        const Triangle corners{corner_of[t[0]], corner_of[t[1]], corner_of[t[2]]};
        const Triangle vertices{mesh_.corners[corners[0]], mesh_.corners[corners[1]], mesh_.corners[corners[2]]};
        if (vertices[0] != vertices[1] && vertices[1] != vertices[2] && vertices[2] != vertices[0])
            pieces_.push_back({vertices, corners, {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}, face_of[t[0]]});
    }
}

std::size_t Bisection::count_faces(double longest, std::size_t most) const {
    std::size_t count = mesh_.face_count();
    for (std::size_t begin = 0, end = 0; begin < pieces_.size() && count <= most; begin = end) {
        std::size_t of_face = 0;
        for (; end < pieces_.size() && pieces_[end].face == pieces_[begin].face; ++end) {
            const auto& [a, b, c] = pieces_[end].vertices;
            of_face += count_pieces({positions_[a], positions_[b], positions_[c]}, scale_, longest, most);
        }
        if (of_face > end - begin)
            count += of_face - 1;
    }
    return count;
}

std::size_t Bisection::face_count() const {
    std::size_t count = mesh_.face_count();
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        count += cut_[pieces_[i].face] && i > 0 && pieces_[i - 1].face == pieces_[i].face;
    return count;
}

double Bisection::longest_side() const {
    double largest = 0.0;
    for (const Piece& piece : pieces_)
        for (std::size_t i = 0; i < 3; ++i)
            largest = std::max(largest, squared_length(piece.vertices[i], piece.vertices[(i + 1) % 3]));
    return std::sqrt(largest) / scale_;
}

double Bisection::squared_length(std::uint32_t a, std::uint32_t b) const {
    return squared(scale_ * (positions_[b] - positions_[a]));
}

bool Bisection::can_cut(std::uint32_t a, std::uint32_t b, double length) const {
    return squared_length(a, b) > (scale_ * length) * (scale_ * length) && has_middle(positions_[a], positions_[b]);
}

void Bisection::cut_longer_than(double length) {
    cut([&](const Piece& piece) {
        const auto& [a, b, c] = piece.vertices;
        return side_to_cut({positions_[a], positions_[b], positions_[c]}, scale_, length);
    });
}

std::pair<Piece, Piece> Bisection::halves(const Piece& whole, std::size_t side) {
    cut_[whole.face] = true;
    const std::uint32_t m = middle_of(whole, side);
    const auto [a, b, c] = from_side(whole.vertices, side);
    const auto [at_a, at_b, at_c] = from_side(whole.weights, side);
    const Vec3d at_m = middle_between(at_a, at_b);
    return {{{a, m, c}, whole.corners, {at_a, at_m, at_c}, whole.face},
            {{m, b, c}, whole.corners, {at_m, at_b, at_c}, whole.face}};
}

std::uint32_t Bisection::middle_of(const Piece& piece, std::size_t side) {
    const auto [a, b, c] = from_side(piece.vertices, side);
    const auto [at, is_new] = middles_.try_emplace(key(a, b), static_cast<std::uint32_t>(positions_.size()));
    if (is_new) {
        const auto [at_a, at_b, at_c] = from_side(piece.weights, side);
        const auto& [u, v, w] = piece.corners;
        added_.push_back({{mesh_.corners[u], mesh_.corners[v], mesh_.corners[w]}, middle_between(at_a, at_b)});
        positions_.push_back(middle_between(positions_[a], positions_[b]));
    }
    return at->second;
}

}
