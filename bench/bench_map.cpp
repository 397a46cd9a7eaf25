/// Measures the cost of a map() call: five probes along the normal of every vertex of a scan of about 100,000 vertices,
/// on one core. There are 128 voxels along the diagonal and a band of 5 voxels; the vertices are in file order, and in
/// the order that bakes use. For comparison: the samplers of OpenVDB and NanoVDB, and as a baseline a scalar trilinear
/// fetch from a dense array.
///
///     build/bench/bench_map --benchmark_enable_random_interleaving=true --benchmark_repetitions=5
#include "alcove/field/detail/bricks.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/grid/voxelize.h"
#include "alcove/occlusion/estimator.h"
#include "dense_array.h"
#include "probe_batches.h"
#include "scan.h"

#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/tools/Interpolation.h>

namespace {

using namespace alcove;

constexpr int probes = 5;
constexpr float voxel = 1.0f / 128.0f;

struct Scene {
    Scene() {
        VoxelizeOptions options;
        options.grid.voxel = voxel;
        options.grid.radius = 4.0f * voxel;
        stack = voxelize(scan().mesh, scan().triangles, options);
        bricks =
            std::make_unique<Bricks>(stack.levels.front(), static_cast<float>(stack.value_unit / stack.frame.diagonal));
        for (const std::uint32_t i : spatial_order(scan().surfels))
            sorted.push_back(scan().surfels[i]);
    }

    GridStack stack;
    std::unique_ptr<Bricks> bricks;
    std::vector<Surfel> sorted; ///< along a Morton curve

    const std::vector<Surfel>& order(const benchmark::State& state) const {
        return state.range(0) ? sorted : scan().surfels;
    }
};

const Scene& scene() {
    static const Scene scene;
    return scene;
}

/// Calls `sample(p)` for every probe, with p in index space.
template <class Sample>
void probe_all(benchmark::State& state, const Sample& sample) {
    const Scene& s = scene();
    const Vec3 origin = s.stack.levels.front().origin;
    float sum = 0.0f;
    for (auto _ : state) {
        for (const Surfel& surfel : s.order(state)) {
            const Vec3 p = (surfel.position - origin) / voxel;
            for (int i = 0; i < probes; ++i)
                sum += sample(p + 0.8f * static_cast<float>(i) * surfel.normal);
        }
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.sorted.size()) * probes);
}

void dense_array(benchmark::State& state) {
    static const DenseArray dense;
    probe_all(state, [&](const Vec3& p) { return dense.at(p); });
}
BENCHMARK(dense_array)->ArgName("sorted")->Arg(0)->Arg(1);

void openvdb_box_sampler(benchmark::State& state) {
    const auto accessor = scene().stack.levels.front().grid->grid->getConstAccessor();
    probe_all(state, [&](const Vec3& p) {
        return openvdb::tools::BoxSampler::sample(accessor, openvdb::Vec3d(p.x, p.y, p.z));
    });
}
BENCHMARK(openvdb_box_sampler)->ArgName("sorted")->Arg(0)->Arg(1);

void nanovdb_sampler(benchmark::State& state) {
    static const auto handle = nanovdb::openToNanoVDB(*scene().stack.levels.front().grid->grid);
    const auto accessor = handle.grid<float>()->getAccessor();
    const auto sampler = nanovdb::createSampler<1>(accessor);
    probe_all(state, [&](const Vec3& p) { return sampler(nanovdb::Vec3f(p.x, p.y, p.z)); });
}
BENCHMARK(nanovdb_sampler)->ArgName("sorted")->Arg(0)->Arg(1);

void bricks_scalar(benchmark::State& state) {
    const Vec3 origin = scene().stack.levels.front().origin;
    probe_all(state, [&](const Vec3& p) { return scene().bricks->map(origin + voxel * p); });
}
BENCHMARK(bricks_scalar)->ArgName("sorted")->Arg(0)->Arg(1);

void bricks_batched(benchmark::State& state) {
    const Scene& s = scene();
    const std::vector<Surfel>& surfels = s.order(state);
    const BrickView view = s.bricks->view();
    float sum = 0.0f;
    for (auto _ : state) {
        probe_batches(
            surfels, probes, 0.8f * voxel,
            [&](const Points& points, float* distances) { sample_bricks(view, points, distances); },
            [&](const SurfelBatch::Values& distances, std::size_t count) {
                for (std::size_t k = 0; k < count; ++k)
                    sum += distances[k];
            });
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.sorted.size()) * probes);
}
BENCHMARK(bricks_batched)->ArgName("sorted")->Arg(0)->Arg(1);

}

BENCHMARK_MAIN();
