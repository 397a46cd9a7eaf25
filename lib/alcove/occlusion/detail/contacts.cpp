#include "alcove/occlusion/detail/contacts.h"

#include "alcove/base/detail/closest_point.h"
#include "alcove/base/parallel.h"
#include "alcove/field/detail/trace.h"
#include "alcove/occlusion/detail/touched_surfels.h"
#include "alcove/occlusion/detail/touching_faces.h"
#include "alcove/occlusion/estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace alcove {
namespace {

/// Whether a point lies in a solid: a ray from it meets more faces from behind than from the front.
bool is_inside(const RaySurface& surface, const Vec3& point, const Vec3& direction, float offset) {
    constexpr int most_hits = 256;
    std::array<SurfaceHit, RayBatch::capacity> hits;
    std::vector<Triangle> near;
    int outward = 0;
    float from = 0.0f;
    for (int i = 0; i < most_hits; ++i) {
        RayBatch ray;
        ray.push_back({point, direction}, from);
        surface.find_nearest(ray, std::numeric_limits<float>::infinity(), hits);
        if (!ray.hit[0])
            return outward > 0;
        const float at = ray.travelled[0];
        // Faces may coincide, and a ray finds only one of them.
        surface.find_near(point + at * direction, offset, near);
        for (const Triangle& t : near) {
            const Vec3d a(surface.positions()[t[0]]), b(surface.positions()[t[1]]), c(surface.positions()[t[2]]);
            const Vec3d normal = glm::cross(b - a, c - a), d(direction), p(point);
            const auto side = [&](const Vec3d& u, const Vec3d& v) { return glm::dot(glm::cross(u - p, v - p), d); };
            const double s = side(a, b), along = glm::dot(normal, d);
            if (along == 0.0 || s * side(b, c) <= 0.0 || s * side(c, a) <= 0.0)
                continue;
            const double distance = glm::dot(normal, a - p) / along;
            if (distance > double(from) && std::fabs(distance - double(at)) <= double(offset))
                outward += along > 0.0 ? 1 : -1;
        }
        from = at + offset;
    }
    return false;
}

/// Finds the contacts of surfels, one surfel at a time.
class ContactSearch {
  public:
    ContactSearch(const RaySurface& surface, float offset, const IsOwnFace& is_own)
        : surface_(surface), positions_(surface.positions()), offset_(offset), is_own_(is_own) {}

    void set_contact(std::size_t i, Surfel& surfel) {
        surface_.find_near(surfel.position, offset_, near_);
        own_.clear();
        others_.clear();
        for (const Triangle& t : near_)
            if (is_own_ && is_own_(i, t))
                own_.push_back(t);
            else if (may_touch(t, surfel.position))
                others_.push_back(t);
        if (others_.empty())
            return;
        float offset = offset_;
        sort_out_faces(surfel, offset);
        if (own_faces_.empty() || other_faces_.empty())
            return;
        if (const float limit = limit_of(own_faces_); limit < offset) {
            offset = surfel.highest = limit;
            sort_out_faces(surfel, offset);
            if (own_faces_.empty() || other_faces_.empty())
                return;
        }
        const Contact contact = contact_of(surfel.normal, own_faces_, other_faces_, double(offset),
                                           [&] { return between_solids(surfel, offset); });
        surfel.away = contact.away;
        surfel.covered = contact.covered;
    }

  private:
    /// Whether the point is in the bounding box of the triangle, grown by the offset.
    bool may_touch(const Triangle& t, const Vec3& p) const {
        const Vec3 a = positions_[t[0]], b = positions_[t[1]], c = positions_[t[2]];
        const Vec3 low = glm::min(glm::min(a, b), c) - offset_, high = glm::max(glm::max(a, b), c) + offset_;
        return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z && p.z <= high.z;
    }

    /// A tenth of the height of the largest of the surfel's own faces, but no less than rounding allows.
    static float limit_of(std::span<const NearFace> own) {
        constexpr double share = 0.1;
        double height = 0.0;
        for (const NearFace& face : own) {
            const auto& [a, b, c] = face.corners;
            const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
            height = std::max(height, glm::length(glm::cross(b - a, c - a)) / longest);
        }
        return std::max(static_cast<float>(share * height), ray_offset(0.0f));
    }

    /// Finds the surfel's own faces, and the others within `offset` of it.
    void sort_out_faces(const Surfel& surfel, float offset) {
        own_faces_.clear();
        other_faces_.clear();
        std::sort(others_.begin(), others_.end()); // the tree returns them in any order
        for (const Triangle& t : own_)
            add_face(t, surfel, own_faces_);
        const bool by_normal = own_faces_.empty();
        for (const Triangle& t : others_) {
            if (!add_face(t, surfel, other_faces_))
                continue;
            const NearFace& face = other_faces_.back();
            const auto& c = face.corners;
            if (glm::length(closest_on_triangle(c[0], c[1], c[2], Vec3d(0.0)).offset) > double(offset)) {
                other_faces_.pop_back();
            } else if (by_normal && 2.0 * glm::dot(face.normal, Vec3d(surfel.normal)) > 1.0) {
                own_faces_.push_back(face);
                other_faces_.pop_back();
            }
        }
    }

    /// Adds the triangle to `faces`, relative to the surfel. \return false if the triangle has no area.
    bool add_face(const Triangle& t, const Surfel& surfel, std::vector<NearFace>& faces) const {
        NearFace face;
        for (std::size_t k = 0; k < 3; ++k)
            face.corners[k] = Vec3d(positions_[t[k]]) - Vec3d(surfel.position);
        const Vec3d cross = glm::cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
        const double length = glm::length(cross);
        if (length == 0.0)
            return false;
        face.normal = cross / length;
        faces.push_back(face);
        return true;
    }

    bool between_solids(const Surfel& surfel, float offset) const {
        // The ray is tilted off the normal, so that it does not run along edges.
        const Vec3 up = glm::normalize(surfel.normal + Vec3(0.0123f, 0.0311f, 0.0217f));
        const float start = 2.0f * offset;
        return is_inside(surface_, surfel.position + start * up, up, offset) &&
               is_inside(surface_, surfel.position - start * up, -up, offset);
    }

    const RaySurface& surface_;
    const Vec3* positions_;
    float offset_;
    const IsOwnFace& is_own_;
    std::vector<Triangle> near_, own_, others_;
    std::vector<NearFace> own_faces_, other_faces_;
};

}

void find_contacts(std::span<Surfel> surfels, const RaySurface& surface, float offset, const IsOwnFace& is_own) {
    constexpr std::size_t grain = 1024;
    std::optional<std::vector<std::uint32_t>> touched;
    if (is_own)
        touched = find_touched(surfels, surface, offset, is_own);
    const std::vector<std::uint32_t> order = touched ? std::move(*touched) : spatial_order(surfels);
    parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
        ContactSearch search(surface, offset, is_own);
        for (std::size_t at = begin; at < end; ++at)
            search.set_contact(order[at], surfels[order[at]]);
    });
}

}
