/// The values of a glTF accessor, or of decompressed data.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace alcove {

/// Values in memory, or values that are decoded block by block when they are used. In the second case, the values of a
/// large file need not be in memory at the same time as the mesh that is made from them.
template <class T>
class GltfArray {
  public:
    /// Decodes as many values as `to` holds, from index `first` on. Both `first` and the size of `to` are multiples of
    /// the components per vector.
    using Decode = std::function<void(std::size_t first, std::span<T> to)>;
    /// In values. A multiple of 2, 3 and 4, so that a block has whole vectors or whole triangles. Small enough that
    /// input and output fit in the cache.
    static constexpr std::size_t block_size = std::size_t{12} * 2048;

    GltfArray() = default;
    explicit GltfArray(std::vector<T> values) : size_(values.size()), values_(std::move(values)) {}
    GltfArray(std::size_t size, Decode decode) : size_(size), decode_(std::move(decode)) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }

    void decode(std::size_t first, std::span<T> to) const {
        if (decode_)
            decode_(first, to);
        else
            std::copy_n(values_.data() + first, to.size(), to.begin());
    }
    /// Calls `use` with the span of each block, in order.
    template <class Use>
    void for_each_block(const Use& use) const {
        std::vector<T> decoded(decode_ ? std::min(size_, block_size) : 0);
        for (std::size_t first = 0; first < size_; first += block_size) {
            const std::size_t count = std::min(size_ - first, block_size);
            if (decode_)
                decode(first, std::span(decoded).first(count));
            use(std::span<const T>(decode_ ? decoded.data() : values_.data() + first, count));
        }
    }
    std::vector<T> all() const {
        std::vector<T> values;
        values.reserve(size_);
        for_each_block([&](std::span<const T> block) { values.insert(values.end(), block.begin(), block.end()); });
        return values;
    }
    /// Drops the values from index `size` on.
    void cut(std::size_t size) { size_ = size; }
    /// Decodes all values now and keeps them, for repeated use.
    void keep() {
        if (decode_)
            *this = GltfArray(all());
    }

  private:
    std::size_t size_ = 0;
    std::vector<T> values_;
    Decode decode_; ///< empty: the values are in memory
};

}
