/// What every program that writes a page of docs/ begins with.
#pragma once

#include "alcove/base/errors.h"

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string_view>

namespace alcove::docs {

/// \throw IoError where the file cannot be written.
inline void write_text(const std::filesystem::path& file, std::string_view text) {
    std::ofstream page(file);
    page << text;
    if (!page.flush())
        throw IoError(file.string() + ": cannot be written");
}

/// `write(folder of meshes, docs folder)` by the command line; what it throws becomes one line.
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
