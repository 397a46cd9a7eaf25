/// The parameters of an estimator as data: what `--set name=value` sets and `alcove methods` lists.
///
///     static constexpr auto parameters() {
///         return std::array{parameter<&Mine::samples>("samples", 2, 64, "probes", "along the normal")};
///     }
#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

namespace alcove {

/// A member of E that a user may set. Defaults are those of the struct itself.
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

}
