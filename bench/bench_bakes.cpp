/// Measures whole bakes on one core, from an indexed mesh to one value per vertex: normals, the grid and the BVH if the
/// method needs them, and occlusion. The radius is a tenth of the diagonal; the meshes are a scan of about 100,000
/// vertices and its subdivision. For comparison: Embree alone with ray streams, and `classic` by OpenVDB alone, on a
/// single level with the same voxel and on one with a voxel twice as wide.
///
///     build/bench/bench_bakes --benchmark_enable_random_interleaving=true --benchmark_repetitions=5
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/methods/reference/classic.h"
#include "openvdb_peer.h"
#include "plain_embree.h"
#include "run_on_one_thread.h"

namespace {

using namespace alcove;

constexpr float radius = 0.1f;

std::vector<Surfel> surfels_of(const Scan& scan) {
    return make_surfels(scan.mesh, scan.triangles, scan.frame);
}

Occluders occluders_of(const Scan& scan, const Method& method) {
    const auto field = [&] { return LevelStack(voxelize(scan.mesh, scan.triangles, {.grid = {.radius = radius}})); };
    const auto surface = [&] { return RaySurface(unit_positions(scan), scan.triangles); };
    if (!method.needs_mesh)
        return Occluders(field());
    if (!method.needs_grid)
        return Occluders(surface());
    return Occluders(field(), surface());
}

void whole(benchmark::State& state, const MethodChoice& choice) {
    const Scan& s = scan(state.range(0));
    std::vector<float> ao;
    for (auto _ : state)
        ao = evaluate(surfels_of(s), occluders_of(s, *choice.method), *choice.method, choice.settings(radius),
                      Channel::ao)[Channel::ao];
    count_vertices(state, ao);
}

void embree(benchmark::State& state) {
    const Scan& s = scan(state.range(0));
    const int rays = static_cast<int>(state.range(1));
    std::vector<float> ao;
    for (auto _ : state) {
        const PlainEmbree bvh(unit_positions(s), s.triangles, RTC_BUILD_QUALITY_LOW);
        ao = bvh.bake(surfels_of(s), radius, rays, PlainEmbree::Calls::stream);
    }
    count_vertices(state, ao);
}
BENCHMARK(embree)
    ->ArgNames({"level", "rays"})
    ->ArgsProduct({{1, 2}, {16, 64}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

void openvdb_classic(benchmark::State& state) {
    const Scan& s = scan(state.range(0));
    const float voxel = 1.0f / static_cast<float>(state.range(1));
    std::vector<float> ao;
    for (auto _ : state)
        ao = evaluate_ao(surfels_of(s), OpenVdbField(openvdb_grid(OpenVdbMesh(s), voxel, radius), voxel),
                         Classic{.radius = radius});
    count_vertices(state, ao);
}
BENCHMARK(openvdb_classic)
    ->ArgNames({"level", "voxels"})
    ->ArgsProduct({{1, 2}, {128, 256}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}

int main(int argc, char** argv) {
    for (const MethodChoice& choice :
         {choose(find_method("traced"), 64), choose(find_method("guided"), 1), choose(find_method("guided"), 3),
          choose(find_method("calibrated"), 13), choose(find_method("exact"), 16), choose(find_method("exact"), 64),
          choose(find_method("classic"))})
        benchmark::RegisterBenchmark(choice.label().c_str(), whole, choice)
            ->ArgName("level")
            ->Arg(1)
            ->Arg(2)
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime();
    return run_on_one_thread(argc, argv);
}
