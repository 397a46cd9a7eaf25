#include "alcove/base/detail/atomic_file.h"

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

/// A path that a signal handler can read: in static memory.
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

void forget(int slot) {
    if (slot >= 0)
        unfinished[static_cast<std::size_t>(slot)].state = 0;
}

[[noreturn]] void fail(const std::filesystem::path& target, const std::string& what) {
    const int reason = errno;
    throw IoError(target.string() + ": " + what + ": " + std::strerror(reason));
}

}

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target) {
    struct stat old {};
    const bool exists = ::stat(target.c_str(), &old) == 0;
    if (exists && S_ISDIR(old.st_mode))
        throw IoError(target.string() + ": is a folder; name a file to write");
    if (exists && !S_ISREG(old.st_mode))
        throw IoError(target.string() + ": is a device, not a file; name a file to write");
    if (exists && ::access(target.c_str(), W_OK) != 0)
        fail(target, "cannot be written");
    // Keep a link: replace the file that it points to.
    std::error_code unresolved;
    if (std::filesystem::is_symlink(target, unresolved))
        target_ = std::filesystem::weakly_canonical(target);

    std::random_device random;
    do {
        temporary_ = target_.parent_path() / ".alcove-";
        temporary_ += std::to_string(random());
        temporary_ += ".part";
        forget(slot_);
        slot_ = remember(temporary_.string()); // before the file exists, so that a signal cannot leave it behind
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) {
        temporary_.clear();
        forget(slot_);
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
        const ssize_t put = ::write(descriptor_, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 30));
        if (put < 0 && errno != EINTR)
            fail(target_, "cannot be written");
        if (put > 0)
            bytes.remove_prefix(static_cast<std::size_t>(put));
    }
}

void AtomicFile::commit() {
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0)
        fail(target_, "cannot be written");
    if (::rename(temporary_.c_str(), target_.c_str()) != 0)
        fail(target_, "cannot be replaced");
    temporary_.clear();
    forget(std::exchange(slot_, -1));
}

void remove_unfinished_files() noexcept {
    for (const Unfinished& file : unfinished)
        if (file.state == 2)
            ::unlink(file.path.data());
}

}
