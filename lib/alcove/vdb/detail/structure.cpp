#include "alcove/vdb/detail/structure.h"

#include "alcove/vdb/detail/forward_reader.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
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

constexpr std::int64_t magic = 0x56444220;    // " BDV"
constexpr std::uint32_t oldest_version = 222; // with a UUID and a compression per grid, since 2013

/// The sizes in the header of a Blosc chunk: unpacked, and as stored with the header.
struct BloscSizes {
    std::uint32_t unpacked, stored;
};

BloscSizes blosc_sizes(ForwardReader& file) {
    file.skip(2 * sizeof(std::uint16_t)); // versions, flags, bytes of an item
    const auto unpacked = file.number<std::uint32_t>();
    file.skip(sizeof(std::uint32_t)); // bytes of a block
    return {unpacked, file.number<std::uint32_t>()};
}
constexpr std::uint64_t blosc_header = 16;

/// Checks `count` items of metadata for delayed loading, which are uncompressed or a Blosc chunk. OpenVDB allocates the
/// size that the chunk declares.
void check_delayed_items(ForwardReader& file, std::uint64_t count, std::uint64_t item, std::uint32_t stored) {
    if (stored == 0) {
        file.skip(count * item);
        return;
    }
    constexpr std::uint64_t padded = 128; // OpenVDB pads shorter data to this
    if (stored < blosc_header)
        file.fail("declares too short a length for delayed loading");
    file.check(stored);
    const BloscSizes sizes = blosc_sizes(file);
    if (sizes.stored != stored || (sizes.unpacked != count * item && sizes.unpacked != padded))
        file.fail("declares the wrong lengths for delayed loading");
    file.skip(stored - blosc_header);
}

void check_delayed_loading(ForwardReader& file, std::uint32_t size) {
    if (size == 0)
        return;
    const std::uint64_t end = file.at() + size;
    const std::uint64_t count = file.number<std::uint32_t>();
    if (count > file.left())
        file.fail("declares more leaves for delayed loading than it can contain");
    check_delayed_items(file, count, sizeof(std::int8_t), file.number<std::uint32_t>());
    constexpr std::uint32_t none = 0xffffffff;
    if (const auto stored = file.number<std::uint32_t>(); stored != none)
        check_delayed_items(file, count, sizeof(std::int64_t), stored);
    file.expect_at(static_cast<std::int64_t>(end));
}

/// What the metadata of a grid says.
struct Facts {
    bool halved = false; ///< whether the grid stores its values as half floats
    std::string grid_class = "unknown";
    std::optional<std::int64_t> active_voxels{};
    std::vector<double> stack{}; ///< see GridEntry
};

Facts read_metadata(ForwardReader& file) {
    Facts facts;
    const auto count = file.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = file.text(), type = file.text();
        const auto size = file.number<std::uint32_t>();
        if (size != bytes_of_type(type, size))
            file.fail(fmt::format("declares {} bytes for metadata of another length", size));
        file.check(size);
        if (name == "is_saved_as_half_float") {
            // OpenVDB treats a value of any other type as true.
            const auto flag = type == "bool" ? file.number<std::uint8_t>() : 2;
            if (flag > 1)
                file.fail("does not say whether its values are half floats");
            facts.halved = flag != 0;
        } else if (name == "class" && type == "string") {
            facts.grid_class = file.bytes(size);
        } else if (name == "file_voxel_count" && type == "int64") {
            facts.active_voxels = file.number<std::int64_t>();
        } else if ((name.starts_with("alcove:center_") || name == "alcove:diagonal") && type == "double") {
            facts.stack.push_back(file.number<double>());
        } else if (type == "__delayedload") {
            check_delayed_loading(file, size);
        } else {
            file.skip(size);
        }
    }
    return facts;
}

/// How the values of a grid are stored.
struct Storage {
    bool zip, active_only, blosc;
    std::size_t value;  ///< bytes of a float or a double
    std::size_t stored; ///< bytes of a stored value: the same, or those of a half float
};

