/// A file that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace alcove {

/// Collects bytes in a temporary file beside the target; commit() renames it over the target, the destructor
/// of an uncommitted one removes it and leaves the target as it was. Every failure throws IoError naming the
/// target.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// For writers that open a path of their own.
    const std::filesystem::path& temporary() const { return temporary_; }

    void write(std::string_view bytes); ///< not buffered: hand over large pieces
    void commit();

  private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
    int descriptor_ = -1;
    int slot_ = -1; ///< among the unfinished files
};

/// Removes the temporary files of all that are not committed, when the process is about to end. Safe in a signal handler.
/// The first 32 of them at a time are known.
void remove_unfinished_files() noexcept;

}
