#include "alcove/occlusion/occluders.h"

#include "alcove/base/detail/duplicate_faces.h"
#include "alcove/base/types.h"
#include "alcove/field/detail/trace.h"
#include "alcove/occlusion/detail/fan.h"
#include "alcove/occlusion/detail/triangle_pairs.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

namespace alcove {

float ray_offset(float radius) {
    constexpr float of_diagonal = 1e-4f, of_radius = 1e-3f;
    constexpr float rounding = 2.5e-7f; // four units in the last place of coordinates near 0.5
    return std::max(std::min(of_diagonal, of_radius * radius), rounding);
}

struct RaySurface::Scene {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    std::vector<TrianglePair> pairs; // Embree's quads
    std::vector<Fan> fans;           // the triangles that are not in `pairs`
    const Vec3* vertices = nullptr;  // Embree's copy

    Scene() = default;
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    ~Scene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void build(std::span<const Vec3> positions, std::span<const Triangle> triangles);
    void check() const {
        if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
            throw MemoryError(fmt::format("not enough memory for the BVH of the triangles (Embree error {}); "
                                          "use a method without rays, or fewer triangles",
                                          static_cast<int>(error)));
    }
};

void RaySurface::Scene::build(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    const auto buffer = [&](RTCGeometry geometry, RTCBufferType type, RTCFormat format, const auto& items) {
        // Copied, not shared: Embree reads past the last vertex.
        void* to = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(items[0]), items.size());
        check();
        std::memcpy(to, items.data(), items.size_bytes());
        return to;
    };
    // The build takes a quarter of the time that higher qualities take, and rays are as fast.
    constexpr RTCBuildQuality quality = RTC_BUILD_QUALITY_LOW;
    rtcSetSceneBuildQuality(scene, quality);
    // Embree splits a quad into the same two triangles as a pair, and builds from half as many primitives.
    pairs = pair_triangles(positions, triangles);
    if (!pairs.empty()) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        vertices = static_cast<const Vec3*>(buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, positions));
        buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT4, std::span<const TrianglePair>(pairs));
        rtcCommitGeometry(geometry);
    }
    rtcCommitScene(scene);
    check();
}

RaySurface::RaySurface(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    for (const Triangle& triangle : triangles)
        for (const std::uint32_t corner : triangle)
            if (corner >= positions.size())
                throw InputError(
                    fmt::format("a triangle refers to position {}, but there are only {}", corner, positions.size()));
    const auto scene = std::make_shared<Scene>();
    // A ray near coinciding triangles, or near the middle of a fan, would test all of them.
    std::vector<Triangle> distinct, others;
    if (has_duplicates_in_sample(positions, triangles))
        triangles = distinct = without_duplicate_faces(positions, triangles, Duplicates::of_one_side);
    scene->fans = fans_of(positions, triangles, others);
    scene->build(positions, scene->fans.empty() ? triangles : others);
    scene_ = scene;
}

namespace {

RTCRay embree_ray(const RayBatch& rays, std::size_t i, float far) {
    RTCRay ray;
    ray.org_x = rays.x[i], ray.org_y = rays.y[i], ray.org_z = rays.z[i];
    ray.dir_x = rays.dx[i], ray.dir_y = rays.dy[i], ray.dir_z = rays.dz[i];
    ray.tnear = rays.travelled[i];
    ray.tfar = far;
    ray.time = 0.0f;
    ray.mask = ~0u;
    ray.id = static_cast<unsigned>(i);
    ray.flags = 0;
    return ray;
}

RaySegment segment_of(const RayBatch& rays, std::size_t i, float near, float far) {
    return {{rays.x[i], rays.y[i], rays.z[i]}, {rays.dx[i], rays.dy[i], rays.dz[i]}, near, far};
}

/// Below the diagonal, u + v <= 1, the hit is on the pair's first triangle (0, 1, 3), else on the second (2, 3, 1).
SurfaceHit hit_of(const RTCHit& hit, const TrianglePair& pair) {
    const Vec3 normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    if (hit.u + hit.v <= 1.0f)
        return {{pair[0], pair[1], pair[3]}, {1.0f - hit.u - hit.v, hit.u, hit.v}, normal};
    return {{pair[2], pair[3], pair[1]}, {hit.u + hit.v - 1.0f, 1.0f - hit.u, 1.0f - hit.v}, normal};
}

}

