/// Generates files with one systematic damage each.
#pragma once

#include <functional>
#include <string>

/// Calls f(description, bytes) for the file truncated at each byte; with each byte set to NUL; with each line
/// deleted, duplicated or made huge; with other line ends; with each word of a text, or of the header of a binary
/// file, replaced by an extreme one; and with the bytes of a number, at every offset, replaced by extreme ones or
/// reversed.
void for_each_damage(const std::string& sound, const std::function<void(const char*, const std::string&)>& f);
