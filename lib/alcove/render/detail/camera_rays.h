/// The rays of a camera, from pixels to the surfels they meet.
#pragma once

#include "alcove/field/detail/trace.h"
#include "alcove/render/camera.h"
#include "alcove/render/detail/cones.h"
#include "alcove/render/renderable.h"

#include <span>
#include <vector>

namespace alcove {

/// A rectangle of the image.
struct PixelRegion {
    int x = 0, y = 0; ///< of its upper left pixel
    int width = 0, height = 0;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    /// Squares that cover it, those at its right and lower edge cut.
    std::size_t tiles(int side) const {
        return static_cast<std::size_t>((width + side - 1) / side) *
               static_cast<std::size_t>((height + side - 1) / side);
    }
};

/// What samples of an image met, one after the other.
struct Hits {
    std::vector<Surfel>
        surfels;               ///< unit space, normals toward the eye; without a normal where nothing was met
    std::vector<float> depths; ///< along the view axis, scene units
    std::vector<ObjectId> objects;
    std::vector<float> painted; ///< in [0, 1]; empty where nothing is painted
    std::vector<float> steps;   ///< map() calls on the way of each ray; empty where nobody asks

    void resize(std::size_t samples, bool with_steps) {
        surfels.resize(samples);
        depths.resize(samples);
        objects.resize(samples);
        steps.resize(with_steps ? samples : 0);
    }
};

/// Lengths in unit space that follow from the resolution of a field.
struct RayPrecision {
    float voxel;         ///< 0 for exact fields
    float hit_distance;  ///< of a two-sided field; others are met where their sign changes
    float shortest_step; ///< of a ray
    float difference;    ///< between a point and each probe of its normal
    float slack;         ///< around the box: behind a sheet, distances jump up to two voxels off its faces

    explicit RayPrecision(float resolution);
};

/// Rays from the eye through the same `samples` places of every pixel, sphere-traced inside the box of the
/// renderable.
///
/// The surface is where the field crosses zero, found to a hundredth of a voxel off its edges and outlines, and to less than a
/// voxel at edges; normals are
/// central differences of the part that is met, mirrored to the eye's side where they lean away. Of a two-sided field they are
/// taken in front of its faces, whichever side is seen: behind them distances jump. Grounds are met exactly. Keeps
/// references to both arguments. Const use is thread-safe.
class CameraRays {
  public:
    CameraRays(const Renderable& renderable, const Camera& camera, int samples);

    /// Pixels are traced in tiles of this side, whose rays start together.
    static constexpr int tile_side = 8;

    /// Traces the tiles [begin, end) of a region, counted row by row from its upper left, into `hits` of the region:
    /// those of a pixel after each other, pixels row by row. Cost: up to 48 map() calls a tile, 3–15 a ray near the
    /// surface and 10 a hit; 22 a hit of a two-sided field; 99 more where one is beside an edge that is seen at a grazing angle.
    void trace(const PixelRegion& region, std::size_t begin, std::size_t end, Hits& hits) const;

  private:
    using Values = RayBatch::Values;
    struct Batch : RayBatch {
        std::array<double, capacity> before;     // length of the ray in front of its origin in the batch
        std::array<std::size_t, capacity> owner; // place in the hits

        void add(const Vec3& origin, const Vec3& direction, float start, double way_before,
                 std::size_t place) {
            before[count] = way_before;
            owner[count] = place;
            push_back({origin, direction}, start);
        }
        /// A ray of another batch, counted from `ahead` on.
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

    /// Where a ray meets a ground first.
    struct GroundHit {
        double distance = std::numeric_limits<double>::infinity(); ///< unit space
        ObjectId object = no_object;
    };

    Cone cone_around(const PixelRegion& tile) const;
    void trace_tile(const PixelRegion& tile, const PixelRegion& region, double start, Batch& rays,
                    Hits& hits) const;
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
    void set_sharpened(const AnyField& field, Batch& met, std::size_t i, const Vec3& gradient,
                       ObjectId object, Hits& hits) const;
    void set(const Batch& rays, std::size_t i, const Vec3& gradient, ObjectId object, Hits& hits) const;

    const Renderable& renderable_;
    const AnyField& field_;
    const Camera& camera_;
    Frame frame_;
    RayPrecision precision_;
    bool two_sided_;
    Vec3d eye_, low_, high_;   // unit space
    float far_;                // longer than any way through the box
    double nearest_;           // no ray is in the box before this length, unit space
    double furthest_;          // nor after this one
    std::vector<Vec2> within_; // the places of the samples in a pixel
};

}
