/// A file in memory, and errors that refer to positions in it.
#pragma once

#include "alcove/mesh/formats/file_part.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace alcove {

class FileBytes {
  public:
    /// Reads a whole regular file or pipe. \throw like InputFile; InputError if it is empty.
    explicit FileBytes(const std::filesystem::path& file);
    /// Reads the beginning of a large regular file and leaves the rest on the disk. `head` gets the first bytes and
    /// returns how many bytes must be in memory; if this number exceeds the size, the whole file is read. \throw like
    /// FileBytes(file)
    using Head = std::size_t (*)(std::string_view first_bytes);
    FileBytes(const std::filesystem::path& file, Head head);
    /// Uses `bytes` as if they had been read from `file`.
    FileBytes(const std::filesystem::path& file, std::string_view bytes);

    const std::filesystem::path& path() const { return path_; }
    const char* begin() const { return bytes_.get(); }
    const char* end() const { return bytes_.get() + size_; } ///< a readable zero byte follows the last byte
    std::size_t size() const { return size_; }               ///< number of bytes in memory
    std::size_t size_of_file() const { return on_disk_ ? on_disk_->size() : size_; }
    /// Bytes of the file, in memory or on the disk.
    FilePart part(std::size_t begin, std::size_t size) const;
    std::string_view view() const { return {begin(), size_}; }
    /// A pointer that keeps the bytes alive.
    std::shared_ptr<const void> keeper() const { return bytes_; }

    /// The line of a position in the file, counted from 1. Lines end with LF, CRLF or CR.
    std::size_t line_at(const char* place) const;

    /// \throw InputError "file: message", in one line.
    [[noreturn]] void fail(std::string_view message) const;
    /// \throw InputError "file: line N: message".
    [[noreturn]] void fail_at_line(const char* place, std::string_view message) const;
    /// \throw InputError "file: byte N: message", where N counts from 0.
    [[noreturn]] void fail_at_byte(const char* place, std::string_view message) const;
    [[noreturn]] void fail_at_byte(std::size_t place, std::string_view message) const;

  private:
    void read_all(InputFile& file);

    std::filesystem::path path_;
    std::shared_ptr<char[]> bytes_;
    std::size_t size_ = 0;
    std::shared_ptr<const InputFile> on_disk_; ///< null if all bytes are in memory
};

}
