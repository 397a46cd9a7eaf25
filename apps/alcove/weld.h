/// The option --weld, and a check of the inputs that such options accept.
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

/// \throw UsageError if the mesh has no faces: the option is not for points.
void check_has_faces(const Mesh& mesh, const std::string& file, const std::string& option);

/// read_mesh(), with its vertices joined if `weld` is set. Not to be written: `source` is still that of the file.
Mesh read_welded(const std::string& file, const std::optional<Length>& weld);

}
