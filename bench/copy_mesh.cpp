// Reads a mesh and writes it again, without baking: copy_mesh IN OUT. Prints its peak memory in bytes.
#include "alcove/base/detail/memory.h"
#include "alcove/mesh/files.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: alcove_copy_mesh IN OUT\n");
        return 2;
    }
    try {
        alcove::write_mesh(alcove::read_mesh(argv[1]), argv[2]);
        fmt::print("{}\n", alcove::peak_resident_bytes());
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
