#include "exact_distance.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace alcove::test {
namespace {

double segment_distance(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const Vec3d ab = b - a;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0.0 ? std::fmin(1.0, std::fmax(0.0, glm::dot(p - a, ab) / length2)) : 0.0;
    return glm::length(p - a - t * ab);
}

/// The distance to the nearest edge, or to the plane if the foot of the perpendicular is inside the triangle.
double triangle_distance(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double edges =
        std::fmin(segment_distance(p, a, b), std::fmin(segment_distance(p, b, c), segment_distance(p, c, a)));
    const Vec3d n = glm::cross(b - a, c - a);
    const double area = glm::length(n);
    if (!(area > 0.0))
        return edges;
    const Vec3d unit = n / area;
    const double height = glm::dot(p - a, unit);
    const Vec3d foot = p - height * unit;
    const auto left_of = [&](const Vec3d& s, const Vec3d& e) {
        return glm::dot(glm::cross(e - s, foot - s), unit) >= 0;
    };
    return left_of(a, b) && left_of(b, c) && left_of(c, a) ? std::fmin(edges, std::fabs(height)) : edges;
}

}

ExactSurface::ExactSurface(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame)
    : triangles_(triangles.begin(), triangles.end()), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    for (const Vec3d& p : mesh.positions)
        positions_.push_back(is_finite(p) ? (p - frame.center) / frame.diagonal : Vec3d(0.0));
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, positions_.size()));
    for (const Vec3d& p : positions_)
        for (int axis = 0; axis < 3; ++axis)
            *vertices++ = static_cast<float>(p[axis]);
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles_.size()));
    for (const Triangle& t : triangles_)
        for (const std::uint32_t v : t)
            *indices++ = v;
    rtcSetGeometryPointQueryFunction(geometry, &ExactSurface::query);
    rtcSetGeometryUserData(geometry, this);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
}

ExactSurface::~ExactSurface() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

bool ExactSurface::query(RTCPointQueryFunctionArguments* arguments) {
    auto& best = *static_cast<std::pair<const ExactSurface*, double>*>(arguments->userPtr);
    const ExactSurface& self = *best.first;
    const Triangle& t = self.triangles_[arguments->primID];
    const RTCPointQuery& at = *arguments->query;
    const double d =
        triangle_distance({at.x, at.y, at.z}, self.positions_[t[0]], self.positions_[t[1]], self.positions_[t[2]]);
    if (d >= best.second)
        return false;
    best.second = d;
    // Slightly more than the distance, so that rounding of bounding boxes does not exclude an equal one.
    arguments->query->radius = static_cast<float>(d * 1.00001);
    return true;
}

double ExactSurface::distance(const Vec3& p) const {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery at{p.x, p.y, p.z, 0.0f, std::numeric_limits<float>::infinity()};
    std::pair<const ExactSurface*, double> best{this, std::numeric_limits<double>::infinity()};
    rtcPointQuery(scene_, &at, &context, &ExactSurface::query, &best);
    return best.second;
}

double ExactSurface::winding_number(const Vec3& p) const {
    double angle = 0.0;
    for (const Triangle& t : triangles_) {
        const Vec3d a = positions_[t[0]] - Vec3d(p), b = positions_[t[1]] - Vec3d(p), c = positions_[t[2]] - Vec3d(p);
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                  la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return angle / (4.0 * std::numbers::pi);
}

template <class Open>
void ExactSurface::cast(const Surfel& surfel, float radius, int rays, Open open) const {
    // A tangent frame, built independently of the library's.
    const Vec3 n = surfel.normal;
    const Vec3 other = std::fabs(n.x) < 0.6f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 tangent = glm::normalize(glm::cross(other, n)), bitangent = glm::cross(n, tangent);
    const Vec3 origin = surfel.position + 1e-4f * n;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (int i = 0; i < rays; ++i) {
        // Malley's method (Malley 1988) on Hammersley points: (i + 1/2)/N and the bit-reversed i.
        std::uint32_t bits = static_cast<std::uint32_t>(i), reversed = 0;
        for (int b = 0; b < 32; ++b, bits >>= 1)
            reversed = reversed << 1 | (bits & 1);
        const double u = (i + 0.5) / rays, v = reversed * 0x1p-32;
        const double r = std::sqrt(u), phi = 2.0 * std::numbers::pi * v;
        const Vec3 d = static_cast<float>(r * std::cos(phi)) * tangent +
                       static_cast<float>(r * std::sin(phi)) * bitangent + static_cast<float>(std::sqrt(1.0 - u)) * n;
        RTCRay ray{};
        ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
        ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
        ray.tfar = radius;
        ray.mask = 0xffffffffu;
        rtcOccluded1(scene_, &context, &ray);
        if (ray.tfar >= 0.0f)
            open(d);
    }
}

double ExactSurface::visibility(const Surfel& surfel, float radius, int rays) const {
    int open = 0;
    cast(surfel, radius, rays, [&](const Vec3&) { ++open; });
    return static_cast<double>(open) / rays;
}

Vec3d ExactSurface::bent_normal(const Surfel& surfel, float radius, int rays) const {
    Vec3d sum(0.0);
    cast(surfel, radius, rays, [&](const Vec3& direction) { sum += direction; });
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : sum;
}

Vec3 ExactSurface::point(std::size_t triangle, float u, float v) const {
    const Triangle& t = triangles_[triangle];
    const double root = std::sqrt(u);
    return Vec3((1.0 - root) * positions_[t[0]] + root * (1.0 - v) * positions_[t[1]] + root * v * positions_[t[2]]);
}

}
