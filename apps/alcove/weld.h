/// The option --weld, and a check that refuses points for it and similar options.
#pragma once

#include "alcove/mesh/mesh.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace alcove::cli {

/// Adds --weld (empty: not given).
void add_weld_option(CLI::App& verb, std::optional<Length>& weld);

/// Checks that the mesh has faces. \throw UsageError if it has none, because the option is not for points.
void check_has_faces(const Mesh& mesh, const std::string& file, const std::string& option);

/// Reads a mesh as read_mesh() does, and joins its vertices if `weld` is set. Do not write this mesh: its `source` is
/// still that of the file.
Mesh read_welded(const std::string& file, const std::optional<Length>& weld);

}
