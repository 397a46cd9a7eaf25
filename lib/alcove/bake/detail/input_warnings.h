/// Warnings about the mesh and the radius of a bake.
#pragma once

#include "alcove/bake/detail/target.h"

#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// \param what the surfels are called in messages, such as "vertices"
/// \param of_vertices whether the surfels are the vertices of the mesh
/// \return warnings, of one line each, that name a defect and its fix.
std::vector<std::string> input_warnings(const BakeTarget& target, std::string_view name, bool of_vertices,
                                        const BakeOptions& options);

}
