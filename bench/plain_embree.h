/// Occlusion by the most direct use of Embree.
#pragma once

#include "alcove/occlusion/methods/exact.h"

#include <embree3/rtcore.h>

namespace alcove {

class PlainEmbree {
  public:
    PlainEmbree(std::span<const Vec3> positions, std::span<const Triangle> triangles, RTCBuildQuality quality) {
        rtcSetSceneBuildQuality(scene_, quality);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(geometry, quality);
        auto* corners = static_cast<Vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                   RTC_FORMAT_FLOAT3, sizeof(Vec3), positions.size()));
        std::copy(positions.begin(), positions.end(), corners);
        auto* faces = static_cast<Triangle*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), triangles.size()));
        std::copy(triangles.begin(), triangles.end(), faces);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~PlainEmbree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    PlainEmbree(const PlainEmbree&) = delete;
    PlainEmbree& operator=(const PlainEmbree&) = delete;

    enum class Calls {
        single, ///< rtcOccluded1
        stream, ///< rtcOccluded1M, one call per surfel
    };

    /// Returns one value per surfel, from rays in the directions of Exact.
    std::vector<float> bake(std::span<const Surfel> surfels, float radius, int rays, Calls calls) const {
        std::vector<float> ao(surfels.size(), 1.0f);
        const CosineLattice lattice(rays);
        std::vector<RTCRay> hemisphere(static_cast<std::size_t>(rays));
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (const std::uint32_t i : spatial_order(surfels)) {
            const Basis basis(surfels[i].normal);
            const Vec3 origin = surfels[i].position + ray_offset(radius) * basis.normal;
            const CosineLattice::Shift shift(hash(surfels[i].position, 0));
            for (int r = 0; r < rays; ++r) {
                const Vec3 direction = basis.to_world(lattice.direction(r, shift));
                RTCRay& ray = hemisphere[static_cast<std::size_t>(r)];
                ray = {};
                ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
                ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
                ray.tfar = radius;
                ray.mask = ~0u;
                if (calls == Calls::single)
                    rtcOccluded1(scene_, &context, &ray);
            }
            if (calls == Calls::stream)
                rtcOccluded1M(scene_, &context, hemisphere.data(), static_cast<unsigned>(rays), sizeof(RTCRay));
            const auto open =
                std::count_if(hemisphere.begin(), hemisphere.end(), [](const RTCRay& ray) { return ray.tfar >= 0.0f; });
            ao[i] = static_cast<float>(open) / static_cast<float>(rays);
        }
        return ao;
    }

  private:
    RTCDevice device_ = rtcNewDevice(nullptr);
    RTCScene scene_ = rtcNewScene(device_);
};

}