/// Checks that zipped values can be unpacked completely: OpenVDB accepts partly unpacked data, and ignores the
/// checksum.
void check_zipped(ForwardReader& file, std::size_t size, std::size_t stored) {
    const std::string packed = file.bytes(size);
    std::vector<Bytef> values(stored);
    uLongf unpacked = stored;
    if (uncompress(values.data(), &unpacked, reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
        unpacked != stored)
        file.fail("contains values that cannot be decompressed");
}

/// Checks the values of a node: OpenVDB reads the declared number of bytes into a buffer for the expected number.
void check_values(ForwardReader& file, std::size_t count, std::size_t active, std::size_t mask_bytes,
                  const Storage& storage) {
    enum { one_inactive = 2, mask_and_none = 3, mask_and_one = 4, mask_and_two = 5, all_values = 6 };
    const unsigned kind = file.number<std::uint8_t>();
    if (kind > all_values)
        file.fail(fmt::format("has a node with values of the invalid kind {}", kind));
    if (kind == one_inactive || kind == mask_and_one || kind == mask_and_two)
        file.skip(storage.value);
    if (kind == mask_and_two)
        file.skip(storage.value);
    if (kind == mask_and_none || kind == mask_and_one || kind == mask_and_two)
        file.skip(mask_bytes);
    const std::size_t stored = storage.stored * (storage.active_only && kind != all_values ? active : count);
    const bool is_left_out = storage.stored < storage.value && stored == 0; // then the length is not stored either
    if (is_left_out || (!storage.blosc && !storage.zip)) {
        file.skip(stored);
        return;
    }
    // 0 or negative if the values are not compressed.
    const auto declared = file.number<std::int64_t>();
    // Negated as an unsigned number, because the negative of the smallest signed number is out of range.
    const auto size = declared <= 0 ? 0 - static_cast<std::uint64_t>(declared) : static_cast<std::uint64_t>(declared);
    file.check(size);
    if (declared <= 0) {
        if (size != stored)
            file.fail(fmt::format("declares {} bytes for values that take {}", size, stored));
        file.skip(size);
    } else if (storage.blosc) {
        if (size < blosc_header)
            file.fail(fmt::format("declares {} bytes for values that take more", size));
        if (const BloscSizes sizes = blosc_sizes(file); sizes.unpacked != stored || sizes.stored != size)
            file.fail(fmt::format("declares {} unpacked bytes for values that take {}", sizes.unpacked, stored));
        file.skip(size - blosc_header);
    } else {
        check_zipped(file, size, stored);
    }
}

using Mask = std::vector<std::uint64_t>;
constexpr std::size_t leaf_voxels = 512;

Mask read_mask(ForwardReader& file, std::size_t bits) {
    Mask mask(bits / 64);
    file.read(mask.data(), mask.size());
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

/// The masks of active voxels of all leaves of a tree, for comparison with their second copies, and the memory of the
/// tree in bytes.
struct TreeSize {
    std::vector<std::uint64_t> leaves;
    std::size_t bytes = 0;
};

/// Checks an internal node of (1 << log2)³ children, recursively.
void check_node(ForwardReader& file, int log2, const Storage& storage, TreeSize& size) {
    const std::size_t count = std::size_t{1} << (3 * log2);
    const Mask children = read_mask(file, count), active = read_mask(file, count);
    if (!disjoint(children, active)) // OpenVDB would use a pointer as a value
        file.fail("marks a child node as a value");
    check_values(file, count, set_bits(active), count / 8, storage);
    size.bytes += count * (sizeof(double) + 2.0 / 8.0);
    for (std::size_t child = set_bits(children); child > 0; --child)
        if (log2 == 5) {
            check_node(file, 4, storage, size);
        } else {
            const Mask mask = read_mask(file, leaf_voxels);
            size.leaves.insert(size.leaves.end(), mask.begin(), mask.end());
            size.bytes +=
                leaf_voxels * (storage.value == sizeof(float) ? sizeof(float) : sizeof(float) + sizeof(double));
        }
}

/// Checks that the tiles and nodes below the root have distinct, valid origins.
class Origins {
  public:
    void read(ForwardReader& file) {
        std::array<std::int32_t, 3> origin{};
        file.read(origin.data(), origin.size());
        for (const std::int32_t coordinate : origin)
            if (coordinate % edge != 0)
                file.fail("has a node at an invalid origin");
        if (!seen_.insert(origin).second)
            file.fail("has two nodes at the same origin");
    }

  private:
    static constexpr std::int32_t edge = 4096;
    std::set<std::array<std::int32_t, 3>> seen_;
};

/// Checks a tree: its nodes, then the values of its leaves from the offset `values` on. \return its bytes in memory.
std::size_t check_tree(ForwardReader& file, const Storage& storage, std::int64_t values, bool has_offsets) {
    if (file.number<std::int32_t>() != 1)
        file.fail("declares a number of buffers other than one");
    file.skip(storage.value); // background
    const auto tiles = file.number<std::uint32_t>(), children = file.number<std::uint32_t>();
    Origins origins;
    for (std::uint32_t tile = 0; tile < tiles; ++tile) {
        origins.read(file);
        file.skip(storage.value);
        if (file.number<std::uint8_t>() > 1)
            file.fail("does not say whether a tile is active");
    }
    TreeSize size;
    for (std::uint32_t child = 0; child < children; ++child) {
        origins.read(file);
        check_node(file, 5, storage, size);
    }
    if (has_offsets)
        file.expect_at(values);
    constexpr std::size_t words = leaf_voxels / 64;
    for (auto leaf = size.leaves.begin(); leaf != size.leaves.end(); leaf += words) {
        const Mask active = read_mask(file, leaf_voxels);
        if (!std::equal(active.begin(), active.end(), leaf)) // the mask is stored twice
            file.fail("has a leaf with two different masks of active voxels");
        check_values(file, leaf_voxels, set_bits(active), leaf_voxels / 8, storage);
    }
    return size.bytes;
}

/// Checks that a scale agrees with the derived values that are stored with it.
void check_scale(ForwardReader& file) {
    std::array<std::array<double, 3>, 5> scale{};
    file.read(scale.data(), scale.size());
    const auto alike = [](double a, double b) { return std::fabs(a - b) <= 1e-14 * std::fabs(b); };
    const auto& [edge, size, inverse, inverse_square, half_inverse] = scale;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!alike(size[axis], std::fabs(edge[axis])) || !alike(inverse[axis], 1.0 / edge[axis]) ||
            !alike(inverse_square[axis], inverse[axis] * inverse[axis]) ||
            !alike(half_inverse[axis], 0.5 * inverse[axis]))
            file.fail("contains an inconsistent transform");
}

/// Checks a transform. \return whether it is linear; the other kind is a frustum.
bool check_transform(ForwardReader& file) {
    constexpr std::uint64_t vector = 3 * sizeof(double), matrix = 16 * sizeof(double);
    const std::string type = file.text();
    if (type == "NonlinearFrustumMap") {
        file.skip(2 * vector + 2 * sizeof(double)); // its box, taper and depth
        check_transform(file);
        return false;
    }
    if (type == "UniformScaleMap" || type == "ScaleMap") {
        check_scale(file);
    } else if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") {
        file.skip(vector);
        check_scale(file);
    } else if (type == "TranslationMap") {
        file.skip(vector);
    } else if (type == "AffineMap" || type == "UnitaryMap") {
        file.skip(matrix);
    } else {
        file.fail(fmt::format("contains a grid with a transform of type {}", type),
                  "resample it to a linear transform");
    }
    return true;
}

