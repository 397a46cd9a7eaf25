/// Reflection of the parameters of an estimator, for `--set name=value` and `alcove methods`.
///
///     static constexpr auto parameters() {
///         return std::array{parameter<&Mine::samples>("samples", 2, 64, "probes", "along the normal")};
///     }
#pragma once

#include "alcove/occlusion/catalog.h"

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace alcove {

/// A member of E that a user can set. Its default is the initial value in the struct.
template <class E>
struct Parameter {
    std::string_view name;
    double min, max; ///< inclusive
    std::string_view unit;
    std::string_view summary;
    bool integer, flag;
    double (*get)(const E&);
    void (*set)(E&, double); ///< the value must be in range
};

template <class E, class T>
constexpr E owner_of(T E::*);

template <auto member>
constexpr auto parameter(std::string_view name, double min, double max, std::string_view unit,
                         std::string_view summary) {
    using E = decltype(owner_of(member));
    using T = std::remove_reference_t<decltype(std::declval<E&>().*member)>;
    return Parameter<E>{name,
                        min,
                        max,
                        unit,
                        summary,
                        std::integral<T>,
                        std::same_as<T, bool>,
                        [](const E& estimator) { return static_cast<double>(estimator.*member); },
                        [](E& estimator, double value) { estimator.*member = static_cast<T>(value); }};
}

template <class E>
constexpr SampleKind samples_of() {
    for (const auto& p : E::parameters()) {
        if (p.name == parameter_of(SampleKind::rays))
            return SampleKind::rays;
        if (p.name == parameter_of(SampleKind::probes))
            return SampleKind::probes;
    }
    return SampleKind::none;
}

/// The description of E, from its static members.
template <class E>
constexpr MethodInfo info_of() {
    return {E::name,
            E::summary,
            E::formula,
            E::source,
            E::cost,
            E::good,
            E::bad,
            [] {
                const E standard;
                std::vector<ParameterInfo> infos;
                for (const auto& p : E::parameters())
                    infos.push_back({p.name, p.get(standard), p.min, p.max, p.integer, p.flag, p.unit, p.summary});
                return infos;
            },
            samples_of<E>()};
}

/// An E with the radius and the parameters of E from the settings; other parameters are ignored. Values must be in
/// range.
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
