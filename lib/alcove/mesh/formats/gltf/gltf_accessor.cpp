#include "alcove/mesh/formats/gltf/gltf_accessor.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace alcove {
namespace {

enum ComponentType : std::size_t { int8 = 5120, uint8, int16, uint16, uint32 = 5125, float32 };

std::size_t size_of(const GltfValue& component_type) {
    switch (component_type.count()) {
    case int8:
    case uint8:
        return 1;
    case int16:
    case uint16:
        return 2;
    case uint32:
    case float32:
        return 4;
    default:
        component_type.fail("is not a component type of glTF; export the file again");
    }
}

int components_of(const GltfValue& type) {
    constexpr std::array<std::pair<std::string_view, int>, 4> known{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}}};
    for (const auto& [name, components] : known)
        if (type.text() == name)
            return components;
    type.fail(fmt::format("is {}, which does not fit here; export the file again", in_quotes(type.text())));
}

template <class From, class To>
To converted(From value, bool normalized) {
    if constexpr (std::is_floating_point_v<To> && std::is_integral_v<From>)
        if (normalized)
            return std::max(static_cast<To>(value) / static_cast<To>(std::numeric_limits<From>::max()), To(-1));
    return static_cast<To>(value);
}

template <class From, class To>
void copy(const char* from, std::size_t components, bool normalized, To* to) {
    for (std::size_t c = 0; c < components; ++c) {
        From value;
        std::memcpy(&value, from + c * sizeof(From), sizeof(From));
        to[c] = converted<From, To>(value, normalized);
    }
}

/// Converts elements of `components` values each.
template <class From, class To>
void copy_elements(const char* from, std::size_t stride, std::size_t components, bool normalized, std::span<To> to) {
    if (stride == components * sizeof(From))
        return copy<From>(from, to.size(), normalized, to.data());
    for (std::size_t i = 0; i < to.size(); i += components, from += stride)
        copy<From>(from, components, normalized, to.data() + i);
}

template <class To>
void copy_elements(std::size_t type, const char* from, std::size_t stride, std::size_t components, bool normalized,
                   std::span<To> to) {
    switch (type) {
    case int8:
        return copy_elements<std::int8_t>(from, stride, components, normalized, to);
    case uint8:
        return copy_elements<std::uint8_t>(from, stride, components, normalized, to);
    case int16:
        return copy_elements<std::int16_t>(from, stride, components, normalized, to);
    case uint16:
        return copy_elements<std::uint16_t>(from, stride, components, normalized, to);
    case uint32:
        return copy_elements<std::uint32_t>(from, stride, components, normalized, to);
    default:
        if constexpr (std::is_floating_point_v<To>)
            return copy_elements<float>(from, stride, components, normalized, to);
    }
}

/// Whether `type` is the component type that stores a T.
template <class T>
bool is_same(std::size_t type) {
    return type == (std::is_same_v<T, float> ? float32 : uint32);
}

}

GltfAccessor::GltfAccessor(GltfFile& file, const GltfValue& accessor, int least_components, int most_components)
    : value_(accessor), count_(count_of_accessor(accessor)), components_(components_of(accessor["type"])),
      component_type_(accessor["componentType"].count()) {
    if (components_ < least_components || components_ > most_components)
        accessor["type"].fail(
            fmt::format("is {}, which does not fit here; export the file again", accessor["type"].text()));
    element_size_ = size_of(accessor["componentType"]) * static_cast<std::size_t>(components_);
    if (const std::optional<GltfValue> normalized = accessor.find("normalized"))
        normalized_ = normalized->flag();
    if (accessor.has("bufferView"))
        dense_ = elements(file, accessor, count_, element_size_, true);
    if (const std::optional<GltfValue> sparse = accessor.find("sparse")) {
        const GltfValue indices = (*sparse)["indices"];
        const std::size_t count = (*sparse)["count"].count(), type = indices["componentType"].count();
        const Elements at = elements(file, indices, count, size_of(indices["componentType"]), false);
        sparse_ = elements(file, (*sparse)["values"], count, element_size_, false);
        sparse_at_.resize(count);
        copy_elements(type, at.bytes.read(buffer_).data(), at.stride, 1, false, std::span(sparse_at_));
        for (std::size_t i = 0; i < count; ++i)
            if (sparse_at_[i] >= count_)
                indices.fail(fmt::format("element {} is {}, but the accessor has {} elements; export the file again", i,
                                         sparse_at_[i], count_));
    }
}

GltfAccessor::Elements GltfAccessor::elements(GltfFile& file, const GltfValue& source, std::size_t count,
                                              std::size_t element_size, bool may_be_interleaved) const {
    const GltfValue view = source["bufferView"].target(file.root(), "bufferViews");
    const FilePart bytes = file.view(view);
    const std::size_t stride = may_be_interleaved ? view.count_or("byteStride", element_size) : element_size;
    const std::size_t offset = source.count_or("byteOffset", 0);
    if (stride < element_size)
        view.fail(fmt::format("byteStride is {}, less than an element of {} bytes; export the file again", stride,
                              element_size));
    if (count > 0 && (offset > bytes.size() || bytes.size() - offset < element_size ||
                      (bytes.size() - offset - element_size) / stride < count - 1))
        source.fail(fmt::format("{} elements do not fit its buffer view of {} bytes; copy or export the file again",
                                grouped(count), grouped(bytes.size())));
    return {count > 0 ? bytes.part(offset, (count - 1) * stride + element_size) : FilePart(), stride};
}

template <class T>
void GltfAccessor::decode(const Elements& elements, std::size_t first, std::span<T> to) {
    if (to.empty())
        return;
    const auto components = static_cast<std::size_t>(components_);
    const std::size_t count = to.size() / components;
    const FilePart bytes = elements.bytes.part(first * elements.stride, (count - 1) * elements.stride + element_size_);
    if (is_same<T>(component_type_) && elements.stride == element_size_)
        bytes.read_to(reinterpret_cast<char*>(to.data()));
    else
        copy_elements(component_type_, bytes.read(buffer_).data(), elements.stride, components, normalized_, to);
}

template <class T>
GltfArray<T> GltfAccessor::values() const {
    const auto components = static_cast<std::size_t>(components_);
    const auto decode_dense = [accessor = *this, components](std::size_t first, std::span<T> to) mutable {
        if (accessor.dense_)
            accessor.decode(*accessor.dense_, first / components, to);
        else
            std::fill(to.begin(), to.end(), T(0));
    };
    GltfArray<T> dense(count_ * components, decode_dense);
    if (sparse_at_.empty())
        return dense;
    std::vector<T> all = dense.all(), sparse(sparse_at_.size() * components);
    GltfAccessor(*this).decode(sparse_, 0, std::span(sparse));
    for (std::size_t i = 0; i < sparse_at_.size(); ++i)
        std::copy_n(sparse.data() + i * components, components, all.data() + sparse_at_[i] * components);
    return GltfArray<T>(std::move(all));
}

GltfArray<float> GltfAccessor::floats() const {
    return values<float>();
}

GltfArray<std::uint32_t> GltfAccessor::indices() const {
    if (component_type_ != uint8 && component_type_ != uint16 && component_type_ != uint32)
        value_["componentType"].fail("is not an unsigned integer, as indices are; export the file again");
    return values<std::uint32_t>();
}

std::size_t count_of_accessor(const GltfValue& accessor) {
    const std::size_t count = accessor["count"].count();
    constexpr std::size_t most = std::size_t{1} << 32; // a mesh cannot have more vertices or corners
    if (count > most)
        accessor["count"].fail("exceeds 2^32; export the file again");
    return count;
}

}