/// "name\x1e1" as OpenVDB shows it: "name[1]".
std::string shown(const std::string& unique_name) {
    constexpr char separator = 30;
    const std::size_t at = unique_name.rfind(separator);
    return at == std::string::npos ? unique_name
                                   : fmt::format("{}[{}]", unique_name.substr(0, at), unique_name.substr(at + 1));
}

/// The type of the values, from the type name of a tree: "float" from "Tree_float_5_4_3_HalfFloat". The result includes
/// the levels of the tree if they are not 5, 4 and 3.
std::string value_type(std::string type) {
    for (const std::string_view end : {"_HalfFloat", "_5_4_3"})
        if (type.ends_with(end))
            type.resize(type.size() - end.size());
    constexpr std::string_view begin = "Tree_";
    return type.starts_with(begin) ? type.substr(begin.size()) : type;
}

GridEntry check_grid(ForwardReader& file, bool has_offsets) {
    GridEntry entry;
    const std::string name = file.text(), type = file.text();
    entry.parent = file.text();
    entry.unique_name = name;
    const auto begin = file.number<std::int64_t>(), values = file.number<std::int64_t>();
    entry.end = file.number<std::int64_t>();
    entry.grid.name = shown(name);
    entry.grid.type = value_type(type);
    const bool halved = type.ends_with("_HalfFloat");
    const bool is_read = entry.grid.type == "float" || entry.grid.type == "double";
    if (!is_read && !has_offsets)
        file.fail(fmt::format("is a stream that contains a grid of type {} without its length", type),
                  "write it as a file");
    if (has_offsets)
        file.expect_at(begin);
    const auto compression = file.number<std::uint32_t>();
    const Facts facts = read_metadata(file);
    entry.grid.grid_class = facts.grid_class;
    entry.grid.active_voxels = facts.active_voxels;
    entry.stack = facts.stack;
    if (!is_read) {
        file.go_to(entry.end);
        return entry;
    }
    if (facts.halved != halved)
        file.fail("says both that its values are half floats and that they are not");
    entry.is_linear = check_transform(file);
    if (entry.parent.empty()) {
        const std::size_t value = entry.grid.type == "float" ? sizeof(float) : sizeof(double);
        entry.bytes = check_tree(file,
                                 {(compression & 1) != 0, (compression & 2) != 0, (compression & 4) != 0, value,
                                  halved ? sizeof(float) / 2 : value},
                                 values, has_offsets);
    }
    if (has_offsets)
        file.expect_at(entry.end);
    return entry;
}

}

VdbStructure check_vdb_structure(const std::filesystem::path& path) {
    ForwardReader file(path);
    if (file.left() < sizeof(magic) || file.number<std::int64_t>() != magic)
        file.fail("is not a .vdb file", "check the name");
    if (file.number<std::uint32_t>() < oldest_version)
        file.fail("was written by a version of OpenVDB before 2013", "write it again with a newer one");
    file.skip(2 * sizeof(std::uint32_t)); // the library's version
    VdbStructure structure;
    structure.has_offsets = file.number<char>() != 0;
    constexpr std::uint64_t uuid = 36;
    file.skip(uuid);
    read_metadata(file);
    const auto grids = file.number<std::int32_t>();
    for (std::int32_t i = 0; i < grids; ++i)
        structure.grids.push_back(check_grid(file, structure.has_offsets));
    if (file.left() > 0)
        file.fail(fmt::format("has {} bytes after its last grid", file.left()));
    return structure;
}

}
