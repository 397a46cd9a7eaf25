#include "alcove/mesh/formats/file_bytes.h"

#include "alcove/base/detail/input_file.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>
#include <utility>

namespace alcove {
namespace {

constexpr std::size_t smallest_capacity = std::size_t{1} << 16; // least capacity of the buffer for a pipe
constexpr std::size_t large_file = std::size_t{1} << 20;

struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
};
using Buffer = std::unique_ptr<char, Free>;

/// For a large buffer, realloc() moves pages instead of copying bytes.
Buffer grown(Buffer bytes, std::size_t capacity) {
    auto* larger = static_cast<char*>(std::realloc(bytes.get(), capacity));
    if (larger == nullptr)
        throw std::bad_alloc();
    (void)bytes.release();
    prefer_huge_pages(larger, capacity);
    return Buffer(larger);
}

}

FileBytes::FileBytes(const std::filesystem::path& file) : path_(file) {
    InputFile input(file);
    read_all(input);
}

FileBytes::FileBytes(const std::filesystem::path& file, Head head) : path_(file) {
    const auto input = std::make_shared<InputFile>(file);
    std::size_t in_memory = input->size();
    if (input->size() >= large_file) {
        std::array<char, 64> first;
        input->read_at(0, first.data(), first.size());
        in_memory = head({first.data(), first.size()});
    }
    if (in_memory >= input->size()) {
        read_all(*input);
        return;
    }
    bytes_ = std::shared_ptr<char[]>(new char[in_memory + 1]);
    input->read_at(0, bytes_.get(), in_memory);
    bytes_[in_memory] = '\0';
    size_ = in_memory;
    on_disk_ = input;
}

void FileBytes::read_all(InputFile& input) {
    // With a spare byte, the last read finds either the end of the file, or that the file is longer than its size says.
    std::size_t capacity = input.size() + 1;
    Buffer bytes = grown({}, capacity);
    while (const std::size_t got = input.read(bytes.get() + size_, capacity - size_)) {
        size_ += got;
        if (size_ == capacity) {
            capacity = std::max(2 * capacity, smallest_capacity);
            bytes = grown(std::move(bytes), capacity);
        }
    }
    bytes.get()[size_] = '\0';
    bytes_ = std::shared_ptr<char[]>(bytes.release(), std::free);
    if (size_ == 0)
        fail(path_.extension() == ".toml" ? "is empty" : "is empty; export it again");
}

FileBytes::FileBytes(const std::filesystem::path& file, std::string_view bytes)
    : path_(file), bytes_(new char[bytes.size() + 1]), size_(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), bytes_.get());
    bytes_[size_] = '\0';
}

FilePart FileBytes::part(std::size_t begin, std::size_t size) const {
    if (on_disk_ && size > size_ - std::min(begin, size_))
        return {*on_disk_, begin, size};
    return FilePart(view().substr(begin, size));
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
    fail_at_byte(static_cast<std::size_t>(place - begin()), message);
}

void FileBytes::fail_at_byte(std::size_t place, std::string_view message) const {
    fail("byte " + grouped(place) + ": " + std::string(message));
}

}