void RaySurface::find_occluded(RayBatch& rays, float far) const {
    std::array<RTCRay, RayBatch::capacity> stream;
    for (std::size_t i = 0; i < rays.count; ++i)
        stream[i] = embree_ray(rays, i, far);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    // Measured: a stream of rays with nearby origins is a fifth faster than packets of 16 assembled here, whether
    // or not sorted by octant. Embree's robust mode takes a third longer and changes one ray in a million.
    rtcOccluded1M(scene_->scene, &context, stream.data(), static_cast<unsigned>(rays.count), sizeof(RTCRay));
    for (std::size_t i = 0; i < rays.count; ++i)
        rays.hit[i] = stream[i].tfar < 0.0f;
    for (const Fan& fan : scene_->fans)
        for (std::size_t i = 0; i < rays.count; ++i)
            rays.hit[i] = rays.hit[i] || fan.find(segment_of(rays, i, rays.travelled[i], far), Fan::Wanted::any);
}

void RaySurface::find_nearest(RayBatch& rays, float far, std::span<SurfaceHit> hits) const {
    std::array<RTCRayHit, RayBatch::capacity> stream;
    for (std::size_t i = 0; i < rays.count; ++i) {
        stream[i].ray = embree_ray(rays, i, far);
        stream[i].hit.geomID = stream[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1M(scene_->scene, &context, stream.data(), static_cast<unsigned>(rays.count), sizeof(RTCRayHit));
    for (std::size_t i = 0; i < rays.count; ++i) {
        rays.hit[i] = stream[i].hit.geomID != RTC_INVALID_GEOMETRY_ID;
        if (!rays.hit[i])
            continue;
        rays.travelled[i] = stream[i].ray.tfar;
        hits[i] = hit_of(stream[i].hit, scene_->pairs[stream[i].hit.primID]);
    }
    for (const Fan& fan : scene_->fans)
        for (std::size_t i = 0; i < rays.count; ++i) {
            const RaySegment segment = segment_of(rays, i, stream[i].ray.tnear, rays.hit[i] ? rays.travelled[i] : far);
            if (const std::optional<Fan::Hit> found = fan.find(segment, Fan::Wanted::nearest)) {
                rays.hit[i] = true;
                rays.travelled[i] = static_cast<float>(found->distance);
                hits[i] = {fan.triangles()[found->triangle], Vec3(found->weights), Vec3(found->normal)};
            }
        }
}

const Vec3* RaySurface::positions() const {
    return scene_->vertices;
}

std::span<const TrianglePair> RaySurface::pairs() const {
    return scene_->pairs;
}

void RaySurface::find_near(const Vec3& point, float distance, std::vector<Triangle>& found) const {
    struct Search {
        const std::vector<TrianglePair>& pairs;
        const Vec3* positions;
        Vec3 low, high; // box around the ball
        std::vector<Triangle>& found;

        bool meets(const TrianglePair& pair) const {
            const Vec3 &a = positions[pair[0]], &b = positions[pair[1]], &c = positions[pair[2]],
                       &d = positions[pair[3]];
            const Vec3 least = glm::min(glm::min(a, b), glm::min(c, d)),
                       most = glm::max(glm::max(a, b), glm::max(c, d));
            return least.x <= high.x && most.x >= low.x && least.y <= high.y && most.y >= low.y && least.z <= high.z &&
                   most.z >= low.z;
        }
    } search{scene_->pairs, scene_->vertices, point - distance, point + distance, found};
    found.clear();
    RTCPointQuery query{point.x, point.y, point.z, 0.0f, distance};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto add = [](RTCPointQueryFunctionArguments* at) {
        Search& to = *static_cast<Search*>(at->userPtr);
        const TrianglePair& pair = to.pairs[at->primID];
        if (!to.meets(pair))
            return false;
        to.found.push_back({pair[0], pair[1], pair[3]});
        if (pair[2] != pair[3])
            to.found.push_back({pair[2], pair[3], pair[1]});
        return false; // the search distance stays the same
    };
    rtcPointQuery(scene_->scene, &query, &context, add, &search);
}

const AnyField& Occluders::field() const {
    if (!field_)
        throw InputError("the method probes a grid, but there is none");
    return *field_;
}

const RaySurface& Occluders::rays() const {
    if (!rays_)
        throw InputError("the method traces triangles, but there are none: use traced");
    return *rays_;
}

}
