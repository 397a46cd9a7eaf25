/// A temporary folder for each test, removed at its end, with helpers to write and read files in it.
#pragma once

#include "alcove/mesh/files.h"

#include "scratch_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

class ScratchFiles : public testing::Test {
  protected:
    std::filesystem::path path(const std::string& name) const { return folder_ / name; }

    std::filesystem::path write(const std::string& name, std::string_view bytes) const {
        std::ofstream output(path(name), std::ios::binary);
        output.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return path(name);
    }
    std::string bytes_of(const std::string& name) const { return alcove::bytes_of(path(name)); }
    alcove::Mesh read(const std::string& name, std::string_view bytes) const {
        return alcove::read_mesh(write(name, bytes));
    }
    /// The contents after the header of a PLY file.
    std::string rows_of(const std::string& name) const {
        const std::string bytes = bytes_of(name);
        const std::size_t end = bytes.find("end_header\n");
        return end == std::string::npos ? std::string() : bytes.substr(end + std::strlen("end_header\n"));
    }
    std::string header_of(const std::string& name) const {
        const std::string bytes = bytes_of(name);
        return bytes.substr(0, bytes.size() - rows_of(name).size());
    }

    const alcove::ScratchFolder folder_;
};

/// The concatenated bytes of values in the order of this machine (little endian).
template <class... T>
std::string packed(T... values) {
    std::string bytes;
    (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
    return bytes;
}

/// The same with the bytes of each value reversed.
template <class... T>
std::string packed_reversed(T... values) {
    std::string bytes;
    const auto append = [&bytes](auto value) {
        const std::string one = packed(value);
        bytes.append(one.rbegin(), one.rend());
    };
    (append(values), ...);
    return bytes;
}
