/// A file that is written completely or not at all.
#pragma once

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
    /// Returns when the file is on the disk under its name, as far as the file system can tell.
    void commit();

  private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
    int descriptor_ = -1;
    int slot_ = -1; ///< index into the list of unfinished files
};

/// Removes the temporary files of all uncommitted files; for use when the process is about to end. Safe in a signal
/// handler. Covers at most 32 files at a time.
void remove_unfinished_files() noexcept;

}
