#include "alcove/mesh/triangulate.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

using Vec2d = glm::dvec2;

/// A turn below this share of the squared extent counts as straight: it may be rounding error.
constexpr double flat = 1e-14;

double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

bool in_closed_triangle(const Vec2d& p, const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

Vec3d normal_of(std::span<const Vec3d> polygon) {
    Vec3d normal(0.0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        normal += glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    return normal;
}

/// Whether the triangles around the first corner all face along `normal` and together span less than 180° there. A quad
/// does not need the second condition: its two angles are always less than 360° together.
bool is_fan(std::span<const Vec3d> polygon, const Vec3d& normal) {
    const Vec3d first = polygon[1] - polygon[0];
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const Vec3d a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
        if (glm::dot(glm::cross(a, b), normal) <= flat)
            return false;
        if (polygon.size() > 4 && glm::dot(glm::cross(first, b), normal) < 0.0)
            return false;
    }
    return true;
}

/// Triangulates polygons; reuses its buffers.
class PolygonCutter {
  public:
    explicit PolygonCutter(const Mesh& mesh) : mesh_(mesh) {}

    /// Appends the triangles of a polygon of four or more corners, none equal to the next.
    void cut(std::span<const std::uint32_t> face, std::vector<Triangle>& out) {
        face_ = face;
        out_ = &out;
        load();
        const Vec3d normal = normal_of(local_);
        const double length = glm::length(normal);
        if (!(length > flat) || is_fan(local_, normal / length) || face.size() > longest_clipped_polygon)
            cut_fan();
        else
            clip_ears(normal / length);
    }

  private:
    /// Loads coordinates relative to the first corner, in units of the extent.
    void load() {
        local_.clear();
        const Vec3d origin = 0.25 * mesh_.positions[face_[0]];
        double extent = 0.0;
        for (const std::uint32_t v : face_) {
            // The factor keeps differences of the largest doubles finite.
            const Vec3d p = 0.25 * mesh_.positions[v] - origin;
            extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
            local_.push_back(p);
        }
        if (extent > 0.0)
            for (Vec3d& p : local_)
                p /= extent;
    }

    void emit(std::size_t a, std::size_t b, std::size_t c) {
        const Triangle t{face_[a], face_[b], face_[c]};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            out_->push_back(t);
    }

    void cut_fan() {
        for (std::size_t i = 1; i + 1 < face_.size(); ++i)
            emit(0, i, i + 1);
    }

    void project(const Vec3d& normal) {
        const Vec3d size = glm::abs(normal);
        const Vec3d axis = size.x <= size.y && size.x <= size.z ? Vec3d(1, 0, 0)
                           : size.y <= size.z                   ? Vec3d(0, 1, 0)
                                                                : Vec3d(0, 0, 1);
        const Vec3d u = glm::normalize(glm::cross(axis, normal)), v = glm::cross(normal, u);
        flat_.clear();
        for (const Vec3d& p : local_)
            flat_.emplace_back(glm::dot(p, u), glm::dot(p, v));
    }

    double turn_at(std::size_t i) const { return turn(flat_[previous_[i]], flat_[i], flat_[next_[i]]); }

    bool is_ear(std::size_t i) const {
        if (turn_at(i) <= flat)
            return false;
        const Vec2d &a = flat_[previous_[i]], &b = flat_[i], &c = flat_[next_[i]];
        return std::none_of(reflex_.begin(), reflex_.end(), [&](std::size_t r) {
            const Vec2d& p = flat_[r];
            return r != previous_[i] && r != i && r != next_[i] && p != a && p != b && p != c &&
                   in_closed_triangle(p, a, b, c);
        });
    }

    void clip(std::size_t i) {
        const std::size_t before = previous_[i], after = next_[i];
        emit(before, i, after);
        next_[before] = after;
        previous_[after] = before;
        // Only reflex corners can be inside an ear, and clipping never makes a corner reflex.
        std::erase_if(reflex_,
                      [&](std::size_t r) { return r == i || ((r == before || r == after) && turn_at(r) > flat); });
        // In a simple polygon this does not affect other ears, unless a corner touches the edge of an ear.
        set_ear(i, false);
        set_ear(before, is_ear(before));
        set_ear(after, is_ear(after));
    }

    void clip_ears(const Vec3d& normal) {
        project(normal);
        const std::size_t count = face_.size();
        previous_.resize(count);
        next_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            previous_[i] = (i + count - 1) % count;
            next_[i] = (i + 1) % count;
        }
        reflex_.clear();
        for (std::size_t i = 0; i < count; ++i)
            if (turn_at(i) <= flat)
                reflex_.push_back(i);

        ear_.assign(count, false);
        ears_ = 0;
        find_ears(0);
        std::size_t at = 0, rounds = 0;
        for (std::size_t left = count; left > 3; --left) {
            std::size_t tip = ear_from(at);
            if (!ear_[tip] && rounds++ < 32) {
                find_ears(at);
                tip = ear_from(at);
            }
            if (!ear_[tip])
                tip = sharpest_from(at); // the outline crosses or touches itself
            // Skip the next corner, so that the cuts are spread rather than fanned around one vertex.
            at = next_[next_[tip]];
            clip(tip);
        }
        emit(previous_[at], at, next_[at]);
    }

    void set_ear(std::size_t i, bool is) {
        ears_ += std::size_t{is} - std::size_t{ear_[i] != 0};
        ear_[i] = is;
    }

    void find_ears(std::size_t start) {
        std::size_t i = start;
        do {
            set_ear(i, is_ear(i));
            i = next_[i];
        } while (i != start);
    }

    /// The next ear, or `start` if none is known.
    std::size_t ear_from(std::size_t start) const {
        std::size_t i = start;
        while (ears_ > 0 && !ear_[i])
            i = next_[i];
        return i;
    }

    std::size_t sharpest_from(std::size_t start) const {
        std::size_t best = start;
        for (std::size_t i = next_[start]; i != start; i = next_[i])
            if (turn_at(i) > turn_at(best))
                best = i;
        return best;
    }

    const Mesh& mesh_;
    std::span<const std::uint32_t> face_;
    std::vector<Triangle>* out_ = nullptr;
    std::vector<Vec3d> local_;
    std::vector<Vec2d> flat_;
    std::vector<std::size_t> previous_, next_, reflex_;
    std::vector<char> ear_;
    std::size_t ears_ = 0; ///< ears that remain
};

