/// Scenes in TOML files; docs/scenes.md is their reference.
#pragma once

#include "alcove/scene/scene.h"

namespace alcove {

/// Files that the scene names are found from the folder it is in; none of them is opened. \throw InputError naming the
/// file, the line and the mend: no TOML, a key that is not known (with the nearest that is), a value of the wrong kind
/// or out of range, a file that cannot be opened; IoError if it cannot be read.
Scene read_scene(const std::filesystem::path& file);

}
