/// What a method says of itself, as data: for those who choose it by name and set its parameters.
#pragma once

#include "alcove/occlusion/parameter.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

/// A parameter of a method, as the Parameter of its struct describes it.
struct ParameterInfo {
    std::string_view name;
    double standard; ///< its default
    double min, max; ///< inclusive
    bool integer, flag;
    std::string_view unit;
    std::string_view summary;
};

/// What a user sets: the radius of every estimator, and parameters by their names. Where several methods bake, a
/// parameter is that of the first which has it; of two values the later holds.
struct Settings {
    float radius = 0.1f; ///< units of the field; may be infinite
    std::vector<std::pair<std::string, double>> parameters{};
    /// The radius is cut to this where it is that of probes: one further from a mesh than its diagonal tells nothing of
    /// it.
    float furthest_probe = 1.0f;
};

struct MethodInfo {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    std::string_view cost; ///< in map() calls a surfel
    std::string_view good, bad;
    std::vector<ParameterInfo> (*parameters)();

    bool has_parameter(std::string_view parameter) const {
        for (const ParameterInfo& info : parameters())
            if (info.name == parameter)
                return true;
        return false;
    }
};

/// Of the struct E, which names all of these itself.
template <class E>
constexpr MethodInfo info_of() {
    return {E::name, E::summary, E::formula, E::source, E::cost, E::good, E::bad, [] {
                const E standard;
                std::vector<ParameterInfo> infos;
                for (const auto& p : E::parameters())
                    infos.push_back(
                        {p.name, p.get(standard), p.min, p.max, p.integer, p.flag, p.unit, p.summary});
                return infos;
            }};
}

/// E with the radius and all parameters that it has. Values must be in range.
template <class E>
E with_settings(const Settings& settings) {
    E method;
    method.radius = settings.radius;
    for (const auto& [name, value] : settings.parameters)
        for (const auto& p : E::parameters())
            if (p.name == name)
                p.set(method, value);
    return method;
}

}
