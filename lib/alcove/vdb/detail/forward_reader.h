/// Reads a file from beginning to end.
#pragma once

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace alcove {

/// Reads value after value. \throw InputError for a length that exceeds the rest of the file, or an invalid offset.
class ForwardReader {
  public:
    explicit ForwardReader(const std::filesystem::path& file)
        : file_(file), size_(std::filesystem::file_size(file)), buffer_(std::size_t{1} << 20) {
        stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
        stream_.open(file, std::ios::binary);
    }

    template <class T>
    void read(T* values, std::size_t count) {
        check(count * sizeof(T));
        stream_.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
        at_ += count * sizeof(T);
    }
    template <class T>
    T number() {
        T value{};
        read(&value, 1);
        return value;
    }
    void skip(std::uint64_t bytes) {
        check(bytes);
        stream_.ignore(static_cast<std::streamsize>(bytes)); // a seek would empty the buffer
        at_ += bytes;
    }
    std::uint64_t at() const { return at_; }
    std::uint64_t left() const { return size_ - at_; }
    /// Skips forward to an offset.
    void go_to(std::int64_t offset) {
        if (offset < 0 || static_cast<std::uint64_t>(offset) < at_ || static_cast<std::uint64_t>(offset) > size_)
            fail(fmt::format("declares the invalid offset {}", offset));
        stream_.seekg(offset);
        at_ = static_cast<std::uint64_t>(offset);
    }
    void expect_at(std::int64_t offset) const {
        if (static_cast<std::uint64_t>(offset) != at_)
            fail(fmt::format("declares the offset {} for data at offset {}", offset, at_));
    }
    std::string bytes(std::uint64_t count) {
        check(count);
        std::string value(count, '\0');
        read(value.data(), count);
        return value;
    }
    std::string text() { return bytes(number<std::uint32_t>()); }
    void check(std::uint64_t bytes) const {
        if (bytes > left())
            fail(fmt::format("declares a length of {} bytes at byte {}, which is beyond its end", bytes, at_));
    }
    [[noreturn]] void fail(const std::string& what, const char* fix = "the file is damaged; write it again") const {
        throw InputError(fmt::format("{}: {}: {}", file_.string(), in_one_line(what), fix));
    }

  private:
    std::filesystem::path file_;
    std::uint64_t size_, at_ = 0;
    std::vector<char> buffer_; // must outlive the stream
    std::ifstream stream_;
};

}
