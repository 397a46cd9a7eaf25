#include "alcove/occlusion/catalog.h"

#include "alcove/errors.h"
#include "alcove/occlusion/along_normal.h"
#include "alcove/occlusion/traced.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace alcove {
namespace {

Classic configure(Classic classic, const EstimatorOptions& options) {
    // Nothing is further than the diagonal.
    classic.radius = std::min(options.radius, 1.0f);
    if (options.samples > 0)
        classic.samples = std::max(options.samples, 2);
    return classic;
}

Traced configure(Traced traced, const EstimatorOptions& options) {
    traced.radius = options.radius;
    if (options.rays > 0)
        traced.rays = options.rays;
    traced.seed = options.seed;
    return traced;
}

template <class E>
std::vector<float> bake_with(std::span<const Surfel> surfels, const AnyField& field,
                             const EstimatorOptions& options, const Progress& progress) {
    return bake(surfels, field, configure(E{}, options), progress);
}

const std::array methods{
    Method{"classic", "probes along the normal, weighted sum of what is nearer than over a plane",
           "clamp(1 - 3 sum 0.95^i (h_i - d(p + h_i n))), i = 0..4",
           "SDF Ambient Occlusion - Detailed Reference (2026)", "samples (5)", bake_with<Classic>},
    Method{"traced", "sphere-traced rays over the hemisphere, cosine-weighted", "1/N sum V(w_i)",
           "04 Ambient Occlusion, lecture notes", "rays (64) x 5-20", bake_with<Traced>},
};

}

std::span<const Method> catalog() {
    return methods;
}

const Method& find_method(std::string_view name) {
    std::vector<std::string_view> names;
    for (const Method& method : methods) {
        if (method.name == name)
            return method;
        names.push_back(method.name);
    }
    throw InputError(fmt::format("there is no method '{}'; there are: {}", name, fmt::join(names, ", ")));
}

}
