#include "alcove/mesh/formats/file_bytes.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

namespace alcove {
namespace {

struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0)
            ::close(number);
    }
};

[[noreturn]] void fail_io(const std::filesystem::path& file, const char* what) {
    const int reason = errno;
    throw IoError(file.string() + ": " + what + ": " + std::strerror(reason));
}

}

FileBytes::FileBytes(const std::filesystem::path& file) : path_(file) {
    const Descriptor input{::open(file.c_str(), O_RDONLY | O_CLOEXEC)};
    if (input.number < 0)
        throw InputError(file.string() + ": cannot be opened: " + std::strerror(errno) + "; check the name");
    struct stat status {};
    if (::fstat(input.number, &status) != 0)
        fail_io(file, "cannot be read");
    if (S_ISDIR(status.st_mode))
        fail("is a folder; name a mesh file in it");
    if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode))
        fail("is a device, not a file; name a mesh file");

    std::size_t capacity = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 1u << 16;
    bytes_.reset(new char[capacity + 1]);
    prefer_huge_pages(bytes_.get(), capacity + 1);
    for (;;) {
        if (size_ == capacity) {
            char more = 0;
            const ssize_t got = ::read(input.number, &more, 1);
            if (got == 0)
                break;
            if (got > 0) {
                std::shared_ptr<char[]> larger(new char[capacity * 2 + 2]);
                std::memcpy(larger.get(), bytes_.get(), size_);
                bytes_ = std::move(larger);
                capacity = capacity * 2 + 1;
                bytes_[size_++] = more;
                continue;
            }
        }
        const std::size_t wanted = std::min<std::size_t>(capacity - size_, 1u << 30);
        const ssize_t got = ::read(input.number, bytes_.get() + size_, wanted);
        if (got == 0 && wanted > 0)
            break;
        if (got < 0 && errno != EINTR)
            fail_io(file, "cannot be read");
        if (got > 0)
            size_ += static_cast<std::size_t>(got);
    }
    bytes_[size_] = '\0';
    if (size_ == 0)
        fail(file.extension() == ".toml" ? "is empty" : "is empty; export it again");
}

FileBytes::FileBytes(const std::filesystem::path& file, std::string_view bytes)
    : path_(file), bytes_(new char[bytes.size() + 1]), size_(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), bytes_.get());
    bytes_[size_] = '\0';
}

std::size_t FileBytes::line_at(const char* place) const {
    std::size_t line = 1;
    for (const char* at = begin(); at < place; ++at)
        if (*at == '\n' || (*at == '\r' && at[1] != '\n'))
            ++line;
    return line;
}

void FileBytes::fail(std::string_view message) const {
    throw InputError(path_.string() + ": " + in_one_line(std::string(message)));
}

void FileBytes::fail_at_line(const char* place, std::string_view message) const {
    fail("line " + grouped(line_at(place)) + ": " + std::string(message));
}

void FileBytes::fail_at_byte(const char* place, std::string_view message) const {
    fail("byte " + grouped(static_cast<std::size_t>(place - begin())) + ": " + std::string(message));
}

}
