#include "alcove/vdb/detail/structure.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace alcove {
namespace {

/// The size of a metadata value. For these types OpenVDB reads the size of the type and ignores the declared one.
std::uint32_t bytes_of_type(const std::string& type, std::uint32_t declared) {
    static const std::map<std::string, std::uint32_t> sizes{
        {"bool", 1},   {"int32", 4},  {"int64", 8},  {"float", 4},  {"double", 8}, {"vec2i", 8},
        {"vec2s", 8},  {"vec2d", 16}, {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"vec4i", 16},
        {"vec4s", 16}, {"vec4d", 32}, {"quats", 16}, {"quatd", 32}, {"mat4s", 64}, {"mat4d", 128}};
    const auto size = sizes.find(type);
    return size == sizes.end() ? declared : size->second;
}

/// Reads a file forward; a length that exceeds the rest of the file is an error.
class Header {
  public:
    explicit Header(const std::filesystem::path& file)
        : file_(file), size_(std::filesystem::file_size(file)), buffer_(std::size_t{1} << 20) {
        stream_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
        stream_.open(file, std::ios::binary);
    }

    template <class T>
    void read(T* values, std::size_t count) {
        check(count * sizeof(T));
        stream_.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
        at_ += count * sizeof(T);
    }
    template <class T>
    T number() {
        T value{};
        read(&value, 1);
        return value;
    }
    void skip(std::uint64_t bytes) {
        check(bytes);
        stream_.ignore(static_cast<std::streamsize>(bytes)); // a seek would empty the buffer
        at_ += bytes;
    }
    std::uint64_t at() const { return at_; }
    std::uint64_t left() const { return size_ - at_; }
    /// Skips forward to an offset.
    void go_to(std::int64_t offset) {
        if (offset < 0 || static_cast<std::uint64_t>(offset) < at_ || static_cast<std::uint64_t>(offset) > size_)
            fail(fmt::format("declares the invalid offset {}", offset));
        stream_.seekg(offset);
        at_ = static_cast<std::uint64_t>(offset);
    }
    void expect_at(std::int64_t offset) const {
        if (static_cast<std::uint64_t>(offset) != at_)
            fail(fmt::format("declares the offset {} for data at offset {}", offset, at_));
    }
    std::string bytes(std::uint64_t count) {
        check(count);
        std::string value(count, '\0');
        read(value.data(), count);
        return value;
    }
    std::string text() { return bytes(number<std::uint32_t>()); }
    void check(std::uint64_t bytes) const {
        if (bytes > left())
            fail(fmt::format("declares a length of {} bytes at byte {}, which is beyond its end", bytes, at_));
    }
    [[noreturn]] void fail(const std::string& what, const char* fix = "the file is damaged, write it again") const {
        throw InputError(fmt::format("{}: {}: {}", file_.string(), in_one_line(what), fix));
    }

  private:
    std::filesystem::path file_;
    std::uint64_t size_, at_ = 0;
    std::vector<char> buffer_; // must outlive the stream
    std::ifstream stream_;
};

constexpr std::int64_t magic = 0x56444220;    // " BDV"
constexpr std::uint32_t oldest_version = 222; // of files with a UUID and compression per grid, since 2013

/// The sizes in the header of a Blosc chunk: unpacked, and as stored with the header.
struct BloscSizes {
    std::uint32_t unpacked, stored;
};

BloscSizes blosc_sizes(Header& header) {
    header.skip(2 * sizeof(std::uint16_t)); // versions, flags, bytes of an item
    const auto unpacked = header.number<std::uint32_t>();
    header.skip(sizeof(std::uint32_t)); // bytes of a block
    return {unpacked, header.number<std::uint32_t>()};
}
constexpr std::uint64_t blosc_header = 16;

/// Checks `count` items of metadata for delayed loading: uncompressed, or a Blosc chunk, for which OpenVDB
/// allocates the size that the chunk declares.
void check_delayed_items(Header& header, std::uint64_t count, std::uint64_t item, std::uint32_t stored) {
    if (stored == 0) {
        header.skip(count * item);
        return;
    }
    constexpr std::uint64_t padded = 128; // OpenVDB pads shorter data to this
    if (stored < blosc_header)
        header.fail("declares too short a length for delayed loading");
    header.check(stored);
    const BloscSizes sizes = blosc_sizes(header);
    if (sizes.stored != stored || (sizes.unpacked != count * item && sizes.unpacked != padded))
        header.fail("declares the wrong lengths for delayed loading");
    header.skip(stored - blosc_header);
}

void check_delayed_loading(Header& header, std::uint32_t size) {
    if (size == 0)
        return;
    const std::uint64_t end = header.at() + size;
    const std::uint64_t count = header.number<std::uint32_t>();
    if (count > header.left())
        header.fail("declares more leaves for delayed loading than it can contain");
    check_delayed_items(header, count, sizeof(std::int8_t), header.number<std::uint32_t>());
    constexpr std::uint32_t none = 0xffffffff;
    if (const auto stored = header.number<std::uint32_t>(); stored != none)
        check_delayed_items(header, count, sizeof(std::int64_t), stored);
    header.expect_at(static_cast<std::int64_t>(end));
}

/// \return whether the grid stores its values as half floats.
bool check_metadata(Header& header) {
    bool halved = false;
    const auto count = header.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = header.text(), type = header.text();
        const auto size = header.number<std::uint32_t>();
        if (size != bytes_of_type(type, size))
            header.fail(fmt::format("declares {} bytes for metadata of another length", size));
        header.check(size);
        if (name == "is_saved_as_half_float") {
            // OpenVDB treats a value of any other type as true.
            const auto flag = type == "bool" ? header.number<std::uint8_t>() : 2;
            if (flag > 1)
                header.fail("does not say whether its values are half floats");
            halved = flag != 0;
        } else if (type == "__delayedload") {
            check_delayed_loading(header, size);
        } else {
            header.skip(size);
        }
    }
    return halved;
}

