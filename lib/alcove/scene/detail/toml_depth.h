/// A look at a TOML file before it is parsed, by a library that goes down the stack for each part of a key.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"

namespace alcove {

/// \throw InputError where dots of keys and brackets are nested more than a thousand deep. What else is no TOML passes.
void check_toml_depth(const FileBytes& file);

}
