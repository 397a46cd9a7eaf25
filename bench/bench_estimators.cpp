/// Measures the cost of occlusion alone, with the grid and the BVH built in advance: every method of the catalog at its
/// defaults, on a scan of about 100,000 vertices, on one core, at a radius of a tenth of the diagonal. For comparison:
/// Embree with 16 and 64 rays per vertex, and the five probes of `classic` through the samplers of OpenVDB and NanoVDB,
/// one probe at a time, on a single level with the same voxel. The counters `map` and `rays` are per vertex.
///
///     build/bench/bench_estimators --benchmark_enable_random_interleaving=true --benchmark_repetitions=5
#include "alcove/grid/voxelize.h"
#include "alcove/measure/detail/counting_field.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/methods/reference/classic.h"
#include "openvdb_peer.h"
#include "plain_embree.h"
#include "run_on_one_thread.h"

#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>

namespace {

using namespace alcove;

constexpr float radius = 0.1f;
/// The voxel that voxelize() chooses for a radius of a tenth of the diagonal.
constexpr float voxel = GridOptions{}.largest_voxel;

const LevelStack& field() {
    static const LevelStack stack(voxelize(scan().mesh, scan().triangles, {.grid = {.radius = radius}}));
    return stack;
}

const RaySurface& surface() {
    static const RaySurface bvh(unit_positions(scan()), scan().triangles);
    return bvh;
}

double map_calls(const Method& method) {
    constexpr std::size_t counted = 1024;
    const std::vector<Surfel>& all = scan().surfels;
    std::vector<Surfel> some;
    for (std::size_t i = 0; i < counted; ++i)
        some.push_back(all[i * all.size() / counted]);
    const CountingField counting(field());
    evaluate(some, Occluders(counting, surface()), method, {.radius = radius}, Channel::ao);
    return static_cast<double>(counting.calls()) / counted;
}

void estimator(benchmark::State& state, const Method& method) {
    const Occluders occluders(field(), surface());
    const std::vector<Surfel>& surfels = scan().surfels;
    std::vector<float> ao;
    for (auto _ : state)
        ao = evaluate(surfels, occluders, method, {.radius = radius}, Channel::ao)[Channel::ao];
    count_vertices(state, ao);
    state.counters["map"] = map_calls(method);
    state.counters["rays"] = choose(method).rays();
}

void embree(benchmark::State& state, PlainEmbree::Calls calls) {
    static const PlainEmbree bvh(unit_positions(scan()), scan().triangles, RTC_BUILD_QUALITY_MEDIUM);
    const int rays = static_cast<int>(state.range(0));
    std::vector<float> ao;
    for (auto _ : state)
        ao = bvh.bake(scan().surfels, radius, rays, calls);
    count_vertices(state, ao);
    state.counters["rays"] = rays;
}
BENCHMARK_CAPTURE(embree, single, PlainEmbree::Calls::single)
    ->ArgName("rays")
    ->Arg(16)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(embree, stream, PlainEmbree::Calls::stream)
    ->ArgName("rays")
    ->Arg(16)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond);

const openvdb::FloatGrid::Ptr& vdb() {
    static const openvdb::FloatGrid::Ptr grid = openvdb_grid(OpenVdbMesh(scan()), voxel, radius);
    return grid;
}

template <class F>
void classic_through(benchmark::State& state, const F& peer) {
    std::vector<float> ao;
    for (auto _ : state)
        ao = evaluate_ao(scan().surfels, peer, Classic{.radius = radius});
    count_vertices(state, ao);
}

void openvdb_classic(benchmark::State& state) {
    classic_through(state, OpenVdbField(vdb(), voxel));
}
BENCHMARK(openvdb_classic)->Unit(benchmark::kMillisecond);

struct NanoVdbField {
    float map(const Vec3& p) const {
        const Vec3 index = p / voxel;
        return nanovdb::createSampler<1>(accessor)(nanovdb::Vec3f(index.x, index.y, index.z));
    }
    nanovdb::DefaultReadAccessor<float> accessor;
};

void nanovdb_classic(benchmark::State& state) {
    static const auto handle = nanovdb::openToNanoVDB(*vdb());
    classic_through(state, NanoVdbField{handle.grid<float>()->getAccessor()});
}
BENCHMARK(nanovdb_classic)->Unit(benchmark::kMillisecond);

}

int main(int argc, char** argv) {
    for (const Method& method : catalog())
        if (method.gives.has(Channel::ao))
            benchmark::RegisterBenchmark(std::string(method.name).c_str(), estimator, method)
                ->Unit(benchmark::kMillisecond);
    return run_on_one_thread(argc, argv);
}
