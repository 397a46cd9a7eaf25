/// A value in the JSON of a glTF file together with its location, so that errors can name the location.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"

#include <nlohmann/json.hpp>

#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace alcove {

using Json = nlohmann::ordered_json; // keeps the order of the keys when it is written

class GltfValue {
  public:
    GltfValue(const FileBytes& file, const Json& json, std::string place)
        : file_(&file), json_(&json), place_(std::move(place)) {}

    const Json& json() const { return *json_; }
    const std::string& place() const { return place_; } ///< "meshes[3].primitives[0]"
    /// \throw InputError "file: place: message"
    [[noreturn]] void fail(std::string_view message) const;

    // Except has(), each function calls fail() if the value has the wrong type. operator[], element() and target() also
    // call fail() if the value that they return is missing.
    bool has(const char* key) const { return json_->is_object() && json_->contains(key); }
    GltfValue operator[](const char* key) const;
    std::optional<GltfValue> find(const char* key) const;
    template <std::integral I>
    GltfValue operator[](I i) const {
        return element(static_cast<std::size_t>(i));
    }
    GltfValue element(std::size_t i) const; ///< of an array
    std::size_t size() const;               ///< of an array
    std::size_t count() const;              ///< a whole number below 2^48
    std::size_t index(std::size_t limit) const;
    double number() const;
    bool flag() const;
    const std::string& text() const;
    /// The value of a key, or `missing` if there is none.
    std::size_t count_or(const char* key, std::size_t missing) const;
    std::string text_or(const char* key, std::string_view missing) const;
    /// The element of the root's array `array` to which this value, an index, refers.
    GltfValue target(const GltfValue& root, const char* array) const;

  private:
    const FileBytes* file_;
    const Json* json_;
    std::string place_;
};

}
