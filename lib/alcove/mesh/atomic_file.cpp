#include "alcove/mesh/atomic_file.h"

#include "alcove/errors.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

namespace alcove {
namespace {

[[noreturn]] void fail(const std::filesystem::path& target, const std::string& what) {
    const int reason = errno;
    throw IoError(target.string() + ": " + what + ": " + std::strerror(reason));
}

/// What open(2) would have given a new file; mkstemp makes it private.
mode_t default_mode() {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return 0666 & ~mask;
}

}

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target) {
    std::error_code ignored;
    if (std::filesystem::is_directory(target, ignored))
        throw IoError(target.string() + ": is a folder; name a file to write");
    if (std::filesystem::exists(target, ignored) && !std::filesystem::is_regular_file(target, ignored))
        throw IoError(target.string() + ": is a device, not a file; name a file to write");
    // A link stays a link: the file it points to is replaced.
    if (std::filesystem::is_symlink(target, ignored))
        if (auto real = std::filesystem::weakly_canonical(target, ignored); !ignored)
            target_ = real;
    std::string name = target_.string() + ".XXXXXX";
    descriptor_ = ::mkstemp(name.data());
    if (descriptor_ < 0)
        fail(target, "cannot be written in its folder");
    temporary_ = name;
    struct stat old {};
    ::fchmod(descriptor_, ::stat(target_.c_str(), &old) == 0 ? old.st_mode & 07777 : default_mode());
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