/// Triangulates the faces [begin, end). `faces`, if set, gets the face of each triangle.
Triangulation triangulate_range(const Mesh& mesh, bool all_finite, std::size_t begin, std::size_t end,
                                std::vector<std::uint32_t>* faces = nullptr) {
    Triangulation result;
    const std::size_t corners = mesh.face_begin[end] - mesh.face_begin[begin];
    reserve_huge(result.triangles, corners - std::min(corners, 2 * (end - begin)));
    PolygonCutter cutter(mesh);
    std::vector<std::uint32_t> distinct;
    for (std::size_t f = begin; f < end; ++f) {
        std::span<const std::uint32_t> face = mesh.face(f);
        const std::size_t before = result.triangles.size();
        if (face.size() >= 3 && (all_finite || std::all_of(face.begin(), face.end(), [&](std::uint32_t v) {
                                     return is_finite(mesh.positions[v]);
                                 }))) {
            if (face.size() > 3) {
                distinct.assign(face.begin(), face.end());
                distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
                while (distinct.size() > 1 && distinct.front() == distinct.back())
                    distinct.pop_back();
                face = distinct;
            }
            if (face.size() > 3)
                cutter.cut(face, result.triangles);
            else if (face.size() == 3 && face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
                result.triangles.push_back({face[0], face[1], face[2]});
        }
        result.faces_left_out += result.triangles.size() == before;
        if (faces)
            faces->resize(result.triangles.size(), static_cast<std::uint32_t>(f));
    }
    return result;
}

bool are_finite(const std::vector<Vec3d>& positions) {
    return std::all_of(positions.begin(), positions.end(), is_finite);
}

}

std::vector<std::uint32_t> faces_of_triangles(const Mesh& mesh) {
    std::vector<std::uint32_t> faces;
    triangulate_range(mesh, are_finite(mesh.positions), 0, mesh.face_count(), &faces);
    return faces;
}

Triangulation triangulate(const Mesh& mesh) {
    const bool all_finite = are_finite(mesh.positions);
    // For triangles, sharing the work and joining the results would take longer than the work itself.
    if (mesh.corners.size() <= 3 * mesh.face_count())
        return triangulate_range(mesh, all_finite, 0, mesh.face_count());
    // Blocks with about equal numbers of corners, so that a few huge polygons are shared too.
    const std::size_t grain = 1 + (mesh.face_count() << 15) / (mesh.corners.size() + 1);
    std::vector<Triangulation> parts((mesh.face_count() + grain - 1) / grain);
    parallel_for(mesh.face_count(), grain, [&](std::size_t begin, std::size_t end) {
        parts[begin / grain] = triangulate_range(mesh, all_finite, begin, end);
    });

    std::vector<std::size_t> offset(parts.size() + 1, 0);
    Triangulation whole;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        offset[i + 1] = offset[i] + parts[i].triangles.size();
        whole.faces_left_out += parts[i].faces_left_out;
    }
    reserve_huge(whole.triangles, offset.back());
    whole.triangles.resize(offset.back());
    parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            std::copy(parts[i].triangles.begin(), parts[i].triangles.end(),
                      whole.triangles.begin() + static_cast<std::ptrdiff_t>(offset[i]));
    });
    return whole;
}

}
