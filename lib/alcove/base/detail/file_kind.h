/// Kinds of files.
#pragma once

struct stat;

namespace alcove {

/// "a folder", "a pipe", "a socket" or "a device"; null for a regular file.
const char* special_kind(const struct stat& status);

}
