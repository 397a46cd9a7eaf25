/// The cost of exact rays: 64 for every vertex of a scan of about 100,000, on one core, at the radius of the
/// argument in percent of the diagonal. Beside it the same rays one at a time through Embree itself, and the
/// building of the hierarchy.
///
///     build/bench/bench_exact --benchmark_enable_random_interleaving=true --benchmark_repetitions=5
#include "alcove/mesh/normals.h"
#include "alcove/mesh/read.h"
#include "alcove/occlusion/exact.h"
#include "subdivided.h"

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

namespace {

using namespace alcove;

constexpr int rays = 64;

struct Scene {
    Scene() {
        const Mesh mesh = subdivided(read_mesh(ALCOVE_REAL_MESHES "/armadillo.off"));
        triangles = triangulate(mesh).triangles;
        surfels = make_surfels(mesh, triangles, frame_of(mesh.box()));
        for (const Surfel& surfel : surfels)
            positions.push_back(surfel.position);
    }

    std::vector<Triangle> triangles;
    std::vector<Surfel> surfels;
    std::vector<Vec3> positions;
    ThreadLimit one_thread{1};
};

const Scene& scene() {
    static const Scene scene;
    return scene;
}

float radius(const benchmark::State& state) {
    return 0.01f * static_cast<float>(state.range(0));
}

void count_rays(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene().surfels.size()) * rays);
}

void build(benchmark::State& state) {
    for (auto _ : state)
        benchmark::DoNotOptimize(RaySurface(scene().positions, scene().triangles));
}
BENCHMARK(build)->Unit(benchmark::kMillisecond);

void exact(benchmark::State& state) {
    const RaySurface surface(scene().positions, scene().triangles);
    for (auto _ : state)
        benchmark::DoNotOptimize(
            bake(scene().surfels, surface, Exact{.radius = radius(state), .rays = rays}));
    count_rays(state);
}
BENCHMARK(exact)->ArgName("radius")->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

void embree_one_at_a_time(benchmark::State& state) {
    const Scene& s = scene();
    const RTCDevice device = rtcNewDevice(nullptr);
    const RTCScene embree = rtcNewScene(device);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), s.positions.size()));
    std::copy(s.positions.begin(), s.positions.end(), positions);
    auto* triangles = static_cast<Triangle*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), s.triangles.size()));
    std::copy(s.triangles.begin(), s.triangles.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(embree);
    const std::vector<std::uint32_t> order = spatial_order(s.surfels);
    const CosineLattice lattice(rays);
    for (auto _ : state) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        int open = 0;
        for (const std::uint32_t i : order) {
            const Surfel& surfel = s.surfels[i];
            const Basis basis(surfel.normal);
            const Vec3 origin = surfel.position + 1e-4f * surfel.normal;
            const CosineLattice::Shift shift(hash(surfel.position, 0));
            for (int r = 0; r < rays; ++r) {
                const Vec3 direction = basis.to_world(lattice.direction(r, shift));
                RTCRay ray{};
                ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
                ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
                ray.tfar = radius(state);
                ray.mask = ~0u;
                rtcOccluded1(embree, &context, &ray);
                open += ray.tfar >= 0.0f;
            }
        }
        benchmark::DoNotOptimize(open);
    }
    count_rays(state);
    rtcReleaseScene(embree);
    rtcReleaseDevice(device);
}
BENCHMARK(embree_one_at_a_time)->ArgName("radius")->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

}

BENCHMARK_MAIN();
