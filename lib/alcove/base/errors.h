/// The exceptions thrown at the library's boundaries. Each message is one line naming the file, the place in
/// it and the mend.
#pragma once

#include <stdexcept>

namespace alcove {

/// Something the caller brought is wrong: a damaged file, a mesh without faces, a grid of another kind.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file could not be opened, read or written although nothing is wrong with what it holds.
struct IoError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The request is sound but too large: more memory or a larger index range than there is.
struct LimitError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}