/// How the values of a grid are stored.
struct Storage {
    bool zip, active_only, blosc;
    std::size_t bytes; ///< per value: those of a float or a half float
};

/// OpenVDB accepts however much zlib could unpack, and ignores the checksum.
void check_zipped(Header& header, std::size_t size, std::size_t stored) {
    const std::string packed = header.bytes(size);
    std::vector<Bytef> values(stored);
    uLongf unpacked = stored;
    if (uncompress(values.data(), &unpacked, reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
        unpacked != stored)
        header.fail("contains values that cannot be unzipped");
}

/// Checks the values of a node: OpenVDB reads the declared number of bytes into a buffer for the expected number.
void check_values(Header& header, std::size_t count, std::size_t active, std::size_t mask_bytes,
                  const Storage& storage) {
    enum { one_inactive = 2, mask_and_none = 3, mask_and_one = 4, mask_and_two = 5, all_values = 6 };
    const unsigned kind = header.number<std::uint8_t>();
    if (kind > all_values)
        header.fail(fmt::format("has a node with values of the invalid kind {}", kind));
    if (kind == one_inactive || kind == mask_and_one || kind == mask_and_two)
        header.skip(sizeof(float));
    if (kind == mask_and_two)
        header.skip(sizeof(float));
    if (kind == mask_and_none || kind == mask_and_one || kind == mask_and_two)
        header.skip(mask_bytes);
    const std::size_t stored = storage.bytes * (storage.active_only && kind != all_values ? active : count);
    const bool is_left_out = storage.bytes < sizeof(float) && stored == 0; // and so is the length
    if (is_left_out || (!storage.blosc && !storage.zip)) {
        header.skip(stored);
        return;
    }
    // 0 or negative if the values are not compressed.
    const auto declared = header.number<std::int64_t>();
    const auto size = static_cast<std::uint64_t>(declared <= 0 ? -declared : declared);
    header.check(size);
    if (declared <= 0) {
        if (size != stored)
            header.fail(fmt::format("declares {} bytes for values that take {}", size, stored));
        header.skip(size);
    } else if (storage.blosc) {
        if (size < blosc_header)
            header.fail(fmt::format("declares {} bytes for values that take more", size));
        if (const BloscSizes sizes = blosc_sizes(header); sizes.unpacked != stored || sizes.stored != size)
            header.fail(fmt::format("declares {} unpacked bytes for values that take {}", sizes.unpacked, stored));
        header.skip(size - blosc_header);
    } else {
        check_zipped(header, size, stored);
    }
}

using Mask = std::vector<std::uint64_t>;
constexpr std::size_t leaf_voxels = 512;

Mask read_mask(Header& header, std::size_t bits) {
    Mask mask(bits / 64);
    header.read(mask.data(), mask.size());
    return mask;
}
std::size_t set_bits(const Mask& mask) {
    std::size_t bits = 0;
    for (const std::uint64_t word : mask)
        bits += static_cast<std::size_t>(std::popcount(word));
    return bits;
}
bool disjoint(const Mask& a, const Mask& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if ((a[i] & b[i]) != 0)
            return false;
    return true;
}

/// Checks an internal node of (1 << log2)³ children, recursively; appends the masks of active voxels of its leaves.
void check_node(Header& header, int log2, const Storage& storage, std::vector<std::uint64_t>& leaves) {
    const std::size_t count = std::size_t{1} << (3 * log2);
    const Mask children = read_mask(header, count), active = read_mask(header, count);
    if (!disjoint(children, active)) // OpenVDB would use a pointer as a value
        header.fail("marks a child node as a value");
    check_values(header, count, set_bits(active), count / 8, storage);
    for (std::size_t child = set_bits(children); child > 0; --child)
        if (log2 == 5) {
            check_node(header, 4, storage, leaves);
        } else {
            const Mask mask = read_mask(header, leaf_voxels);
            leaves.insert(leaves.end(), mask.begin(), mask.end());
        }
}
/// Checks that the tiles and nodes below the root have distinct, valid origins.
class Origins {
  public:
    void read(Header& header) {
        std::array<std::int32_t, 3> origin{};
        header.read(origin.data(), origin.size());
        for (const std::int32_t coordinate : origin)
            if (coordinate % edge != 0)
                header.fail("has a node at an invalid origin");
        if (!seen_.insert(origin).second)
            header.fail("has two nodes at the same origin");
    }

  private:
    static constexpr std::int32_t edge = 4096;
    std::set<std::array<std::int32_t, 3>> seen_;
};

/// Checks a float tree: its nodes, then the values of its leaves from the offset `values` on.
void check_tree(Header& header, const Storage& storage, std::int64_t values, bool has_offsets) {
    if (header.number<std::int32_t>() != 1)
        header.fail("declares a number of buffers other than one");
    header.skip(sizeof(float)); // background
    const auto tiles = header.number<std::uint32_t>(), children = header.number<std::uint32_t>();
    Origins origins;
    for (std::uint32_t tile = 0; tile < tiles; ++tile) {
        origins.read(header);
        header.skip(sizeof(float));
        if (header.number<std::uint8_t>() > 1)
            header.fail("does not say whether a tile is active");
    }
    std::vector<std::uint64_t> leaves;
    for (std::uint32_t child = 0; child < children; ++child) {
        origins.read(header);
        check_node(header, 5, storage, leaves);
    }
    if (has_offsets)
        header.expect_at(values);
    constexpr std::size_t words = leaf_voxels / 64;
    for (auto leaf = leaves.begin(); leaf != leaves.end(); leaf += words) {
        const Mask active = read_mask(header, leaf_voxels);
        if (!std::equal(active.begin(), active.end(), leaf)) // the mask is stored twice
            header.fail("has a leaf with two different masks of active voxels");
        check_values(header, leaf_voxels, set_bits(active), leaf_voxels / 8, storage);
    }
}

/// A scale is stored together with values derived from it.
void check_scale(Header& header) {
    std::array<std::array<double, 3>, 5> scale{};
    header.read(scale.data(), scale.size());
    const auto alike = [](double a, double b) { return std::fabs(a - b) <= 1e-14 * std::fabs(b); };
    const auto& [edge, size, inverse, inverse_square, half_inverse] = scale;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!alike(size[axis], std::fabs(edge[axis])) || !alike(inverse[axis], 1.0 / edge[axis]) ||
            !alike(inverse_square[axis], inverse[axis] * inverse[axis]) ||
            !alike(half_inverse[axis], 0.5 * inverse[axis]))
            header.fail("contains an inconsistent transform");
}

