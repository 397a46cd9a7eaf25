#include "alcove/occlusion/catalog.h"

#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

/// The parameter that sets the number of samples per surfel.
std::optional<ParameterInfo> samples_of(const Method& method) {
    for (const ParameterInfo& parameter : method.parameters())
        if (parameter.name == parameter_of(method.samples_are))
            return parameter;
    return {};
}

}

std::string MethodChoice::label() const {
    return samples > 0 ? fmt::format("{}:{}", method->name, samples) : std::string(method->name);
}

Settings MethodChoice::settings(float radius) const {
    Settings settings{.radius = radius};
    if (samples > 0)
        settings.parameters.emplace_back(samples_of(*method)->name, samples);
    return settings;
}

int MethodChoice::rays() const {
    return method->samples_are == SampleKind::rays ? samples : 0;
}

MethodChoice choose(const Method& method, std::optional<int> samples) {
    const std::optional<ParameterInfo> parameter = samples_of(method);
    if (!parameter) {
        if (samples)
            throw InputError(fmt::format("{} takes no number of samples or rays", method.name));
        return {&method, 0};
    }
    const MethodChoice choice{&method, samples.value_or(static_cast<int>(parameter->standard))};
    if (choice.samples < parameter->min || choice.samples > parameter->max)
        throw InputError(fmt::format("{} takes {:.0f} to {:.0f} {}, not {}", method.name, parameter->min,
                                     parameter->max, parameter->name, choice.samples));
    return choice;
}

MethodChoice choice_of(const Method& method, const Settings& settings) {
    MethodChoice choice = choose(method);
    if (const std::optional<ParameterInfo> parameter = samples_of(method))
        for (const auto& [name, value] : settings.parameters)
            if (name == parameter->name)
                choice.samples = static_cast<int>(value);
    return choice;
}

std::vector<MethodChoice> standard_choices() {
    std::vector<MethodChoice> choices;
    const auto add = [&](const MethodChoice& choice) {
        if (std::find(choices.begin(), choices.end(), choice) == choices.end())
            choices.push_back(choice);
    };
    for (const Method& method : catalog())
        if (method.gives.has(Channel::ao))
            add(choose(method));
    for (const int rays : {1, 3, 8})
        add(choose(find_method("guided"), rays));
    for (const int rays : {4, 16, 64})
        add(choose(find_method("exact"), rays));
    for (const int rays : {16, 64})
        add(choose(find_method("traced"), rays));
    return choices;
}

}
