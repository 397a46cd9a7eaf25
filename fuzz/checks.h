/// Checks of invariants that any input must meet. A violation aborts the program, so that any driver detects it.
#pragma once

#include "alcove/base/types.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

namespace alcove::fuzz {

using Bytes = std::span<const std::uint8_t>;

inline std::string_view text_of(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline void require(bool holds, std::string_view what) {
    if (holds)
        return;
    std::fprintf(stderr, "invariant violated: %.*s\n", static_cast<int>(what.size()), what.data());
    std::abort();
}

/// Checks that a message is one line and begins with the name of the file, if there is one.
inline void check_message(std::string_view message, std::string_view file) {
    const bool one_line =
        std::none_of(message.begin(), message.end(), [](char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; });
    require(one_line && message.starts_with(file) && message.size() > file.size(),
            "a message is one line that begins with the name of the file: " + std::string(message));
}

/// Calls f(), which may throw only the exceptions of base/types.h, with messages about `file`.
template <class F>
void accept_refusals(std::string_view file, F&& f) {
    try {
        f();
    } catch (const InputError& error) {
        check_message(error.what(), file);
    } catch (const IoError& error) {
        check_message(error.what(), file);
    } catch (const LimitError& error) {
        check_message(error.what(), file);
    } catch (const MemoryError& error) {
        check_message(error.what(), file);
    }
}

}