void check_transform(Header& header) {
    constexpr std::uint64_t vector = 3 * sizeof(double), matrix = 16 * sizeof(double);
    const std::string type = header.text();
    if (type == "UniformScaleMap" || type == "ScaleMap") {
        check_scale(header);
    } else if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") {
        header.skip(vector);
        check_scale(header);
    } else if (type == "TranslationMap") {
        header.skip(vector);
    } else if (type == "AffineMap" || type == "UnitaryMap") {
        header.skip(matrix);
    } else {
        header.fail(fmt::format("contains a float grid with a transform of type {}", type),
                    "resample it to a uniform, unrotated transform");
    }
}

void check_grid(Header& header, bool has_offsets) {
    header.text(); // its name
    const std::string type = header.text();
    const bool is_instance = !header.text().empty(); // it shares the tree of another grid
    const auto begin = header.number<std::int64_t>(), values = header.number<std::int64_t>(),
               end = header.number<std::int64_t>();
    const bool halved = type == "Tree_float_5_4_3_HalfFloat";
    if (!halved && type != "Tree_float_5_4_3") {
        if (!has_offsets)
            header.fail(fmt::format("is a stream that contains a grid of type {} without its length", type),
                        "write it as a file");
        header.go_to(end);
        return;
    }
    if (has_offsets)
        header.expect_at(begin);
    const auto compression = header.number<std::uint32_t>();
    if (check_metadata(header) != halved)
        header.fail("says both that its values are half floats and that they are not");
    check_transform(header);
    if (!is_instance)
        check_tree(header,
                   {(compression & 1) != 0, (compression & 2) != 0, (compression & 4) != 0,
                    halved ? sizeof(float) / 2 : sizeof(float)},
                   values, has_offsets);
    if (has_offsets)
        header.expect_at(end);
}

}

void check_vdb_structure(const std::filesystem::path& file) {
    Header header(file);
    if (header.left() < sizeof(magic) || header.number<std::int64_t>() != magic)
        header.fail("is not a .vdb file", "check the name");
    if (header.number<std::uint32_t>() < oldest_version)
        header.fail("was written by a version of OpenVDB before 2013", "write it again with a newer one");
    header.skip(2 * sizeof(std::uint32_t)); // the library's version
    const bool has_offsets = header.number<char>() != 0;
    constexpr std::uint64_t uuid = 36;
    header.skip(uuid);
    check_metadata(header);
    const auto grids = header.number<std::int32_t>();
    for (std::int32_t i = 0; i < grids; ++i)
        check_grid(header, has_offsets);
    if (header.left() > 0)
        header.fail(fmt::format("has {} bytes after its last grid", header.left()));
}

}
