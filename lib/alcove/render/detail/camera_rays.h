/// Traces camera rays from pixels to the surfels they hit.
#pragma once

#include "alcove/field/detail/trace.h"
#include "alcove/render/camera.h"
#include "alcove/render/detail/cones.h"
#include "alcove/render/renderer.h"

#include <span>
#include <vector>

namespace alcove {

/// A rectangle of the image.
struct PixelRegion {
    int x = 0, y = 0; ///< upper left pixel
    int width = 0, height = 0;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    /// The number of squares of side `side` that cover the region. Squares at the right and lower edges are cut off.
    std::size_t tiles(int side) const {
        return static_cast<std::size_t>((width + side - 1) / side) *
               static_cast<std::size_t>((height + side - 1) / side);
    }
};

/// The hits of image samples. Each vector has one entry per sample.
struct Hits {
    std::vector<Surfel> surfels;   ///< unit space, normals toward the eye; without a normal if the ray missed
    std::vector<float> depths;     ///< along the view axis, scene units
    std::vector<ObjectId> objects; ///< no_object if the ray missed
    std::vector<Vec3> colors;      ///< colours of the mesh in linear light; empty if no mesh has colours
    std::vector<Triangle> faces;   ///< triangles hit; empty without a mesh; all corners 0 if snap() found no triangle
    std::vector<float> steps;      ///< map() calls along each ray; empty if not requested

    void resize(std::size_t samples, bool with_steps) {
        surfels.resize(samples);
        depths.resize(samples);
        objects.resize(samples);
        steps.resize(with_steps ? samples : 0);
    }
};

/// Tolerances in unit space, derived from the resolution of a field.
struct RayPrecision {
    float voxel;         ///< 0 for analytic fields
    float hit_distance;  ///< distance of a hit in two-sided fields; in other fields, the sign must change
    float shortest_step; ///< shortest step of a ray
    float difference;    ///< half width of the central differences for normals
    float slack;         ///< margin around the box: behind a sheet, distances jump up to two voxels from it

    explicit RayPrecision(float resolution);
};

/// Rays from the eye through the same `samples` positions of every pixel, sphere-traced inside the box of the
/// renderable.
///
/// The surface is the zero crossing of the field, located to within a voxel at edges, and to within a hundredth of a
/// voxel away from edges and outlines. Normals are central differences of the part that is hit, mirrored toward the eye
/// if they point away. In a two-sided field they are evaluated in front of the face, whichever side is seen, because
/// distances jump behind it. Grounds are intersected exactly. Keeps references to `renderable` and `camera`. `const`
/// use is thread-safe.
class CameraRays {
  public:
    CameraRays(const Renderable& renderable, const Camera& camera, int samples);

    /// Side in pixels of a tile, whose rays share a start distance.
    static constexpr int tile_side = 8;

    /// Traces the tiles [begin, end) of a region, counted row by row from its upper left. `hits` covers the whole
    /// region: pixels row by row, with the samples of a pixel in sequence. Cost in map() calls: up to 48 per tile,
    /// 3–15 per ray near the surface, and 10 per hit (22 in a two-sided field); 99 more per hit near an edge seen at a
    /// grazing angle.
    void trace(const PixelRegion& region, std::size_t begin, std::size_t end, Hits& hits) const;

    /// Sets a sample to the ground that the ray from the eye meets, or to the background.
    void set_background(const Vec3d& ray, std::size_t at, Hits& hits) const;

    const Camera& camera() const { return camera_; }

  private:
    using Values = RayBatch::Values;
    struct Batch : RayBatch {
        std::array<double, capacity> before;     // distance from the eye to the origin of the ray in the batch
        std::array<std::size_t, capacity> owner; // index into the hits

        void add(const Vec3& origin, const Vec3& direction, float start, double from_eye, std::size_t index) {
            before[count] = from_eye;
            owner[count] = index;
            push_back({origin, direction}, start);
        }
        /// Adds ray `i` of another batch and moves its origin ahead by `ahead`. `start` is the length travelled,
        /// measured from the old origin.
        void add(const Batch& other, std::size_t i, float start, float ahead) {
            add(other.origin(i) + ahead * other.direction(i), other.direction(i), start - ahead,
                other.before[i] + static_cast<double>(ahead), other.owner[i]);
        }
        Vec3 origin(std::size_t i) const { return {x[i], y[i], z[i]}; }
        Vec3 direction(std::size_t i) const { return {dx[i], dy[i], dz[i]}; }
        Vec3 place(std::size_t i, float ahead = 0.0f) const {
            return origin(i) + (travelled[i] + ahead) * direction(i);
        }
    };
    struct Places {
        Values x, y, z;
        std::size_t count = 0;

        void add(const Vec3& p) { x[count] = p.x, y[count] = p.y, z[count++] = p.z; }
        Points points() const { return {x.data(), y.data(), z.data(), count}; }
    };
    using Gradients = std::array<Vec3, RayBatch::capacity>;

    /// The first hit of a ray on a ground.
    struct GroundHit {
        double distance = std::numeric_limits<double>::infinity(); ///< unit space
        ObjectId object = no_object;
    };

    Cone cone_around(const PixelRegion& tile) const;
    void trace_tile(const PixelRegion& tile, const PixelRegion& region, double start, Batch& rays, Hits& hits) const;
    void flush(Batch& rays, Hits& hits) const;
    GroundHit meet_ground(const Vec3d& ray) const;
    void set_ground(const Vec3d& ray, const GroundHit& ground, std::size_t at, Hits& hits) const;
    void name_parts(std::span<const std::size_t> places, Hits& hits) const;
    Batch traced(Batch& rays, Hits& hits) const;
    void meet(Batch& rays, Hits& hits) const;
    void meet_parts(Batch& met, Hits& hits) const;
    Batch meet_two_sided(Batch& rays, bool last, Hits& hits) const;
    static Places places(const Batch& rays, float ahead = 0.0f);
    Values distances(const Places& places) const;
    static Gradients differences(const AnyField& field, const Places& places, float h);
    void set_sharpened(const AnyField& field, Batch& met, std::size_t i, const Vec3& gradient, ObjectId object,
                       Hits& hits) const;
    void set(const Batch& rays, std::size_t i, const Vec3& gradient, ObjectId object, Hits& hits) const;

    const Renderable& renderable_;
    const AnyField& field_;
    const Camera& camera_;
    Frame frame_;
    RayPrecision precision_;
    bool two_sided_;
    Vec3d eye_, low_, high_;   // unit space
    float far_;                // longer than any ray segment inside the box
    double nearest_;           // distance from the eye to the box, unit space
    double furthest_;          // largest distance from the eye to a point of the box, unit space
    std::vector<Vec2> within_; // positions of the samples in a pixel
};

}
