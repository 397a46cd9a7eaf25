/// Functions shared by the programs that write the pages of docs/.
#pragma once

#include "alcove/base/types.h"

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string_view>

namespace alcove::docs {

/// Writes a text to a file. \throw IoError if the file cannot be written.
inline void write_text(const std::filesystem::path& file, std::string_view text) {
    std::ofstream page(file);
    page << text;
    if (!page.flush())
        throw IoError(file.string() + ": cannot be written");
}

/// Calls `write(mesh folder, docs folder)` with the two command-line arguments and returns the exit code. Prints the
/// message of an exception as one line.
template <class Write>
int run_page(int argc, char** argv, const Write& write) {
    if (argc != 3) {
        std::cerr << "usage: " << argv[0] << " MESHES DOCS\n";
        return 2;
    }
    try {
        write(std::filesystem::path(argv[1]), std::filesystem::path(argv[2]));
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}

}
