#include "alcove/render/detail/hit_values.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace alcove {
namespace {

/// The settings with the number of samples replaced.
Settings with_samples(Settings settings, int samples) {
    settings.parameters.emplace_back("samples", samples);
    return settings;
}

/// The value of a parameter: from the settings if they contain it, otherwise the method's default.
int parameter(const Method& method, const Settings& settings, std::string_view name) {
    double value = 0.0;
    for (const ParameterInfo& info : method.parameters())
        if (info.name == name)
            value = info.standard;
    for (const auto& [known, set] : settings.parameters)
        if (known == name)
            value = set;
    return static_cast<int>(value);
}

/// Evaluates ao with fewer samples for surfels further from the eye.
std::vector<float> bake_by_distance(std::span<const Surfel> surfels, const Occluders& surroundings, const Vec3d& eye,
                                    const RenderOptions& options, const Progress& progress) {
    const int near_samples = parameter(*options.method, options.settings, "samples");
    std::map<int, std::vector<std::size_t>> places;
    for (std::size_t i = 0; i < surfels.size(); ++i)
        if (surfels[i].has_normal())
            places[samples_at(static_cast<float>(glm::length(Vec3d(surfels[i].position) - eye)), near_samples,
                              *options.fewer)]
                .push_back(i);
    std::vector<float> ao(surfels.size(), 1.0f);
    for (const auto& [samples, chosen] : places) {
        std::vector<Surfel> some;
        for (const std::size_t i : chosen)
            some.push_back(surfels[i]);
        const ChannelValues baked = evaluate(some, surroundings, *options.method,
                                             with_samples(options.settings, samples), Channel::ao, progress);
        for (std::size_t k = 0; k < chosen.size(); ++k)
            ao[chosen[k]] = baked[Channel::ao][k];
    }
    return ao;
}

}

int samples_at(float distance, int near_samples, const FewerSamples& fewer) {
    const float t = std::clamp(distance / fewer.distance, 0.0f, 1.0f);
    return static_cast<int>(
        std::lround(static_cast<float>(near_samples) + t * static_cast<float>(fewer.far_samples - near_samples)));
}

HitValues values_of(const Hits& hits, const Renderable& renderable, const Occluders& surroundings, const Vec3d& eye,
                    const RenderOptions& options, const Progress& progress) {
    const bool ao = need_ao(options.passes);
    HitValues values;
    if (ao && options.method && options.fewer) {
        values.ao = bake_by_distance(hits.surfels, surroundings, eye, options, progress);
    } else if (ao && options.method) {
        values.ao = std::move(evaluate(hits.surfels, surroundings, *options.method, options.settings, Channel::ao,
                                       progress)[Channel::ao]);
    }
    if (need_convexity(options.passes, has_edge_colors(renderable))) {
        const Settings settings{.radius = options.settings.radius};
        values.convexity = std::move(evaluate(hits.surfels, surroundings, find_method("classic"), settings,
                                              Channel::convexity)[Channel::convexity]);
    }
    if (need_shadow(options.passes, options.casts_shadow))
        values.shadow = soft_shadows(hits.surfels, surroundings.field(), options.lighting.toward_key, options.shadow);
    return values;
}

}
