/// Bytes of a file: in memory, or on the disk until they are needed.
#pragma once

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/input_file.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace alcove {

/// Refers to bytes in memory or to a file, which must outlive this object.
class FilePart {
  public:
    FilePart() = default;
    explicit FilePart(std::string_view in_memory) : bytes_(in_memory.data()), size_(in_memory.size()) {}
    FilePart(const InputFile& file, std::size_t begin, std::size_t size) : file_(&file), begin_(begin), size_(size) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    FilePart part(std::size_t begin, std::size_t size) const;
    /// All bytes of the part. If they are on the disk, reads them into `buffer`. \throw like InputFile::read_at()
    std::string_view read(std::string& buffer) const;
    std::string read() const;
    void read_to(char* to) const; ///< `to` must have room for all bytes
    /// \throw like AtomicFile::copy()
    void write_to(AtomicFile& output) const;

  private:
    const char* bytes_ = nullptr;
    const InputFile* file_ = nullptr; ///< null: in memory
    std::size_t begin_ = 0;           ///< in the file
    std::size_t size_ = 0;
};

}
