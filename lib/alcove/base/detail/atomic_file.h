/// A file that is written completely or not at all.
#pragma once

#include "alcove/base/detail/input_file.h"

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace alcove {

/// Collects bytes in a temporary file in the target's folder. commit() renames it over the target; without commit(),
/// the destructor removes it and the target is unchanged. A target that is a link stays one: the file that it points to
/// is replaced. Every failure throws an IoError that names the target.
class AtomicFile {
  public:
    /// \throw InputError as well if the target is a pipe, a socket, a device, or a dangling symbolic link.
    explicit AtomicFile(const std::filesystem::path& target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// For writers that open the file themselves.
    const std::filesystem::path& temporary() const { return temporary_; }

    void write(std::string_view bytes); ///< unbuffered: pass large blocks
    /// Writes `count` bytes of a regular file from `offset` on. \throw like InputFile::read_at()
    void copy(const InputFile& from, std::size_t offset, std::size_t count);
    /// Returns when the file is on the disk under its name, as far as the file system can tell.
    void commit();

  private:
    void count_written(std::size_t count);

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    int descriptor_ = -1;
    std::size_t written_ = 0, started_ = 0; ///< bytes, and those that the disk has begun with
    int slot_ = -1;                         ///< index into the list of unfinished files
};

/// Removes the temporary file of every AtomicFile that is not committed. For use when the process is about to end. Safe
/// in a signal handler. Covers at most 32 files at a time.
void remove_unfinished_files() noexcept;

}
