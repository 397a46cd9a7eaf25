/// A file that is written completely or not at all.
#pragma once

#include "alcove/base/detail/input_file.h"

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace alcove {

/// Collects bytes in a temporary file in the target's folder. commit() renames the temporary file to the target;
/// without commit(), the destructor removes it and the target stays unchanged. If the target is a link, the link stays
/// and the file that it points to is replaced. Every failure throws an IoError that names the target.
class AtomicFile {
  public:
    /// \throw InputError, too, if the target is a pipe, a socket, a device, or a dangling symbolic link.
    explicit AtomicFile(const std::filesystem::path& target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// The path of the temporary file, for writers that open it themselves.
    const std::filesystem::path& temporary() const { return temporary_; }

    void write(std::string_view bytes); ///< unbuffered: pass large blocks
    /// Appends `count` bytes of the regular file `from`, starting at `offset`. \throw like InputFile::read_at()
    void copy(const InputFile& from, std::size_t offset, std::size_t count);
    /// Returns when the file is on the disk under its final name, if the file system can wait for that.
    void commit();

  private:
    void count_written(std::size_t count);

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    int descriptor_ = -1;
    std::size_t written_ = 0, started_ = 0; ///< bytes written, and those of them sent to the disk
    int slot_ = -1;                         ///< index into the list of unfinished files, or -1
};

/// Removes the temporary file of every AtomicFile that is not committed. Call it when the process is about to end; it
/// is safe in a signal handler. Covers at most 32 files at a time.
void remove_unfinished_files() noexcept;

}
