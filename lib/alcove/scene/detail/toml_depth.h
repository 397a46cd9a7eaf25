/// Checks the nesting of a TOML file before it is parsed, because the parser recurses for each part of a key.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"

namespace alcove {

/// Checks the depth of nesting. \throw InputError if dotted keys and brackets are nested more than a thousand deep.
/// Accepts other invalid TOML.
void check_toml_depth(const FileBytes& file);

}
