#include "alcove/measure/measure.h"

#include "alcove/bake/detail/pilot.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/types.h"
#include "alcove/field/detail/bricks.h"
#include "alcove/grid/voxelize.h"
#include "alcove/measure/detail/counting_field.h"
#include "alcove/measure/detail/heat_map.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/contacts.h"
#include "alcove/occlusion/detail/subset.h"
#include "alcove/occlusion/methods/exact.h"

#include <ctime>
#include <limits>

namespace alcove {
namespace {

/// Seeds for the truth and for the labels. They differ from the seed of a bake, so that the noise of a bake with exact
/// rays is independent of the noise of the truth.
constexpr std::uint32_t truth_seed = 0x7ea7, fitted_seed = 0x7c31;
constexpr std::size_t max_counted = 1024;

/// Measures the CPU seconds of the process since construction. Construction also resets the peak memory of the process.
class ProcessMeter {
  public:
    ProcessMeter() { forget_peak_resident_bytes(); }

    double seconds() const { return now() - start_; }

  private:
    static double now() {
        std::timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

    double start_ = now();
};

double map_calls_per_surfel(const MeasuredMesh& mesh, const MeasuredGrid& grid, const MethodChoice& choice,
                            float radius) {
    const CountingField counting(grid.field);
    const std::vector<Surfel> surfels = pick(mesh.surfels, evenly(mesh.order, max_counted));
    evaluate(surfels, Occluders(counting, mesh.rays), *choice.method, choice.settings(radius), Channel::ao);
    return static_cast<double>(counting.calls()) / static_cast<double>(surfels.size());
}

/// For every vertex, the error of the last vertex with a reference value that is not after it on the Morton curve.
std::vector<float> errors_of_all(const MeasuredMesh& mesh, const Truth& truth, std::span<const float> values) {
    std::vector<float> errors(mesh.surfels.size(), 0.0f);
    std::size_t next = 0;
    float error = 0.0f;
    for (const std::uint32_t vertex : mesh.order) {
        if (next < truth.vertices.size() && truth.vertices[next] == vertex) {
            error = values[next] - truth.ao[next];
            ++next;
        }
        errors[vertex] = error;
    }
    return errors;
}

}

RaySurface MeasuredMesh::make_rays() {
    std::vector<Vec3> positions;
    positions.reserve(mesh.positions.size());
    for (const Vec3d& p : mesh.positions)
        positions.push_back(frame.to_unit(p));
    const ProcessMeter meter;
    RaySurface surface(positions, triangles);
    tree_seconds = meter.seconds();
    return surface;
}

MeasuredMesh::MeasuredMesh(std::string n, Mesh m)
    : name(std::move(n)), mesh(std::move(m)), triangles(triangulate(mesh).triangles), frame(frame_of(mesh.box())),
      surfels(make_surfels(mesh, triangles, frame)), order(spatial_order(surfels)), rays(make_rays()) {
    if (mesh.face_count() == 0)
        throw InputError(name + ": contains points but no faces; measure a mesh");
    if (order.empty())
        throw InputError(name + ": no vertex has a normal to measure occlusion at");
    find_contacts(surfels, rays, ray_offset(std::numeric_limits<float>::infinity()), uses_vertex);
}

Truth make_truth(const MeasuredMesh& mesh, float radius, const TruthOptions& options, const Progress& progress) {
    constexpr int fitted_rays = 256; // as in the pilot of a bake
    Truth truth{radius, {}, {}, {}};
    std::vector<std::uint32_t> others = mesh.order;
    if (options.labels > 0 && mesh.order.size() >= Pilot::fewest_to_fit) {
        std::vector<std::uint32_t> fitted = evenly(mesh.order, std::min(options.labels, mesh.order.size() / 4));
        auto labels = std::make_shared<Labels>();
        labels->surfels = pick(mesh.surfels, fitted);
        labels->ao =
            evaluate_ao(labels->surfels, mesh.rays, Exact{.radius = radius, .rays = fitted_rays, .seed = fitted_seed});
        truth.labels = std::move(labels);
        std::sort(fitted.begin(), fitted.end());
        std::erase_if(others, [&](std::uint32_t v) { return std::binary_search(fitted.begin(), fitted.end(), v); });
    }
    truth.vertices = evenly(others, options.most);
    truth.ao = evaluate_ao(pick(mesh.surfels, truth.vertices), mesh.rays,
                           Exact{.radius = radius, .rays = options.rays, .seed = truth_seed}, progress);
    return truth;
}

MeasuredGrid build_grid(const MeasuredMesh& mesh, float radius, float voxel, const Progress& progress) {
    VoxelizeOptions options;
    options.grid.radius = radius;
    options.grid.voxel = voxel;
    options.grid.cluster = true; // as bakes do
    options.progress = progress;
    const ProcessMeter meter;
    const GridStack stack = voxelize(mesh.mesh, mesh.triangles, options);
    LevelStack field(stack);
    std::size_t active = 0;
    for (const LevelSet& level : stack.levels)
        active += level.active_voxels;
    return {std::move(field), voxel, active, stack.bytes(), meter.seconds(), peak_resident_bytes()};
}

std::string Measurement::label() const {
    return samples > 0 ? method + ":" + std::to_string(samples) : method;
}

Measurement measure(const MeasuredMesh& mesh, const Truth& truth, const MeasuredGrid* grid, const MethodChoice& choice,
                    Pictures pictures, const Progress& progress) {
    Measurement m;
    m.mesh = mesh.name;
    m.method = choice.method->name;
    m.samples = choice.samples;
    m.vertices = mesh.mesh.vertex_count();
    m.triangles = mesh.triangles.size();
    m.radius = truth.radius;
    m.rays = choice.rays();
    if (choice.method->needs_mesh)
        m.tree_seconds = mesh.tree_seconds;
    if (!choice.method->needs_grid)
        grid = nullptr;

    const Occluders occluders = grid ? Occluders(grid->field, mesh.rays) : Occluders(mesh.rays);
    const ProcessMeter meter;
    Settings settings = choice.settings(truth.radius);
    settings.labels = truth.labels;
    const ChannelValues baked = evaluate(mesh.surfels, occluders, *choice.method, settings, Channel::ao, progress);
    m.occlusion_seconds = meter.seconds();
    m.peak_rss_bytes = peak_resident_bytes();

    if (grid) {
        m.voxel = grid->field.resolution();
        m.asked_voxel = grid->asked_voxel;
        m.levels = grid->field.levels().size();
        m.active_voxels = grid->active_voxels;
        m.grid_bytes = grid->bytes;
        m.grid_seconds = grid->seconds;
        m.peak_rss_bytes = std::max(m.peak_rss_bytes, grid->peak_rss_bytes);
        m.map_calls = map_calls_per_surfel(mesh, *grid, choice, truth.radius);
    }
    std::vector<float> values;
    values.reserve(truth.vertices.size());
    for (const std::uint32_t vertex : truth.vertices)
        values.push_back(baked[Channel::ao][vertex]);
    m.error = compare(values, truth.ao);
    if (pictures == Pictures::painted)
        m.picture = heat_map(mesh.mesh, mesh.triangles, errors_of_all(mesh, truth, values));
    return m;
}

}
