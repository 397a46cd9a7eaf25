/// Rays over the hemisphere against the triangles themselves: the reference every other estimator is held to.
#pragma once

#include "alcove/field/trace.h"
#include "alcove/occlusion/bake.h"
#include "alcove/occlusion/directions.h"
#include "alcove/occlusion/parameter.h"

#include <memory>
#include <span>

namespace alcove {

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

/// Visibility along cosine-weighted directions, low-discrepancy, rotated for each surfel by a hash of its
/// position:
///
///     ao = 1/N Σ V(ω_i)        bent normal = normalize(Σ V(ω_i) ω_i)
///
/// V = 0 where the ray from p + 1e-4·n meets a triangle closer than the radius, else 1: it tends to the
/// reference, A(p) = 1/π ∫ V(ω) max(0, n·ω) dω, as rays grow. Source: "04 Ambient Occlusion", lecture notes.
/// No map() calls; `rays` rays a surfel.
struct Exact {
    float radius = 0.1f; ///< > 0; may be infinite
    int rays = 64;       ///< a surfel, >= 1; the error is about 0.016 at 64 and 0.003 at 1,024
    std::uint32_t seed = 0;

    /// Where rays start above the surface, of the diagonal, as the reference is defined.
    static constexpr float offset = 1e-4f;

    static constexpr std::string_view name = "exact";
    static constexpr std::string_view summary = "cosine-weighted rays on the mesh itself: the reference";
    static constexpr std::string_view formula = "1/N sum V(w_i)";
    static constexpr std::string_view source = "04 Ambient Occlusion, lecture notes";
    static constexpr std::string_view cost = "0, and rays (64) on the mesh";

    static constexpr std::string_view good =
        "the reference itself: no grid, no bias, any radius; gives bent normals";
    static constexpr std::string_view bad =
        "noise of 1/rays^0.75; needs the mesh, its rays are dear on dense ones";
    static constexpr bool traces_rays = true; ///< the radius may be infinite
    static constexpr ChannelSet gives = Channel::ao | Channel::bent_normal;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Exact::rays>("rays", 1, 1 << 20, "rays", "in the hemisphere"),
            parameter<&Exact::seed>("seed", 0, 0xffffffffu, "", "of the directions"),
        };
    }

    void operator()(const RaySurface& surface, const SurfelBatch& surfels, const Outputs& out) const;
};

}
