#include "alcove/base/detail/atomic_file.h"

#include "alcove/base/detail/file_kind.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <random>
#include <string>
#include <utility>

namespace alcove {
namespace {

/// A path in static memory, where a signal handler can read it.
struct Unfinished {
    std::atomic<int> state{0}; // 0 free, 1 being written, 2 a path
    std::array<char, PATH_MAX> path{};
};
std::array<Unfinished, 32> unfinished;

/// Stores the path and returns its slot; -1 if none is free or the path is too long.
int remember(const std::string& path) {
    if (path.size() < PATH_MAX)
        for (std::size_t slot = 0; slot < unfinished.size(); ++slot) {
            int free = 0;
            if (unfinished[slot].state.compare_exchange_strong(free, 1)) {
                std::copy_n(path.c_str(), path.size() + 1, unfinished[slot].path.begin());
                unfinished[slot].state = 2;
                return static_cast<int>(slot);
            }
        }
    return -1;
}

constexpr std::size_t block_size = std::size_t{1} << 20; // bytes

void forget(int slot) {
    if (slot >= 0)
        unfinished[static_cast<std::size_t>(slot)].state = 0;
}

[[noreturn]] void fail(const std::filesystem::path& target, const std::string& what) {
    const int reason = errno;
    throw IoError(target.string() + ": " + what + ": " + std::strerror(reason));
}

/// Refuses a target that is not a regular file, and a link that points to no file. \return whether the target exists.
bool check_target(const std::filesystem::path& target, struct stat& old) {
    const bool exists = ::stat(target.c_str(), &old) == 0;
    if (!exists && errno == ELOOP)
        throw InputError(target.string() + ": is a link that leads back to itself; delete it, or name another file");
    std::error_code unresolved;
    if (!exists && std::filesystem::is_symlink(std::filesystem::symlink_status(target, unresolved)))
        throw InputError(target.string() + ": is a link to " +
                         std::filesystem::read_symlink(target, unresolved).string() +
                         ", which does not exist; delete the link, or name another file");
    if (exists && S_ISDIR(old.st_mode))
        throw IoError(target.string() + ": is a folder; name a file to write");
    if (const char* kind = exists ? special_kind(old) : nullptr)
        throw InputError(target.string() + ": is " + kind + ", not a file; name a file to write");
    if (exists && ::access(target.c_str(), W_OK) != 0)
        fail(target, "cannot be written");
    return exists;
}

/// Waits until the file or folder is on the disk, if the file system supports that. \return false on failure.
bool sync(int descriptor) {
    return ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
}

/// Waits until a renamed file is on the disk under its new name.
bool sync_folder_of(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return true; // the folder can be written to, but not opened
    const bool synced = sync(descriptor);
    const int reason = errno;
    ::close(descriptor);
    errno = reason;
    return synced;
}

}

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target) {
    struct stat old {};
    const bool exists = check_target(target, old);
    // If the target is a link, keep it and replace the file that it points to.
    std::error_code unresolved;
    if (std::filesystem::is_symlink(target, unresolved))
        target_ = std::filesystem::canonical(target);

    std::random_device random;
    do {
        temporary_ = target_.parent_path() / ".alcove-";
        temporary_ += std::to_string(random());
        temporary_ += ".part";
        forget(slot_);
        slot_ = remember(temporary_.string()); // before the file exists, so that no signal can leave it behind
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) {
        temporary_.clear();
        forget(slot_);
        if (errno == ENOENT)
            throw IoError(target.string() + ": its folder does not exist; create it first");
        fail(target, "cannot be written");
    }
    if (exists)
        ::fchmod(descriptor_, old.st_mode & 07777);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0)
        ::close(descriptor_);
    if (!temporary_.empty())
        ::unlink(temporary_.c_str());
    forget(slot_);
}

void AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        check_cancelled();
        const ssize_t put = ::write(descriptor_, bytes.data(), std::min(bytes.size(), block_size));
        if (put < 0 && errno != EINTR)
            fail(target_, "cannot be written");
        if (put > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(put));
            count_written(static_cast<std::size_t>(put));
        }
    }
}

void AtomicFile::copy(const InputFile& from, std::size_t offset, std::size_t count) {
    std::string buffer;
    while (count > 0) {
        check_cancelled();
        const std::size_t block = std::min(count, block_size);
        std::size_t copied = from.copy_to(descriptor_, offset, block);
        count_written(copied);
        if (copied == 0) { // the file systems cannot copy, or one failed: reading and writing show which
            buffer.resize(block);
            from.read_at(offset, buffer.data(), block);
            write(buffer);
            copied = block;
        }
        offset += copied;
        count -= copied;
    }
    from.check_unchanged();
}

/// Starts the transfer of each block to the disk early, so that commit() need not wait for all of them.
void AtomicFile::count_written(std::size_t count) {
    written_ += count;
#ifdef __linux__
    if (written_ - started_ >= block_size) {
        ::sync_file_range(descriptor_, static_cast<off_t>(started_), static_cast<off_t>(written_ - started_),
                          SYNC_FILE_RANGE_WRITE);
        started_ = written_;
    }
#endif
}

void AtomicFile::commit() {
    check_cancelled();
    // Sync the contents first, so that the name never belongs to a file that a power cut left incomplete.
    const bool synced = sync(descriptor_);
    if (!synced || ::close(std::exchange(descriptor_, -1)) != 0)
        fail(target_, "cannot be written");
    if (::rename(temporary_.c_str(), target_.c_str()) != 0)
        fail(target_, "cannot be replaced");
    temporary_.clear();
    forget(std::exchange(slot_, -1));
    if (!sync_folder_of(target_))
        fail(target_, "may be lost in a power cut");
}

void remove_unfinished_files() noexcept {
    for (const Unfinished& file : unfinished)
        if (file.state == 2)
            ::unlink(file.path.data());
}

}
