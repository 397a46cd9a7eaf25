#include "alcove/atomic_file.h"

#include "alcove/errors.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>
#include <string>

namespace alcove {
namespace {

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
    // A link stays a link: the file it points to is replaced.
    std::error_code unresolved;
    if (std::filesystem::is_symlink(target, unresolved))
        target_ = std::filesystem::weakly_canonical(target);

    std::random_device random;
    do {
        temporary_ = target_.parent_path() / ".alcove-";
        temporary_ += std::to_string(random());
        temporary_ += ".part";
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) {
        temporary_.clear();
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
}

}
