/// Every small file with one thing wrong, for each thing that can be.
#pragma once

#include <functional>
#include <string>

/// Calls f(what is wrong, bytes) for a file cut at each byte; with each byte NUL; with each line deleted, doubled, made
/// huge; with other line ends; with each word made extreme, in a text or the header of a binary file; with the bytes of
/// each number, wherever one might begin, made extreme or turned around.
void for_each_damage(const std::string& sound, const std::function<void(const char*, const std::string&)>& f);
