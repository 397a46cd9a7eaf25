/// What must hold whatever the bytes are. A failure ends the program as a crash does, so that any driver sees it.
#pragma once

#include "alcove/base/errors.h"

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
    std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
    std::abort();
}

/// The message of an error: one line that begins with the name of the file, if there is one.
inline void check_message(std::string_view message, std::string_view file) {
    const bool one_line = std::none_of(message.begin(), message.end(),
                                       [](char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; });
    require(one_line && message.starts_with(file) && message.size() > file.size(),
            "a message is one line about the file: " + std::string(message));
}

/// Calls f(), which may end with the exceptions of errors.h about that file and with no other.
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
    }
}

}
