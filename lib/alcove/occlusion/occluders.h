/// Occluding geometry: a field, triangles for rays, or both.
#pragma once

#include "alcove/field/field.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alcove {

struct RayBatch; // rays as arrays (field/detail/trace.h)

/// The height above the surface at which rays of length `radius` start, unit space: small enough not to matter at the
/// scale of the radius, but larger than the rounding errors of coordinates.
float ray_offset(float radius);

/// A point on a triangle.
struct SurfaceHit {
    Triangle vertices{}; ///< indices into the positions given to RaySurface
    Vec3 weights{0.0f};  ///< barycentric coordinates, with sum 1
    Vec3 normal{0.0f};   ///< normal of the triangle, not normalised
};

/// Triangles in a BVH (Embree: Wald 2014). Copies share the BVH. `const` use is safe from any number of threads.
class RaySurface {
  public:
    /// Positions in unit space; copies both spans. Triangles may be degenerate; those with a non-finite corner are
    /// skipped. Cost: about 0.2 µs per triangle. \throw InputError if a corner index is out of range, MemoryError
    /// if memory runs out.
    RaySurface(std::span<const Vec3> positions, std::span<const Triangle> triangles);

    /// Sets `hit` of every ray: whether it meets a triangle, from either side, at a distance between the ray's
    /// `travelled` and `far`. `far` may be infinite. Cost: about 0.1 µs per ray if neighbours in the batch start near
    /// each other.
    void find_occluded(RayBatch& rays, float far) const;

    /// As find_occluded(), but finds the nearest triangle: for each ray that hits, sets `travelled` to the distance and
    /// `hits[i]` to the point. `hits` has one entry per ray.
    void find_nearest(RayBatch& rays, float far, std::span<SurfaceHit> hits) const;

    /// Sets `found` to the triangles within `distance` of a point, and some that are farther away. Leaves out
    /// duplicates that the constructor removed, and triangles that share a vertex with thousands of others. Cost: about
    /// 0.3 µs if successive points are neighbours, and 10 ns per triangle found.
    void find_near(const Vec3& point, float distance, std::vector<Triangle>& found) const;
    /// The positions given to the constructor; null if there are no pairs().
    const Vec3* positions() const;
    /// The triangles that find_near() searches, in pairs with corners 0, 1, 3 and 2, 3, 1; the second of a pair may be
    /// degenerate.
    std::span<const std::array<std::uint32_t, 4>> pairs() const;

  private:
    struct Scene;
    std::shared_ptr<const Scene> scene_;
};

/// A field, triangles, or both, in unit space. Copies share the field and the triangles; `const` use is thread-safe.
class Occluders {
  public:
    Occluders(AnyField field) : field_(std::move(field)) {}
    Occluders(RaySurface rays) : rays_(std::move(rays)) {}
    Occluders(AnyField field, RaySurface rays) : field_(std::move(field)), rays_(std::move(rays)) {}

    /// \throw InputError if there is no field.
    const AnyField& field() const;
    /// \throw InputError if there are no triangles.
    const RaySurface& rays() const;
    bool has_rays() const { return rays_.has_value(); }

  private:
    std::optional<AnyField> field_;
    std::optional<RaySurface> rays_;
};

}
