/// Warnings about the mesh and the radius of a bake.
#pragma once

#include "alcove/bake/detail/target.h"

#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// \param name of the surfels, such as "vertices"
/// \param of_vertices whether they are the vertices of the mesh
/// \return one line each: the defect and its fix.
std::vector<std::string> input_warnings(const BakeTarget& target, std::string_view name, bool of_vertices,
                                        const BakeOptions& options);

}
