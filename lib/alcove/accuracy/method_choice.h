/// A method and the number of samples or rays it is given.
#pragma once

#include "alcove/occlusion/catalog.h"

#include <optional>

namespace alcove {

struct MethodChoice {
    const Method* method = nullptr;
    /// Probes or rays a vertex, as the parameter of that name counts them; 0 where the method has neither.
    int samples = 0;

    std::string label() const;             ///< "guided:3", "multiscale"
    Settings settings(float radius) const; ///< unit space
    int rays() const;                      ///< `samples` of a method that takes rays, else 0
    bool operator==(const MethodChoice&) const = default;
};

/// Without a number, the method's default. \throw InputError if the method takes none, or not that one.
MethodChoice choose(const Method& method, std::optional<int> samples = {});

/// With the number that is among the settings, else the default.
MethodChoice choice_of(const Method& method, const Settings& settings);

/// Every method that gives ao by its defaults, and those whose error falls with their rays at a few of them.
std::vector<MethodChoice> standard_choices();

}
