/// The exceptions of the library's public functions. Each message is one line with the file, the position in it and a
/// fix.
#pragma once

#include <stdexcept>

namespace alcove {

/// The input is invalid: a damaged file, a mesh without faces, a grid of another type.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file could not be opened, read or written, though its contents are not at fault.
struct IoError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The request would clearly exceed the time limit.
struct TimeLimitError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The request is valid but too large: it exceeds the memory or the index range.
struct LimitError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}
