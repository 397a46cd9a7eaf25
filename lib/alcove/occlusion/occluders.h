/// What occludes: a field, triangles for rays, or both.
#pragma once

#include "alcove/field/field.h"

#include <memory>
#include <optional>
#include <span>

namespace alcove {

struct RayBatch; // rays as arrays (field/detail/trace.h)

/// A place on a triangle.
struct SurfaceHit {
    Triangle vertices{}; ///< positions as they were given
    Vec3 weights{0.0f};  ///< of the vertices, of sum 1
    Vec3 normal{0.0f};   ///< of the triangle, of any length
};

/// Triangles under a bounding volume hierarchy. I. Wald et al., "Embree: A Kernel Framework for Efficient CPU
/// Ray Tracing" (2014). Copies share it; `const` use is safe from any number of threads.
class RaySurface {
  public:
    /// In unit space; nothing is kept of the spans. Triangles may be degenerate, and one with a corner that is
    /// not finite is left out. Cost: about 0.2 µs a triangle. \throw InputError where a corner names no
    /// position; LimitError where there is too little memory.
    RaySurface(std::span<const Vec3> positions, std::span<const Triangle> triangles);

    /// Sets `hit` of every ray: whether it meets a triangle, from either side, beyond its `travelled` and
    /// within `far`, which may be infinite. Cost: about 0.1 µs a ray where neighbours in the batch start near
    /// each other.
    void find_occluded(RayBatch& rays, float far) const;

    /// The same, and for those that meet one: the nearest, in `travelled` how far it is, and in `hits`, one a ray, where.
    void find_nearest(RayBatch& rays, float far, std::span<SurfaceHit> hits) const;

  private:
    struct Scene;
    std::shared_ptr<const Scene> scene_;
};

/// A field, triangles, or both, in unit space. Copies share them; const use is thread-safe.
class Occluders {
  public:
    Occluders(AnyField field) : field_(std::move(field)) {}
    Occluders(RaySurface rays) : rays_(std::move(rays)) {}
    Occluders(AnyField field, RaySurface rays) : field_(std::move(field)), rays_(std::move(rays)) {}

    /// \throw InputError where there is none.
    const AnyField& field() const;
    /// \throw InputError where there are no triangles.
    const RaySurface& rays() const;

  private:
    std::optional<AnyField> field_;
    std::optional<RaySurface> rays_;
};

}
