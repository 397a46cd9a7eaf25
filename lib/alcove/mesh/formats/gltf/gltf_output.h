/// A glTF file to be written: its JSON, and data that is appended to its buffers.
#pragma once

#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// The number of times that `key` has the value `value` anywhere in `json`.
std::size_t count_values(const Json& json, std::string_view key, const Json& value);

class GltfOutput {
  public:
    /// An empty file.
    explicit GltfOutput(const std::filesystem::path& target);
    /// A copy of a file. In a .glb, the first buffer becomes the binary chunk if it is the only buffer. If `target` is
    /// in another folder, buffers that are files become part of the output. `file` must outlive this object.
    /// \throw like GltfFile::buffer().
    GltfOutput(const std::filesystem::path& target, GltfFile& file);

    Json& json() { return json_; }
    /// Each function appends an accessor and returns its index.
    std::size_t add_floats(std::span<const float> values, std::size_t components);
    std::size_t add_positions(std::span<const float> values); ///< with their bounds
    std::size_t add_colors(std::span<const std::array<std::uint16_t, 4>> values);
    std::size_t add_indices(std::span<const std::uint32_t> values, std::size_t vertex_count);
    /// Replaces the values of an accessor in place, so that files do not grow with each bake. This needs values of the
    /// same type and size in the buffer that new data is appended to, and a view that no other accessor uses. \return
    /// whether the values were replaced.
    bool overwrite(std::size_t accessor, int component_type, std::string_view bytes);
    /// Appends a PNG with the other properties of `image`, and returns its index in `images`.
    std::size_t add_png(std::string_view bytes, Json image);
    /// Replaces an image. The bytes of the old image are removed if nothing else uses them.
    void replace_png(std::size_t image, std::string_view bytes);

    /// Writes a .glb, or a .gltf with its data embedded. \throw IoError, LimitError beyond 4 GB.
    void write();

    /// Messages about image paths that were rewritten relative to the folder of the target, or that lead to no file.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    void choose_buffer(GltfFile& file);
    void set_data_uri(std::size_t buffer, const FilePart& first, std::string_view second = {});
    std::size_t append(std::string_view bytes); ///< returns the offset
    std::size_t add_view(std::string_view bytes, int target);
    std::size_t add_accessor(Json accessor);
    void take_out(std::size_t view);
    std::string& own_binary();
    void embed_buffers(GltfFile& file);
    void move_images(const std::filesystem::path& from);
    void finish_buffer();

    std::filesystem::path target_;
    bool is_binary_, is_indented_ = false;
    Json json_;
    FilePart chunk_, other_chunks_; ///< of the input file
    std::size_t buffer_ = 0;        ///< index of the buffer to which new data is appended
    bool in_chunk_;                 ///< whether this buffer is the binary chunk
    FilePart binary_;               ///< the contents that the buffer already has
    bool is_rewritten_ = false;     ///< whether binary_ refers to the changed copy
    std::string rewritten_;         ///< the changed copy
    std::string added_;             ///< new data, after binary_ and padding to a multiple of 4
    std::vector<std::string> warnings_;
};

}
