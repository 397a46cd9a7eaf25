/// Reads the values of glTF accessors of any component type, including interleaved, normalized and sparse ones.
#pragma once

#include "alcove/mesh/formats/gltf/gltf_array.h"
#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alcove {

/// An element of `accessors`, checked against its buffer view.
class GltfAccessor {
  public:
    /// \throw InputError if the accessor is damaged or does not fit its buffer view, or if its number of components is
    /// not from `least_components` to `most_components`.
    GltfAccessor(GltfFile& file, const GltfValue& accessor, int least_components, int most_components);

    std::size_t count() const { return count_; }
    int components() const { return components_; }
    /// All components as floats; normalized integers become numbers in [0, 1] or [-1, 1]. The file must outlive the
    /// result.
    GltfArray<float> floats() const;
    /// The values of an accessor with one component. \throw InputError if they are not unsigned integers.
    GltfArray<std::uint32_t> indices() const;

  private:
    /// Elements that begin `stride` bytes apart.
    struct Elements {
        FilePart bytes;
        std::size_t stride = 0;
    };
    Elements elements(GltfFile& file, const GltfValue& source, std::size_t count, std::size_t element_size,
                      bool may_be_interleaved) const;
    template <class T>
    GltfArray<T> values() const;
    template <class T>
    void decode(const Elements& elements, std::size_t first, std::span<T> to);

    GltfValue value_;
    std::size_t count_;
    int components_ = 1;
    std::size_t component_type_, element_size_;
    bool normalized_ = false;
    std::optional<Elements> dense_; ///< empty: all values are zero
    std::vector<std::uint32_t> sparse_at_;
    Elements sparse_;
    std::string buffer_; ///< for elements read from the disk
};

/// The count of an accessor. \throw InputError if it is not a whole number or exceeds 2^32.
std::size_t count_of_accessor(const GltfValue& accessor);

}
