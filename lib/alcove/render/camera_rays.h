/// The rays of a camera, from pixels to the surfels they meet.
#pragma once

#include "alcove/field/trace.h"
#include "alcove/render/camera.h"
#include "alcove/render/subject.h"

#include <vector>

namespace alcove {

/// What samples of an image met, one after the other.
struct Hits {
    std::vector<Surfel>
        surfels;               ///< unit space, normals toward the eye; without a normal where nothing was met
    std::vector<float> depths; ///< along the view axis, scene units

    void resize(std::size_t samples) {
        surfels.resize(samples);
        depths.resize(samples);
    }
};

/// Lengths in unit space that follow from the resolution of a field.
struct RayPrecision {
    float voxel;         ///< 0 for exact fields
    float hit_distance;  ///< from where on a hit is refined
    float shortest_step; ///< of a ray
    float difference;    ///< between a point and each probe of its normal
    float slack;         ///< around the box: the back of a sheet is two voxels behind its faces

    explicit RayPrecision(float resolution);
};

/// Rays from the eye through the same `samples` places of every pixel, sphere-traced inside the box of the
/// subject.
///
/// The surface is where the field crosses zero, found to a fiftieth of a voxel; normals are central
/// differences of the field, mirrored to the eye's side where they lean away. A face of a sheet seen from
/// behind is where the ray leaves the sheet's layer, with the normal of the face. Keeps references to both
/// arguments. Const use is thread-safe.
class CameraRays {
  public:
    CameraRays(const Subject& subject, const Camera& camera, int samples);

    /// Traces the samples [begin, end), counted through the pixels row by row, into `hits` from place `at`
    /// on. Cost: 5–30 map() calls a ray and 10 a hit; 80 more where a sheet is seen from behind.
    void trace(std::size_t begin, std::size_t end, std::size_t at, Hits& hits) const;

  private:
    using Values = RayBatch::Values;
    struct Batch : RayBatch {
        std::array<double, capacity> before;     // length of the ray in front of its origin in the batch
        std::array<std::size_t, capacity> owner; // place in the hits
    };
    /// Some rays of a batch, as indices.
    struct Selection {
        std::array<std::uint16_t, RayBatch::capacity> ray;
        std::size_t count = 0;

        void add(std::size_t i) { ray[count++] = static_cast<std::uint16_t>(i); }
    };
    struct Places {
        Values x, y, z;

        Points points(std::size_t count) const { return {x.data(), y.data(), z.data(), count}; }
    };

    Vec3d direction(std::size_t sample) const;
    void meet(Batch& rays, Hits& hits) const;
    void go_through(Batch& rays, const Selection& back, Values travelled, Hits& hits) const;
    void differences(const Points& points, Vec3* gradient) const;
    void set(const Batch& rays, std::size_t i, const Surfel& surfel, Hits& hits) const;

    static Places places(const Batch& rays, const Selection& which, const Values& travelled);

    const AnyField& field_;
    const Camera& camera_;
    Frame frame_;
    RayPrecision precision_;
    int samples_;
    bool sheet_;
    Vec3d eye_, low_, high_; // unit space
    float far_;              // longer than any way through the box
};

}
