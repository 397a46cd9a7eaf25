/// Every estimator by its name: what is chosen at run time, once a bake.
#pragma once

#include "alcove/field/any_field.h"
#include "alcove/occlusion/bake.h"

#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// An estimator behind function pointers, as its struct describes itself.
struct Method {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    std::string_view cost; ///< in map() calls a surfel
    std::vector<float> (*bake)(std::span<const Surfel>, const AnyField&, const EstimatorOptions&,
                               const Progress&);
};

/// All methods, in the order of the documentation.
std::span<const Method> catalog();

/// \throw InputError for an unknown name, listing the known ones.
const Method& find_method(std::string_view name);

}
