#include "alcove/mesh/formats/gltf/gltf_accessor.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace alcove {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is read without swapping bytes");

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

template <class To>
void copy_element(const char* from, std::size_t type, std::size_t components, bool normalized, To* to) {
    switch (type) {
    case int8:
        return copy<std::int8_t>(from, components, normalized, to);
    case uint8:
        return copy<std::uint8_t>(from, components, normalized, to);
    case int16:
        return copy<std::int16_t>(from, components, normalized, to);
    case uint16:
        return copy<std::uint16_t>(from, components, normalized, to);
    case uint32:
        return copy<std::uint32_t>(from, components, normalized, to);
    default:
        if constexpr (std::is_floating_point_v<To>)
            return copy<float>(from, components, normalized, to);
    }
}

}

GltfAccessor::GltfAccessor(GltfFile& file, const GltfValue& accessor, int least_components, int most_components)
    : value_(accessor), count_(count_of_accessor(accessor)), components_(components_of(accessor["type"])),
      component_type_(accessor["componentType"].count()) {
    if (components_ < least_components || components_ > most_components)
        accessor["type"].fail(
            fmt::format("is {}, which does not fit here; export the file again", accessor["type"].text()));
    const std::size_t size = size_of(accessor["componentType"]) * static_cast<std::size_t>(components_);
    if (const std::optional<GltfValue> normalized = accessor.find("normalized"))
        normalized_ = normalized->flag();
    if (accessor.has("bufferView"))
        dense_ = elements(file, accessor, count_, size, true);
    if (const std::optional<GltfValue> sparse = accessor.find("sparse")) {
        const GltfValue indices = (*sparse)["indices"];
        const std::size_t count = (*sparse)["count"].count(), type = indices["componentType"].count();
        const Elements at = elements(file, indices, count, size_of(indices["componentType"]), false);
        sparse_ = elements(file, (*sparse)["values"], count, size, false);
        sparse_at_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            copy_element(at.begin + i * at.stride, type, 1, false, &sparse_at_[i]);
            if (sparse_at_[i] >= count_)
                indices.fail(fmt::format("element {} is {}, but the accessor has {} elements; export the file again", i,
                                         sparse_at_[i], count_));
        }
    }
}

GltfAccessor::Elements GltfAccessor::elements(GltfFile& file, const GltfValue& source, std::size_t count,
                                              std::size_t element_size, bool may_be_interleaved) const {
    const GltfValue view = source["bufferView"].target(file.root(), "bufferViews");
    const std::string_view bytes = file.view(view);
    const std::size_t stride = may_be_interleaved ? view.count_or("byteStride", element_size) : element_size;
    const std::size_t offset = source.count_or("byteOffset", 0);
    if (stride < element_size)
        view.fail(fmt::format("byteStride is {}, less than an element of {} bytes; export the file again", stride,
                              element_size));
    if (count > 0 && (offset > bytes.size() || bytes.size() - offset < element_size ||
                      (bytes.size() - offset - element_size) / stride < count - 1))
        source.fail(fmt::format("{} elements do not fit its buffer view of {} bytes; copy or export the file again",
                                grouped(count), grouped(bytes.size())));
    return {bytes.data() + (count > 0 ? offset : 0), stride};
}

template <class T>
std::vector<T> GltfAccessor::values() const {
    const auto components = static_cast<std::size_t>(components_);
    std::vector<T> values(count_ * components);
    if (dense_.begin != nullptr && std::is_same_v<T, float> && component_type_ == float32 &&
        dense_.stride == components * sizeof(float)) {
        if (!values.empty())
            std::memcpy(values.data(), dense_.begin, values.size() * sizeof(T));
    } else if (dense_.begin != nullptr) {
        for (std::size_t i = 0; i < count_; ++i)
            copy_element(dense_.begin + i * dense_.stride, component_type_, components, normalized_,
                         values.data() + i * components);
    }
    for (std::size_t i = 0; i < sparse_at_.size(); ++i)
        copy_element(sparse_.begin + i * sparse_.stride, component_type_, components, normalized_,
                     values.data() + sparse_at_[i] * components);
    return values;
}

std::vector<float> GltfAccessor::floats() const {
    return values<float>();
}

std::vector<std::uint32_t> GltfAccessor::indices() const {
    if (component_type_ != uint8 && component_type_ != uint16 && component_type_ != uint32)
        value_["componentType"].fail("is not an unsigned integer, as indices are; export the file again");
    return values<std::uint32_t>();
}

std::size_t count_of_accessor(const GltfValue& accessor) {
    const std::size_t count = accessor["count"].count();
    constexpr std::size_t most = std::size_t{1} << 32; // a mesh has no more vertices or corners
    if (count > most)
        accessor["count"].fail("exceeds 2^32; export the file again");
    return count;
}

}
