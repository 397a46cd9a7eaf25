#include "alcove/base/detail/input_file.h"

#include "alcove/base/detail/file_kind.h"
#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

namespace alcove {
namespace {

[[noreturn]] void fail_to_open(const std::filesystem::path& file) {
    const char* const fix = file == "-" ? "; use /dev/stdin for the standard input" : "; check the name";
    throw InputError(file.string() + ": cannot be opened: " + std::strerror(errno) + fix);
}

[[noreturn]] void fail_to_read(const std::filesystem::path& file) {
    throw InputError(file.string() + ": cannot be read: " + std::strerror(errno) + "; copy it from its source again");
}

[[noreturn]] void refuse_kind(const std::filesystem::path& file, const std::string& kind) {
    throw InputError(file.string() + ": is " + kind + (kind == "a folder" ? "; name a file in it" : "; name a file"));
}

[[noreturn]] void refuse_change(const std::filesystem::path& file) {
    throw InputError(file.string() + ": was changed while it was being processed; run again");
}

void check_size(const std::filesystem::path& file, std::size_t bytes) {
    if (static_cast<double>(bytes) > read_limit())
        throw LimitError(file.string() + ": is larger than " + bytes_text(read_limit()) +
                         ", the limit for one file: raise --max-read (by default half of --max-memory, at most 4 GB)");
}

}

InputFile::InputFile(const std::filesystem::path& file)
    : path_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_.number < 0)
        fail_to_open(file);
    struct stat status {};
    if (::fstat(descriptor_.number, &status) != 0)
        fail_to_read(file);
    if (const char* kind = special_kind(status); kind && !S_ISFIFO(status.st_mode))
        refuse_kind(file, kind);
    size_ = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
    modified_ = status.st_mtim;
    check_size(file, size_);
}

InputFile::Descriptor::~Descriptor() {
    if (number >= 0)
        ::close(number);
}

std::size_t InputFile::read(char* to, std::size_t count) {
    for (;;) {
        check_cancelled();
        const ssize_t got = ::read(descriptor_.number, to, std::min<std::size_t>(count, 1u << 26));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            fail_to_read(path_);
        done_ += static_cast<std::size_t>(got);
        check_size(path_, done_);
        return static_cast<std::size_t>(got);
    }
}

void InputFile::read_at(std::size_t offset, char* to, std::size_t count) const {
    while (count > 0) {
        check_cancelled();
        const ssize_t got =
            ::pread(descriptor_.number, to, std::min<std::size_t>(count, 1u << 26), static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            fail_to_read(path_);
        if (got == 0)
            refuse_change(path_);
        to += got;
        offset += static_cast<std::size_t>(got);
        count -= static_cast<std::size_t>(got);
    }
    check_unchanged();
}

std::size_t InputFile::copy_to(int output, std::size_t offset, std::size_t count) const {
#ifdef __linux__
    auto from = static_cast<off_t>(offset);
    const ssize_t copied = ::copy_file_range(descriptor_.number, &from, output, nullptr, count, 0);
    return copied < 0 ? 0 : static_cast<std::size_t>(copied);
#else
    (void)output, (void)offset, (void)count;
    return 0;
#endif
}

void InputFile::check_unchanged() const {
    struct stat status {};
    if (::fstat(descriptor_.number, &status) != 0)
        fail_to_read(path_);
    if (static_cast<std::size_t>(status.st_size) != size_ || status.st_mtim.tv_sec != modified_.tv_sec ||
        status.st_mtim.tv_nsec != modified_.tv_nsec)
        refuse_change(path_);
}

void check_input_file(const std::filesystem::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0)
        fail_to_open(file);
    if (const char* kind = special_kind(status)) // checked first, because opening a pipe would wait for its writer
        refuse_kind(file, kind);
    char first = 0;
    InputFile(file).read(&first, 1);
}

}
