/// What surrounds the text in a text file: a byte-order mark at the start, and padding at the end.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"

#include <string_view>

namespace alcove {

/// The text after the byte-order marks that some editors put before UTF-8, one each time they save it.
std::string_view without_byte_order_mark(std::string_view text);

/// The text without the NUL and Ctrl-Z bytes that block devices and DOS programs append.
std::string_view without_padding(std::string_view text);

/// \throw InputError if the file is text in UTF-16 or UTF-32, which no supported format uses.
void refuse_wide_text(const FileBytes& file);

}
