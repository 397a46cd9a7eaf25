/// A glTF file: its JSON, its buffers and its buffer views.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/formats/gltf/gltf_value.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

class GltfFile {
  public:
    /// Parses a .glb, or a .gltf. \throw InputError if it is damaged or nested more than 200 levels deep.
    explicit GltfFile(const FileBytes& bytes);

    GltfValue root() const { return {bytes_, json_, ""}; }
    const FileBytes& bytes() const { return bytes_; }
    bool is_binary() const { return is_binary_; }
    /// The bytes of the binary chunk, without padding if buffers[0] gives its length; empty if there is no such chunk.
    FilePart binary_chunk() const { return binary_chunk_; }
    bool has_binary_chunk() const { return has_binary_chunk_; }
    /// Chunks after the binary one, with their headers.
    FilePart other_chunks() const { return other_chunks_; }
    bool is_indented() const; ///< whether the JSON has line breaks

    /// The bytes of an element of `buffers`, loaded at the first use. \throw InputError if they are missing, are too
    /// few or lie outside the folder of the file.
    FilePart buffer(const GltfValue& buffer);
    /// The bytes of an element of `bufferViews`, decompressed at the first use.
    FilePart view(const GltfValue& view);
    /// The bytes of an element of `images`. \throw like buffer()
    FilePart image(const GltfValue& image);

  private:
    void parse_chunks();
    std::uint32_t number_at(std::size_t place, const char* expected) const;
    void parse_json(std::string_view text);
    void check_json(std::string_view text) const;
    FilePart bytes_of_uri(const GltfValue& holder);

    FileBytes bytes_;
    Json json_;
    bool is_binary_ = false, has_binary_chunk_ = false;
    std::string_view json_text_;
    FilePart binary_chunk_, other_chunks_;
    std::recursive_mutex mutex_;             ///< protects the members below, which are filled at their first use
    std::map<std::string, FileBytes> files_; ///< contents of URIs: files by URI, data URIs by place in the JSON
    std::map<std::string, std::string> decompressed_;
    double decompressed_bytes_ = 0.0;
};

}
