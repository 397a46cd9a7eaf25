#include "alcove/occlusion/catalog.h"

#include "alcove/errors.h"
#include "alcove/occlusion/along_normal.h"
#include "alcove/occlusion/traced.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace alcove {
namespace {

template <class E>
constexpr Method method() {
    return {E::name,
            E::summary,
            E::formula,
            E::source,
            E::cost,
            [](std::span<const Surfel> surfels, const AnyField& field, const EstimatorOptions& options,
               const Progress& progress) { return bake(surfels, field, E::from(options), progress); }};
}

constexpr std::array methods{
    method<Classic>(),
    method<Traced>(),
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
