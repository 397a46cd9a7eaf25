#include "alcove/mesh/triangulate.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/ear_clipping.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// A normal shorter than this share of the squared extent may be rounding error.
constexpr double flat = 1e-14;

Vec3d normal_of(std::span<const Vec3d> polygon) {
    Vec3d normal(0.0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        normal += glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    return normal;
}

/// Whether the triangles around the first corner all face along `normal` and together span at most 180° there. A quad
/// does not need the second condition: its two angles there are always less than 360° together.
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

/// Triangulates one polygon after another and reuses its buffers.
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
        if (!(length > flat) || is_fan(local_, normal / length)) {
            cut_fan();
        } else {
            project(normal / length);
            for (const auto& [a, b, c] : clipper_.clip(flat_))
                emit(a, b, c);
        }
    }

  private:
    /// Loads coordinates relative to the first corner, in units of the extent.
    void load() {
        local_.clear();
        const Vec3d origin = 0.25 * mesh_.positions[face_[0]];
        double extent = 0.0;
        for (const std::uint32_t v : face_) {
            // The factor 0.25 keeps differences of the largest doubles finite.
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

    const Mesh& mesh_;
    std::span<const std::uint32_t> face_;
    std::vector<Triangle>* out_ = nullptr;
    std::vector<Vec3d> local_;
    std::vector<glm::dvec2> flat_;
    EarClipper clipper_;
};

/// Triangulates the faces [begin, end). `faces`, if set, gets the index of the face of each triangle.
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

std::vector<Triangle> corners_of_triangles(const Mesh& mesh) {
    std::vector<std::uint32_t> faces;
    std::vector<Triangle> triangles =
        triangulate_range(mesh, are_finite(mesh.positions), 0, mesh.face_count(), &faces).triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto first = mesh.corners.begin() + mesh.face_begin[faces[t]];
        for (std::uint32_t& corner : triangles[t])
            corner = static_cast<std::uint32_t>(std::find(first, mesh.corners.end(), corner) - mesh.corners.begin());
    }
    return triangles;
}

Triangulation triangulate(const Mesh& mesh) {
    const bool all_finite = are_finite(mesh.positions);
    // In a mesh of triangles, distributing the work and joining the results would take longer than the work itself.
    if (mesh.corners.size() <= 3 * mesh.face_count())
        return triangulate_range(mesh, all_finite, 0, mesh.face_count());
    // Blocks of about 32,768 corners on average, so that threads also share the work if polygons are huge.
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
