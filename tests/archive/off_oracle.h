/// A slow and simple reader of text OFF files, as a reference for the reader of the library.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

namespace alcove::test {

struct PlainMesh {
    std::vector<std::array<double, 3>> positions;
    std::vector<std::vector<unsigned>> faces;
};

/// Returns nullopt for variants of the format that it does not know, and for files that end early.
std::optional<PlainMesh> read_plain_off(const std::filesystem::path& file);

}
