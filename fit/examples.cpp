#include "examples.h"

#include "alcove/field/level_stack.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/exact.h"

#include <optional>

namespace alcove::fit {
namespace {

template <class Probes>
void store(const LevelStack& field, const SurfelBatch& batch, float radius, std::size_t first,
           Eigen::MatrixXf& columns) {
    CalibratedInputs<Probes> inputs;
    calibrated_inputs<Probes>(field, batch, radius, inputs);
    for (std::size_t k = 0; k < batch.count; ++k)
        for (std::size_t i = 0; i < inputs.size(); ++i)
            columns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(first + k)) = inputs[i][k];
}

std::vector<Surfel> some_surfels(const std::vector<Surfel>& all, std::size_t max) {
    std::vector<Surfel> some;
    const std::size_t count = std::min(max, all.size());
    for (std::size_t i = 0; i < count; ++i)
        if (const Surfel& surfel = all[i * all.size() / count]; surfel.has_normal())
            some.push_back(surfel);
    return some;
}

}

std::array<Examples, radii.size()> make_examples(const std::filesystem::path& path, std::size_t max_surfels, int rays) {
    const Mesh mesh = read_mesh(path.string());
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    const std::vector<Surfel> surfels = some_surfels(make_surfels(mesh, triangles, frame), max_surfels);

    std::array<Examples, radii.size()> sets;
    const auto count = static_cast<Eigen::Index>(surfels.size());
    for (Examples& set : sets) {
        set.ten.resize(probe_count<TenProbes>, count);
        set.twenty_four.resize(probe_count<TwentyFourProbes>, count);
    }
    std::vector<Vec3> positions;
    for (const Vec3d& p : mesh.positions)
        positions.push_back(frame.to_unit(p));
    const RaySurface surface(positions, triangles);
    std::optional<LevelStack> field;
    float voxel = 0.0f;
    for (std::size_t r = 0; r < radii.size(); ++r) {
        const std::vector<float> truth = evaluate_ao(surfels, surface, Exact{.radius = radii[r], .rays = rays});
        sets[r].truth = Eigen::VectorXf::Map(truth.data(), count);
        VoxelizeOptions options;
        options.grid.radius = radii[r];
        // Reuse the grid of the larger radius if its voxel is the same.
        if (const float wanted = plan_levels(mesh, triangles, options.grid).voxel; wanted != voxel) {
            field.emplace(voxelize(mesh, triangles, options));
            voxel = wanted;
        }
        for (std::size_t begin = 0; begin < surfels.size(); begin += SurfelBatch::capacity) {
            SurfelBatch batch;
            for (std::size_t i = begin; i < std::min(begin + SurfelBatch::capacity, surfels.size()); ++i)
                batch.push_back(surfels[i]);
            store<TenProbes>(*field, batch, radii[r], begin, sets[r].ten);
            store<TwentyFourProbes>(*field, batch, radii[r], begin, sets[r].twenty_four);
        }
    }
    return sets;
}

}
