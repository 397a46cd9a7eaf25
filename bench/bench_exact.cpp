/// Measures the cost of exact rays: 64 rays for every vertex of a scan of about 100,000 vertices, on one core. The
/// argument is the radius in percent of the diagonal. For comparison: the same rays one at a time through Embree
/// itself, and the construction of the BVH.
///
///     build/bench/bench_exact --benchmark_enable_random_interleaving=true --benchmark_repetitions=5
#include "alcove/occlusion/methods/exact.h"
#include "plain_embree.h"
#include "run_on_one_thread.h"
#include "scan.h"

namespace {

using namespace alcove;

constexpr int rays = 64;

float radius(const benchmark::State& state) {
    return 0.01f * static_cast<float>(state.range(0));
}

void count_rays(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scan().surfels.size()) * rays);
}

void build(benchmark::State& state) {
    const std::vector<Vec3> positions = unit_positions(scan());
    for (auto _ : state)
        benchmark::DoNotOptimize(RaySurface(positions, scan().triangles));
}
BENCHMARK(build)->Unit(benchmark::kMillisecond);

void exact(benchmark::State& state) {
    const RaySurface surface(unit_positions(scan()), scan().triangles);
    for (auto _ : state)
        benchmark::DoNotOptimize(evaluate_ao(scan().surfels, surface, Exact{.radius = radius(state), .rays = rays}));
    count_rays(state);
}
BENCHMARK(exact)->ArgName("radius")->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

void embree_one_at_a_time(benchmark::State& state) {
    const PlainEmbree bvh(unit_positions(scan()), scan().triangles, RTC_BUILD_QUALITY_MEDIUM);
    for (auto _ : state)
        benchmark::DoNotOptimize(bvh.bake(scan().surfels, radius(state), rays, PlainEmbree::Calls::single));
    count_rays(state);
}
BENCHMARK(embree_one_at_a_time)->ArgName("radius")->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

}

int main(int argc, char** argv) {
    return run_on_one_thread(argc, argv);
}
