#include "alcove/occlusion/detail/touching_faces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace alcove {
namespace {

constexpr double in_plane = 0.02; // sine of the largest angle between faces that count as coplanar
constexpr double pi = std::numbers::pi;

/// On which sides of a plane through the surfel some points lie.
struct Sides {
    bool front = false, back = false;

    void add(const Vec3d& point, const Vec3d& normal, double offset) {
        const double height = glm::dot(point, normal),
                     tolerance = std::max(2.0 * offset, in_plane * glm::length(point));
        front = front || height > tolerance;
        back = back || height < -tolerance;
    }
};

Sides sides_of(std::span<const NearFace> faces, const Vec3d& normal, double offset) {
    Sides sides;
    for (const NearFace& face : faces)
        for (const Vec3d& corner : face.corners)
            sides.add(corner, normal, offset);
    return sides;
}

double distance_to_segment(const Vec3d& a, const Vec3d& b) {
    const Vec3d along = b - a;
    const double t = std::clamp(-glm::dot(a, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::length(a + t * along);
}

/// The corner at the surfel; 3 if there is none.
std::size_t corner_at_surfel(const NearFace& face, double offset) {
    std::size_t k = 0;
    while (k < 3 && glm::length(face.corners[k]) > offset)
        ++k;
    return k;
}

/// Whether a corner is a corner of an own face.
bool is_corner_of(std::span<const NearFace> own, const Vec3d& corner) {
    return std::any_of(own.begin(), own.end(), [&](const NearFace& face) {
        return std::find(face.corners.begin(), face.corners.end(), corner) != face.corners.end();
    });
}

/// Whether all corners of a face are corners of own faces. Duplicate polygons may be triangulated differently.
bool is_duplicate(const NearFace& face, std::span<const NearFace> own) {
    return std::all_of(face.corners.begin(), face.corners.end(),
                       [&](const Vec3d& corner) { return is_corner_of(own, corner); });
}

/// The ranges of angles around a surfel that are filled by faces in its plane.
class FilledAngles {
  public:
    explicit FilledAngles(const Vec3d& normal)
        : u_(glm::normalize(glm::cross(normal, std::fabs(normal.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)))),
          v_(glm::cross(normal, u_)) {}

    void add(const NearFace& face, double offset) {
        const auto& corners = face.corners;
        if (const std::size_t k = corner_at_surfel(face, offset); k < 3)
            return add(angle(corners[(k + 1) % 3]), angle(corners[(k + 2) % 3]), pi);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
            if (distance_to_segment(a, b) > offset)
                continue;
            const Vec3d edge = glm::normalize(b - a), inward = (c - a) - glm::dot(c - a, edge) * edge;
            add(angle(edge), angle(inward), pi); // two quarter turns: a half turn has no definite side
            add(angle(-edge), angle(inward), pi);
            return;
        }
        add(0.0, 2.0 * pi, 2.0 * pi);
    }

    bool full() {
        constexpr double gap = 1e-3;
        std::sort(filled_.begin(), filled_.end());
        double end = 0.0;
        for (const auto& [low, high] : filled_) {
            if (low > end + gap)
                return false;
            end = std::max(end, high);
        }
        return end > 2.0 * pi - gap;
    }

  private:
    double angle(const Vec3d& direction) const {
        const double a = std::atan2(glm::dot(direction, v_), glm::dot(direction, u_));
        return a < 0.0 ? a + 2.0 * pi : a;
    }
    /// Adds the range between two angles. The range extends across 0 if they are more than `most` apart.
    void add(double a, double b, double most) {
        const auto [low, high] = std::minmax(a, b);
        if (high - low <= most) {
            filled_.emplace_back(low, high);
        } else {
            filled_.emplace_back(0.0, low);
            filled_.emplace_back(high, 2.0 * pi);
        }
    }

    Vec3d u_, v_;
    std::vector<std::pair<double, double>> filled_;
};

/// Whether faces in the plane of all own faces cover the surfel.
bool is_covered(std::span<const NearFace> own, std::span<const NearFace* const> facing, double offset,
                const std::function<bool()>& between_solids) {
    FilledAngles filled(own.front().normal);
    std::vector<const NearFace*> duplicates;
    for (const NearFace* face : facing) {
        if (is_duplicate(*face, own))
            duplicates.push_back(face);
        else
            filled.add(*face, offset);
    }
    if (filled.full())
        return true;
    for (const NearFace* face : duplicates)
        filled.add(*face, offset);
    return !duplicates.empty() && filled.full() && between_solids();
}

/// Whether `face`, which lies in the plane of `own`, can cover it: `face` must face against `own` and must not be
/// behind it. The other side of a thin plate is behind.
bool faces_against(const NearFace& face, const NearFace& own) {
    constexpr double rounding = 2.5e-7; // of coordinates near 0.5
    return glm::dot(face.normal, own.normal) < 0.0 && glm::dot(face.corners[0], own.normal) >= -rounding;
}

/// Whether part of a face is in front of one of the own faces. The next face across a convex edge is not in front.
bool is_before(const NearFace& face, std::span<const NearFace> own, const Vec3d& normal, double offset) {
    return std::any_of(own.begin(), own.end(), [&](const NearFace& own_face) {
        const Sides sides = sides_of({&face, 1}, own_face.normal, offset);
        return glm::dot(own_face.normal, normal) < 0.0 ? sides.back : sides.front;
    });
}

/// Whether the face continues the surface, and rays that start above the surfel are clear of it: it faces in a similar
/// direction, or it shares a vertex with own faces that are `behind` it. On a saddle, such faces are in front of each
/// other's neighbours.
bool is_continuation(const NearFace& face, std::span<const NearFace> own, bool behind, const Vec3d& normal) {
    constexpr double similar = 0.7, clear = 0.1; // cosines
    const double cosine = glm::dot(face.normal, normal);
    return cosine > similar ||
           (behind && cosine > clear && std::any_of(face.corners.begin(), face.corners.end(), [&](const Vec3d& corner) {
                return is_corner_of(own, corner);
            }));
}

}

Contact contact_of(const Vec3& normal, std::span<const NearFace> own, std::span<const NearFace> others, double offset,
                   const std::function<bool()>& between_solids) {
    const Vec3d n(normal);
    std::vector<const NearFace*> facing;
    std::vector<Vec3d> planes;
    Contact contact;
    for (const NearFace& face : others) {
        const Sides of_own = sides_of(own, face.normal, offset);
        if (!of_own.front && !of_own.back) {
            if (faces_against(face, own.front()))
                facing.push_back(&face);
            continue;
        }
        if (!sides_of({&face, 1}, n, offset).front || !is_before(face, own, n, offset) ||
            is_continuation(face, own, !of_own.front, n) || is_duplicate(face, own))
            continue;
        constexpr double same_plane = 0.99;
        const Vec3d side = of_own.front ? face.normal : -face.normal;
        if (std::any_of(planes.begin(), planes.end(),
                        [&](const Vec3d& plane) { return std::fabs(glm::dot(plane, side)) > same_plane; }))
            continue;
        planes.push_back(side);
        contact.away += Vec3(side);
    }
    contact.covered = !facing.empty() && is_covered(own, facing, offset, between_solids);
    return contact;
}

}
