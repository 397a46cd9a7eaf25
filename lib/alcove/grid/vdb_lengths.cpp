#include "alcove/grid/vdb_lengths.h"

#include "alcove/errors.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace alcove {
namespace {

/// Reads forward; a length that is larger than what is left is an error.
class Header {
  public:
    explicit Header(const std::filesystem::path& file)
        : file_(file), size_(std::filesystem::file_size(file)), buffer_(std::size_t{1} << 20) {
        stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
        stream_.open(file, std::ios::binary);
    }

    template <class T>
    T number() {
        T value{};
        stream_.read(reinterpret_cast<char*>(&value), sizeof value);
        if (!stream_)
            fail("ends early");
        at_ += sizeof value;
        return value;
    }
    void skip(std::uint64_t bytes) {
        check(bytes);
        stream_.ignore(static_cast<std::streamsize>(bytes)); // a seek would empty the buffer
        at_ += bytes;
    }
    void go_to(std::int64_t place) {
        if (place < 0 || static_cast<std::uint64_t>(place) > size_)
            fail(fmt::format("names the place {} in itself, which is none", place));
        if (static_cast<std::uint64_t>(place) == at_)
            return;
        stream_.seekg(place);
        at_ = static_cast<std::uint64_t>(place);
    }
    std::string text() {
        const auto length = number<std::uint32_t>();
        check(length);
        std::string value(length, '\0');
        stream_.read(value.data(), length);
        at_ += length;
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

    std::size_t set_bits(std::size_t bytes) {
        std::size_t bits = 0;
        for (std::size_t i = 0; i < bytes; i += sizeof(std::uint64_t))
            bits += static_cast<std::size_t>(std::popcount(number<std::uint64_t>()));
        return bits;
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}: the file is damaged, write it again", file_.string(), what));
    }

  private:
    void check(std::uint64_t bytes) const {
        if (bytes > size_ - at_)
            fail(fmt::format("names a length of {} bytes at byte {}, which is more than it has", bytes, at_));
    }

    std::filesystem::path file_;
    std::uint64_t size_, at_ = 0;
    std::vector<char> buffer_; // outlives the stream
    std::ifstream stream_;
};

constexpr std::size_t leaf_mask_bytes = 64; // of 8³ voxels

constexpr std::int64_t magic = 0x56444220;    // " BDV"
constexpr std::uint32_t oldest_version = 222; // of files with a UUID and compression by grid, since 2013

/// How the values of a grid are stored.
struct Storage {
    bool zip, active_only, blosc;
    std::size_t bytes; ///< of a value; half of that of a float where it is halved
};

/// The values of a node: OpenVDB reads as many bytes as it finds named, into room for those that there must be.
void check_values(Header& header, std::size_t count, std::size_t active, std::size_t mask_bytes,
                  const Storage& storage) {
    enum { one_inactive = 2, mask_and_none = 3, mask_and_one = 4, mask_and_two = 5, all_values = 6 };
    const unsigned kind = header.number<std::uint8_t>();
    if (kind == one_inactive || kind == mask_and_one || kind == mask_and_two)
        header.skip(sizeof(float));
    if (kind == mask_and_two)
        header.skip(sizeof(float));
    if (kind == mask_and_none || kind == mask_and_one || kind == mask_and_two)
        header.skip(mask_bytes);
    const std::size_t stored = storage.bytes * (storage.active_only && kind != all_values ? active : count);
    if (!storage.blosc && !storage.zip) {
        header.skip(stored);
        return;
    }
    // Not above 0 where they are stored as they are.
    const auto size = header.number<std::int64_t>();
    if (size <= 0 && static_cast<std::uint64_t>(-size) != stored)
        header.fail(fmt::format("names {} bytes for values that take {}", -size, stored));
    header.skip(static_cast<std::uint64_t>(size <= 0 ? -size : size));
}

/// An internal node of (1 << log2)³ children, and those; adds up the leaves.
void check_node(Header& header, int log2, const Storage& storage, std::size_t& leaves) {
    const std::size_t count = std::size_t{1} << (3 * log2), mask_bytes = count / 8;
    const std::size_t children = header.set_bits(mask_bytes), active = header.set_bits(mask_bytes);
    check_values(header, count, active, mask_bytes, storage);
    for (std::size_t child = 0; child < children; ++child)
        if (log2 == 5) {
            check_node(header, 4, storage, leaves);
        } else {
            header.skip(leaf_mask_bytes);
            ++leaves;
        }
}

/// A tree of floats: its nodes, then the values of its leaves.
void check_tree(Header& header, const Storage& storage) {
    header.number<std::int32_t>(); // buffers
    header.skip(sizeof(float));    // background
    const auto tiles = header.number<std::uint32_t>(), children = header.number<std::uint32_t>();
    constexpr std::size_t coordinates = 3 * sizeof(std::int32_t);
    header.skip(std::uint64_t{tiles} * (coordinates + sizeof(float) + 1));
    std::size_t leaves = 0;
    for (std::uint32_t child = 0; child < children; ++child) {
        header.skip(coordinates);
        check_node(header, 5, storage, leaves);
    }
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
        const std::size_t active = header.set_bits(leaf_mask_bytes);
        check_values(header, 8 * leaf_mask_bytes, active, leaf_mask_bytes, storage);
    }
}

/// Bytes of a transform of that type; nothing for those that take what they like.
std::optional<std::uint64_t> bytes_of_transform(const std::string& type) {
    constexpr std::uint64_t vector = 3 * sizeof(double), matrix = 16 * sizeof(double);
    if (type == "UniformScaleMap" || type == "ScaleMap")
        return 5 * vector;
    if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap")
        return 6 * vector;
    if (type == "TranslationMap")
        return vector;
    if (type == "AffineMap" || type == "UnitaryMap")
        return matrix;
    return {};
}

void check_grid(Header& header, bool has_offsets) {
    header.text(); // its name
    const std::string type = header.text();
    const bool is_instance = !header.text().empty(); // whose tree is that of another
    const auto begin = header.number<std::int64_t>();
    header.number<std::int64_t>(); // where its values begin
    const auto end = header.number<std::int64_t>();
    if (has_offsets)
        header.go_to(begin);
    const auto compression = header.number<std::uint32_t>();
    header.metadata();
    const std::optional<std::uint64_t> transform = bytes_of_transform(header.text());
    const bool halved = type == "Tree_float_5_4_3_HalfFloat";
    if (transform && !is_instance && (halved || type == "Tree_float_5_4_3")) {
        header.skip(*transform);
        check_tree(header, {(compression & 1) != 0, (compression & 2) != 0, (compression & 4) != 0,
                            halved ? sizeof(float) / 2 : sizeof(float)});
    }
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
