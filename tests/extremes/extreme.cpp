#include "extreme.h"

#include "alcove/base/types.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove::extremes {
namespace {

GridStack stack_of(const MeasuredMesh& mesh, const Baking& baking) {
    VoxelizeOptions options;
    options.sign = baking.sign;
    options.grid.radius = baking.radius;
    options.grid.voxel = baking.voxel;
    options.grid.inner_band = options.grid.outer_band; // calibrated also probes the inside
    return voxelize(mesh.mesh, mesh.triangles, options);
}

/// One error figure for each method.
Result differences(const Mesh& reference, const Mesh& mesh, const Methods& methods, double bound,
                   double ErrorFigures::*figure) {
    const Baked unit(reference), changed(mesh);
    Result result;
    for (const std::string_view method : methods) {
        const std::vector<float> a = unit.by(method), b = changed.by(method);
        result.figures.push_back({std::string(method), compare(a, std::span(b).first(a.size())).*figure, bound});
    }
    return result;
}

std::string joined(const std::vector<std::string>& warnings) {
    return fmt::format("{}", fmt::join(warnings, "; "));
}

}

Baked::Baked(const Mesh& mesh, const Baking& baking)
    : baking_(baking), mesh_("mesh", mesh), stack_(stack_of(mesh_, baking)), occluders_(LevelStack(stack_), mesh_.rays),
      walls_(thin_walls(mesh_.surfels, mesh_.rays, resolution(occluders_.field()), two_sided(occluders_.field()))) {}

std::vector<float> Baked::by(std::string_view method) const {
    const Method& found = find_method(method);
    const MethodChoice choice =
        baking_.rays > 0 && (found.needs_mesh || method == "traced") ? choose(found, baking_.rays) : choose(found);
    std::vector<float> ao =
        evaluate(mesh_.surfels, occluders_, found, choice.settings(baking_.radius), Channel::ao, {})[Channel::ao];
    for (std::size_t i = 0; i < ao.size(); ++i)
        if (!(ao[i] >= 0.0f && ao[i] <= 1.0f))
            throw std::runtime_error(fmt::format("{}: ao {} at vertex {}", method, ao[i], i));
    return ao;
}

std::vector<float> Baked::truth() const {
    return evaluate_ao(mesh_.surfels, mesh_.rays, Exact{.radius = baking_.radius, .rays = 1024, .seed = 0x2c41});
}

std::vector<bool> Baked::buried() const {
    const AnyField& field = occluders_.field();
    std::vector<bool> all;
    for (const Surfel& surfel : mesh_.surfels)
        all.push_back(std::ranges::any_of(std::array{0.25f, 0.5f, 1.0f}, [&](float voxels) {
            return field.map(surfel.position + voxels * resolution(field) * surfel.normal) < 0.0f;
        }));
    return all;
}

std::vector<std::string> Baked::warnings() const {
    std::vector<std::string> all = stack_.warnings;
    if (resolving_voxel() > 0.0f)
        all.push_back(fmt::format("{:.0f} % of the vertices are on walls too thin for the voxel of {:.2g} D; "
                                  "a voxel of {:.2g} D resolves them",
                                  100.0 * walls_.share, resolution(occluders_.field()), walls_.voxel));
    return all;
}

Result against_exact(const Baked& baked, const Methods& methods, double bound) {
    const std::vector<float> truth = baked.truth();
    Result result{{}, joined(baked.warnings())};
    for (const std::string_view method : methods)
        result.figures.push_back({std::string(method), compare(baked.by(method), truth).rmse, bound});
    return result;
}

Result against_value(const Baked& baked, float value, const Methods& methods, double bound) {
    Result result{{}, joined(baked.warnings())};
    for (const std::string_view method : methods) {
        const std::vector<float> ao = baked.by(method);
        result.figures.push_back({std::string(method), compare(ao, std::vector<float>(ao.size(), value)).max, bound});
    }
    return result;
}

Result against(const Mesh& reference, const Mesh& mesh, const Methods& methods, double bound) {
    return differences(reference, mesh, methods, bound, &ErrorFigures::max);
}

Result rmse_against(const Mesh& reference, const Mesh& mesh, const Methods& methods, double bound) {
    return differences(reference, mesh, methods, bound, &ErrorFigures::rmse);
}

std::vector<Extreme> all_extremes() {
    std::vector<Extreme> all;
    for (const auto& rows : {scales(), offsets(), shapes(), damages(), thin_features(), settings()})
        all.insert(all.end(), rows.begin(), rows.end());
    return all;
}

}
