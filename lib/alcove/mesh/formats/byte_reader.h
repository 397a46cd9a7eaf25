/// Reads values from a binary file in memory; checks every read against the bytes left.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace alcove {

class ByteReader {
  public:
    ByteReader(const FileBytes& file, const char* begin, std::endian order)
        : file_(file), at_(begin), swapped_(order != std::endian::native) {}

    const char* at() const { return at_; }
    std::size_t bytes_left() const { return static_cast<std::size_t>(file_.end() - at_); }

    template <class T>
    T read(const char* expected) {
        if (bytes_left() < sizeof(T))
            file_.fail_at_byte(file_.end(), std::string("the file ends early: ") + expected +
                                                " is missing; copy or export it again");
        std::array<char, sizeof(T)> bytes;
        std::copy_n(at_, sizeof(T), bytes.begin());
        if (swapped_)
            std::reverse(bytes.begin(), bytes.end());
        at_ += sizeof(T);
        return std::bit_cast<T>(bytes);
    }

    [[noreturn]] void fail(std::string_view message) const { file_.fail_at_byte(at_, message); }

  private:
    const FileBytes& file_;
    const char* at_;
    bool swapped_;
};

}
