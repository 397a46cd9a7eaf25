#include "alcove/grid/vdb_lengths.h"

#include "alcove/errors.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>

namespace alcove {
namespace {

/// Reads forward; a length that is larger than what is left is an error.
class Header {
  public:
    explicit Header(const std::filesystem::path& file)
        : file_(file), stream_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {}

    template <class T>
    T number() {
        T value{};
        stream_.read(reinterpret_cast<char*>(&value), sizeof value);
        if (!stream_)
            fail("ends early");
        return value;
    }
    void skip(std::uint64_t bytes) {
        const auto at = static_cast<std::uint64_t>(stream_.tellg());
        if (bytes > size_ - at)
            fail(fmt::format("names a length of {} bytes at byte {}, which is more than it has", bytes, at));
        stream_.seekg(static_cast<std::streamoff>(at + bytes));
    }
    void go_to(std::int64_t place) {
        if (place < 0 || static_cast<std::uint64_t>(place) > size_)
            fail(fmt::format("names the place {} in itself, which is none", place));
        stream_.seekg(place);
    }
    std::string text() {
        const auto length = number<std::uint32_t>();
        const auto at = stream_.tellg();
        skip(length);
        std::string value(length, '\0');
        stream_.seekg(at);
        stream_.read(value.data(), length);
        return value;
    }
    void metadata() {
        const auto count = number<std::uint32_t>();
        for (std::uint32_t i = 0; i < count; ++i) {
            text(); // its name
            text(); // its type
            skip(number<std::uint32_t>());
        }
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}: the file is damaged, write it again", file_.string(), what));
    }

    std::filesystem::path file_;
    std::ifstream stream_;
    std::uint64_t size_;
};

constexpr std::int64_t magic = 0x56444220;    // " BDV"
constexpr std::uint32_t oldest_version = 222; // of files with a UUID and compression by grid, since 2013

void check_grid(Header& header, bool has_offsets) {
    header.text(); // its name
    header.text(); // its type
    header.text(); // its parent, where it is an instance of one
    const auto begin = header.number<std::int64_t>();
    header.number<std::int64_t>(); // where its values begin
    const auto end = header.number<std::int64_t>();
    if (has_offsets)
        header.go_to(begin);
    header.number<std::uint32_t>(); // compression
    header.metadata();
    header.text(); // the type of its transform
    if (has_offsets)
        header.go_to(end);
}

}

void check_vdb_lengths(const std::filesystem::path& file) {
    Header header(file);
    if (header.number<std::int64_t>() != magic || header.number<std::uint32_t>() < oldest_version)
        return;
    header.skip(2 * sizeof(std::uint32_t)); // the library's version
    const bool has_offsets = header.number<char>() != 0;
    constexpr std::uint64_t uuid = 36;
    header.skip(uuid);
    header.metadata();
    const auto grids = header.number<std::int32_t>();
    // Without offsets the second grid is behind the tree of the first.
    for (std::int32_t i = 0; i < (has_offsets ? grids : std::min(grids, 1)); ++i)
        check_grid(header, has_offsets);
}

}
