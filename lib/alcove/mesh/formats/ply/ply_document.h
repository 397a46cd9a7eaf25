/// The contents of a PLY file: every comment, element, property and value, in the layout of the binary format (Turk
/// 1994).
#pragma once

#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/mesh.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

inline std::size_t size_of(PlyType type) {
    constexpr std::array<std::uint8_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}
std::string_view name_of(PlyType type);                       ///< "char", "uchar", ... "double"
std::optional<PlyType> ply_type_named(std::string_view name); ///< also "int8", "uint8", ... "float64"
inline bool is_integral(PlyType type) {
    return type < PlyType::float32;
}

template <class T>
T value_at(const std::byte* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// The little-endian value of an integral type at `bytes`, which need not be aligned.
inline std::int64_t integer_at(const std::byte* bytes, PlyType type) {
    switch (type) {
    case PlyType::int8:
        return value_at<std::int8_t>(bytes);
    case PlyType::uint8:
        return value_at<std::uint8_t>(bytes);
    case PlyType::int16:
        return value_at<std::int16_t>(bytes);
    case PlyType::uint16:
        return value_at<std::uint16_t>(bytes);
    case PlyType::uint32:
        return value_at<std::uint32_t>(bytes);
    default:
        return value_at<std::int32_t>(bytes);
    }
}

/// The little-endian value at `bytes`, which need not be aligned.
inline double number_at(const std::byte* bytes, PlyType type) {
    switch (type) {
    case PlyType::float32:
        return value_at<float>(bytes);
    case PlyType::float64:
        return value_at<double>(bytes);
    default:
        return static_cast<double>(integer_at(bytes, type));
    }
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type; ///< set for a list: the type of its count, which precedes the items
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
    /// All rows, packed and little endian, in memory that `keeper` owns.
    std::span<const std::byte> rows{};
    std::shared_ptr<const void> keeper{};

    /// Sets the rows. This element and its copies share the memory.
    void keep(std::vector<std::byte> new_rows);
    const PlyProperty* find(std::string_view property) const;
    bool has_lists() const;
    std::size_t smallest_row() const; ///< size in bytes of a row with empty lists
};

/// The size in bytes of the value, or the list with its count, at `bytes`.
inline std::size_t stored_size(const PlyProperty& property, const std::byte* bytes) {
    if (!property.count_type)
        return size_of(property.type);
    return size_of(*property.count_type) +
           static_cast<std::size_t>(integer_at(bytes, *property.count_type)) * size_of(property.type);
}

class PlyDocument : public SourceDocument {
  public:
    std::vector<std::string> comments; ///< whole lines, "comment ..." or "obj_info ...", in file order
    std::vector<PlyElement> elements;

    const PlyElement* find(std::string_view element) const;
    bool has_vertex_property(std::string_view name) const override;
    std::string_view comment(std::string_view beginning) const override;
    std::vector<std::string> contents() const override;
};

/// Calls f(row, bytes of the property) for all rows.
template <class F>
void for_each_value(const PlyElement& element, const PlyProperty& wanted, F&& f) {
    if (element.count == 0)
        return; // the pointer may be null
    const std::byte* at = element.rows.data();
    if (!element.has_lists()) {
        const std::size_t stride = element.smallest_row();
        for (const PlyProperty* p = element.properties.data(); p != &wanted; ++p)
            at += size_of(p->type);
        for (std::size_t row = 0; row < element.count; ++row, at += stride)
            f(row, at);
        return;
    }
    for (std::size_t row = 0; row < element.count; ++row)
        for (const PlyProperty& property : element.properties) {
            if (&property == &wanted)
                f(row, at);
            at += stored_size(property, at);
        }
}

/// The list of vertex indices of faces or strips; null if there is none.
const PlyProperty* corner_list(const PlyElement& element);

/// The element `face` of a mesh: vertex_indices, and texcoord, red green blue alpha if the mesh has them.
PlyElement face_element(const Mesh& mesh);

/// A document for a mesh that was not read from a PLY file. Its elements are face_element() and `vertex`, with x y z,
/// and with nx ny nz, s t, red green blue alpha if the mesh has them.
/// Coordinates are float, or double if float would move a vertex by more than 1e-6 of the diagonal.
PlyDocument make_ply_document(const Mesh& mesh);

}
