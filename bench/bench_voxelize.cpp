/// Measures the cost of converting an indexed mesh to an OpenVDB level set with a band of five voxels on both sides: by
/// voxelize(), and for comparison by openvdb::tools::meshToVolume with its default flags. The meshes are a scan of
/// 26,002 vertices, and its subdivisions with 104,002 and 416,002. Also measures the cost of the field of clustered
/// triangles. Compare CPU times; with two threads, compare real times.
///
///     build/bench/bench_voxelize --benchmark_enable_random_interleaving=true --benchmark_repetitions=5
#include "alcove/base/parallel.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "openvdb_peer.h"

namespace {

using namespace alcove;

constexpr float band = 5.0f;

VoxelizeOptions options(const benchmark::State& state) {
    VoxelizeOptions result;
    result.grid.voxel = 1.0f / static_cast<float>(state.range(1));
    result.grid.outer_band = result.grid.inner_band = band;
    result.grid.radius = (band - 1.0f) * result.grid.voxel; // a single level
    return result;
}

void ours(benchmark::State& state) {
    const Scan& s = scan(state.range(0));
    const ThreadLimit limit(static_cast<unsigned>(state.range(2)));
    for (auto _ : state)
        benchmark::DoNotOptimize(voxelize(s.mesh, s.triangles, options(state)));
}

/// All levels for a radius of half the diagonal.
void ours_far(benchmark::State& state) {
    const Scan& s = scan(state.range(0));
    const ThreadLimit limit(static_cast<unsigned>(state.range(2)));
    VoxelizeOptions far = options(state);
    far.grid.radius = 0.5f;
    for (auto _ : state)
        benchmark::DoNotOptimize(voxelize(s.mesh, s.triangles, far));
}

/// From triangles to the field, with clusters where triangles are far smaller than voxels.
void ours_clustered(benchmark::State& state) {
    const Scan& s = scan(state.range(0));
    const ThreadLimit limit(static_cast<unsigned>(state.range(2)));
    VoxelizeOptions coarse;
    coarse.grid.voxel = 1.0f / static_cast<float>(state.range(1));
    coarse.grid.radius = 4.0f * coarse.grid.voxel; // one level
    coarse.grid.cluster = true;
    for (auto _ : state)
        benchmark::DoNotOptimize(LevelStack(voxelize(s.mesh, s.triangles, coarse)));
    state.counters["per_triangle"] =
        benchmark::Counter(static_cast<double>(s.triangles.size()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void openvdb_mesh_to_volume(benchmark::State& state) {
    const OpenVdbMesh mesh(scan(state.range(0)));
    const ThreadLimit limit(static_cast<unsigned>(state.range(2)));
    const double voxel = 1.0 / static_cast<double>(state.range(1));
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    for (auto _ : state)
        benchmark::DoNotOptimize(
            openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, mesh.points, mesh.triangles, band));
}

void all_sizes(benchmark::internal::Benchmark* bench) {
    bench->ArgNames({"level", "voxels", "threads"})
        ->ArgsProduct({{0, 1, 2}, {128, 256}, {1, 2}})
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime();
}
BENCHMARK(ours)->Apply(all_sizes);
BENCHMARK(ours_far)->Apply(all_sizes);
BENCHMARK(openvdb_mesh_to_volume)->Apply(all_sizes);
BENCHMARK(ours_clustered)
    ->ArgNames({"level", "voxels", "threads"})
    ->ArgsProduct({{2}, {64, 128}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}

BENCHMARK_MAIN();
