#include "alcove/occlusion/catalog.h"

#include "alcove/base/detail/edit_distance.h"
#include "alcove/base/types.h"
#include "alcove/occlusion/methods/calibrated.h"
#include "alcove/occlusion/methods/guided.h"
#include "alcove/occlusion/methods/reference/classic.h"
#include "alcove/occlusion/methods/reference/decay.h"
#include "alcove/occlusion/methods/reference/exponential.h"
#include "alcove/occlusion/methods/reference/fibonacci.h"
#include "alcove/occlusion/methods/reference/hemisphere.h"
#include "alcove/occlusion/methods/reference/hemisphere_random.h"
#include "alcove/occlusion/methods/reference/jittered.h"
#include "alcove/occlusion/methods/reference/multiplicative.h"
#include "alcove/occlusion/methods/reference/multiscale.h"
#include "alcove/occlusion/methods/thickness.h"
#include "alcove/occlusion/methods/traced.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace alcove {
namespace {

template <class E>
constexpr bool unbounded_radius() {
    if constexpr (requires { E::unbounded_radius; })
        return E::unbounded_radius;
    else
        return false;
}

/// The estimator with these settings. The radius of methods that probe the field is limited to max_probe_distance.
template <class E>
E estimator_of(const Settings& settings) {
    E estimator = with_settings<E>(settings);
    if constexpr (!unbounded_radius<E>())
        estimator.radius = std::min(estimator.radius, settings.max_probe_distance);
    return estimator;
}

template <class E>
E fitted(const Occluders& occluders, const Settings& settings) {
    E estimator = estimator_of<E>(settings);
    if constexpr (requires { estimator.fit(occluders.field(), *settings.labels); })
        if (settings.labels)
            estimator.fit(occluders.field(), *settings.labels);
    if constexpr (requires { estimator.mesh = occluders.rays(); })
        if (occluders.has_rays())
            estimator.mesh = occluders.rays();
    return estimator;
}

template <class E>
constexpr float reference_radius_of() {
    if constexpr (requires { E::reference_radius; })
        return E::reference_radius;
    else
        return 0.0f;
}

template <class E>
constexpr Method method() {
    constexpr bool on_mesh = Estimator<E, RaySurface>, on_both = std::same_as<E, Guided>;
    return {info_of<E>(),
            channels_of<E>(),
            !on_mesh,
            on_mesh || on_both,
            unbounded_radius<E>(),
            reference_radius_of<E>(),
            [](std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const Occluders& occluders,
               const Settings& settings, ChannelSet wanted, const Progress& progress) {
                if constexpr (on_both)
                    return evaluate(surfels, order, occluders.field(), occluders.rays(), estimator_of<E>(settings),
                                    wanted, progress);
                else if constexpr (on_mesh)
                    return evaluate(surfels, order, occluders.rays(), estimator_of<E>(settings), wanted, progress);
                else
                    return evaluate(surfels, order, occluders.field(), fitted<E>(occluders, settings), wanted,
                                    progress);
            }};
}

std::optional<ParameterInfo> find_parameter(const MethodInfo& method, std::string_view name) {
    for (const ParameterInfo& parameter : method.parameters())
        if (parameter.name == name)
            return parameter;
    return {};
}

/// The first method of `needed` that has the parameter.
template <class M>
auto owner_of(std::string_view parameter, std::span<const M* const> needed) {
    return std::find_if(needed.begin(), needed.end(),
                        [&](const M* method) { return find_parameter(*method, parameter).has_value(); });
}

/// Those settings of `all` that apply to `method`. A parameter applies to the first method of `needed` that has it.
Settings settings_of(const Method* method, std::span<const Method* const> needed, const Settings& all) {
    Settings own{.radius = all.radius, .max_probe_distance = all.max_probe_distance, .labels = all.labels};
    for (const auto& setting : all.parameters)
        if (const auto owner = owner_of(setting.first, needed); owner != needed.end() && *owner == method)
            own.parameters.push_back(setting);
    return own;
}

template <class M>
void check(std::span<const M* const> needed, const Settings& settings) {
    for (const auto& [name, value] : settings.parameters) {
        const auto owner = owner_of(name, needed);
        if (owner == needed.end()) {
            std::vector<std::string_view> methods, names;
            for (const M* method : needed) {
                methods.push_back(method->name);
                for (const ParameterInfo& p : method->parameters())
                    names.push_back(p.name);
            }
            throw InputError(fmt::format("{} has no parameter '{}'; known parameters: {}", fmt::join(methods, " and "),
                                         name, names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
        }
        const ParameterInfo p = *find_parameter(**owner, name);
        if (!(value >= p.min && value <= p.max) || (p.integer && value != std::floor(value)))
            throw InputError(fmt::format("{} of {} takes {} from {:.10g} to {:.10g}, not {:.10g}", name, (*owner)->name,
                                         p.integer ? "a whole number" : "a number", p.min, p.max, value));
    }
}

constexpr std::array methods{
    method<Classic>(),    method<Exponential>(), method<Decay>(),      method<Multiplicative>(),
    method<Multiscale>(), method<Jittered>(),    method<Hemisphere>(), method<HemisphereRandom>(),
    method<Fibonacci>(),  method<Traced>(),      method<Calibrated>(), method<Guided>(),
    method<Exact>(),      method<Thickness>(),
};

}

std::span<const Method> catalog() {
    return methods;
}

const Method& find_method(std::string_view name) {
    std::vector<std::string> names;
    for (const Method& method : methods)
        if (method.gives.has(Channel::ao)) {
            if (method.name == name)
                return method;
            names.emplace_back(method.name);
        } else if (method.name == name) {
            throw InputError(fmt::format("{0} is an attribute, not a method for ao: use --attributes {0}", name));
        }
    const std::string meant = nearest_name(name, names);
    throw InputError(fmt::format("there is no method '{}'{}; known methods: {}", name,
                                 meant.empty() ? "" : fmt::format(" (did you mean {}?)", meant),
                                 fmt::join(names, ", ")));
}

std::vector<const Method*> methods_for(const Method& chosen, ChannelSet wanted) {
    std::vector<const Method*> needed{&chosen};
    if ((chosen.gives & wanted).empty())
        needed.clear();
    ChannelSet left = wanted.without(chosen.gives);
    // Short and long range are factors of one method's own ao, so no other method can add them.
    if (left.has(Channel::ao_short) || left.has(Channel::ao_long))
        throw InputError(
            fmt::format("{} does not give ao_short or ao_long: use --method {}", chosen.name, Multiscale::name));
    for (const Method& method : methods)
        if (!(method.gives & left).empty()) {
            needed.push_back(&method);
            left = left.without(method.gives);
        }
    return needed;
}

void check_settings(std::span<const Method* const> needed, const Settings& settings) {
    check(needed, settings);
}

void check_settings(const MethodInfo& method, const Settings& settings) {
    check<MethodInfo>(std::array{&method}, settings);
}

std::vector<MethodRun> runs_for(const Method& chosen, const Settings& settings, ChannelSet wanted) {
    const std::vector<const Method*> needed = methods_for(chosen, wanted);
    check_settings(needed, settings);
    std::vector<MethodRun> runs;
    for (const Method* method : needed) {
        runs.push_back({method, settings_of(method, needed, settings), wanted & method->gives});
        wanted = wanted.without(method->gives);
    }
    return runs;
}

ChannelValues evaluate(std::span<const Surfel> surfels, const Occluders& occluders, const Method& chosen,
                       const Settings& settings, ChannelSet wanted, const Progress& progress) {
    return evaluate(surfels, spatial_order(surfels), occluders, chosen, settings, wanted, progress);
}

ChannelValues evaluate(std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                       const Occluders& occluders, const Method& chosen, const Settings& settings, ChannelSet wanted,
                       const Progress& progress) {
    const std::vector<MethodRun> runs = runs_for(chosen, settings, wanted);
    ChannelValues baked;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const MethodRun& run = runs[i];
        const auto done = [&](double part) {
            progress((static_cast<double>(i) + part) / static_cast<double>(runs.size()));
        };
        ChannelValues part =
            run.method->bake(surfels, order, occluders, run.settings, run.wanted, progress ? done : Progress{});
        for (const ChannelInfo& channel : channels)
            if (!part[channel.channel].empty())
                baked[channel.channel] = std::move(part[channel.channel]);
    }
    return baked;
}

}
