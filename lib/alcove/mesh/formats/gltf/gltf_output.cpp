#include "alcove/mesh/formats/gltf/gltf_output.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/file_kind.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/formats/gltf/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <system_error>

namespace alcove {
namespace {

namespace fs = std::filesystem;

constexpr int array_buffer = 34962, element_array_buffer = 34963, no_target = 0;
constexpr int uint16 = 5123, uint32 = 5125, float32 = 5126;
constexpr const char* octets = "application/octet-stream";

std::size_t padded(std::size_t size) {
    return (size + 3) / 4 * 4;
}

std::string padding(std::size_t size, char c) {
    return std::string(padded(size) - size, c);
}

bool is_glb(const fs::path& file) {
    return lower_extension(file) == ".glb";
}

std::string little_endian(std::uint32_t number) {
    return std::string(reinterpret_cast<const char*>(&number), sizeof(number));
}

template <class T>
std::string_view bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

bool same_folder(const fs::path& a, const fs::path& b) {
    std::error_code ignored;
    return fs::equivalent(a.empty() ? "." : a, b.empty() ? "." : b, ignored);
}

}

GltfOutput::GltfOutput(const fs::path& target) : target_(target), is_binary_(is_glb(target)) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Alcove " ALCOVE_VERSION}};
}

GltfOutput::GltfOutput(const fs::path& target, GltfFile& file)
    : target_(target), is_binary_(is_glb(target)), is_indented_(file.is_indented()), json_(file.root().json()),
      binary_(file.binary_chunk()), other_chunks_(is_binary_ ? file.other_chunks() : std::string_view()) {
    const std::size_t buffers = json_.contains("buffers") ? json_["buffers"].size() : 0;
    if (is_binary_ && !file.has_binary_chunk() && buffers == 1) {
        binary_ = file.buffer(file.root()["buffers"][0]);
        json_["buffers"][0].erase("uri");
    } else if (buffers > 0 && (!file.has_binary_chunk() || json_["buffers"][0].contains("uri"))) {
        appends_to_binary_ = false;
    }
    if (!is_binary_ && file.has_binary_chunk())
        appends_to_binary_ = false;
    if (!same_folder(file.bytes().path().parent_path(), target.parent_path())) {
        embed_buffers(file);
        move_images(file.bytes().path().parent_path());
    }
}

void GltfOutput::embed_buffers(GltfFile& file) {
    for (std::size_t b = 0; json_.contains("buffers") && b < json_["buffers"].size(); ++b) {
        Json& buffer = json_["buffers"][b];
        if (buffer.contains("uri") && !is_data_uri(buffer["uri"].get_ref<const std::string&>()))
            buffer["uri"] = data_uri(octets, file.buffer(file.root()["buffers"][b]));
    }
}

void GltfOutput::move_images(const fs::path& from) {
    std::size_t moved = 0, lost = 0;
    for (std::size_t i = 0; json_.contains("images") && i < json_["images"].size(); ++i) {
        Json& image = json_["images"][i];
        if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string() ||
            is_data_uri(image["uri"].get_ref<const std::string&>()))
            continue;
        const std::optional<fs::path> path = path_of_uri(image["uri"].get_ref<const std::string&>());
        std::error_code error;
        if (!path || !fs::is_regular_file(from / *path, error)) {
            ++lost;
            continue;
        }
        const fs::path to = fs::weakly_canonical(target_.parent_path().empty() ? "." : target_.parent_path(), error);
        image["uri"] = uri_of_path(fs::weakly_canonical(from / *path, error).lexically_relative(to));
        ++moved;
    }
    if (moved > 0)
        warnings_.push_back(counted(moved, "image path was", "image paths were") +
                            " rewritten relative to the output folder");
    if (lost > 0)
        warnings_.push_back(counted(lost, "image path was", "image paths were") +
                            " kept, but no such file was found relative to the input folder");
}

std::size_t GltfOutput::add_view(std::string_view bytes, int target) {
    added_ += padding(added_.size(), '\0');
    const std::size_t offset = (appends_to_binary_ ? padded(binary_.size()) : 0) + added_.size();
    added_ += bytes;
    const std::size_t buffers = json_.contains("buffers") ? json_["buffers"].size() : 0;
    Json view{{"buffer", appends_to_binary_ ? 0 : buffers}, {"byteOffset", offset}, {"byteLength", bytes.size()}};
    if (target != no_target)
        view["target"] = target;
    json_["bufferViews"].push_back(std::move(view));
    return json_["bufferViews"].size() - 1;
}

std::size_t GltfOutput::add_accessor(Json accessor) {
    json_["accessors"].push_back(std::move(accessor));
    return json_["accessors"].size() - 1;
}

std::size_t GltfOutput::add_floats(std::span<const float> values, std::size_t components) {
    constexpr std::array<const char*, 4> types{"SCALAR", "VEC2", "VEC3", "VEC4"};
    return add_accessor({{"bufferView", add_view(bytes_of(values), array_buffer)},
                         {"componentType", float32},
                         {"count", values.size() / components},
                         {"type", types[components - 1]}});
}

std::size_t GltfOutput::add_positions(std::span<const float> values) {
    const std::size_t accessor = add_floats(values, 3);
    std::array<float, 3> least, most;
    least.fill(std::numeric_limits<float>::max());
    most.fill(std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < values.size(); ++i) {
        least[i % 3] = std::min(least[i % 3], values[i]);
        most[i % 3] = std::max(most[i % 3], values[i]);
    }
    json_["accessors"][accessor]["min"] = least;
    json_["accessors"][accessor]["max"] = most;
    return accessor;
}

std::size_t GltfOutput::add_colors(std::span<const std::array<std::uint16_t, 4>> values) {
    return add_accessor({{"bufferView", add_view(bytes_of(values), array_buffer)},
                         {"componentType", uint16},
                         {"normalized", true},
                         {"count", values.size()},
                         {"type", "VEC4"}});
}

std::size_t GltfOutput::add_indices(std::span<const std::uint32_t> values, std::size_t vertex_count) {
    constexpr std::size_t restart = 0xffff; // not allowed as an index of 16 bits
    const bool is_short = vertex_count <= restart;
    const std::vector<std::uint16_t> shorts(is_short ? values.begin() : values.end(), values.end());
    const std::string_view bytes = is_short ? bytes_of(std::span(shorts)) : bytes_of(values);
    return add_accessor({{"bufferView", add_view(bytes, element_array_buffer)},
                         {"componentType", is_short ? uint16 : uint32},
                         {"count", values.size()},
                         {"type", "SCALAR"}});
}

std::size_t GltfOutput::add_png(std::string_view bytes, const std::string& name) {
    const std::size_t view = add_view(bytes, no_target); // may move the arrays of the root
    json_["images"].push_back({{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
    return json_["images"].size() - 1;
}

bool GltfOutput::overwrite(std::size_t accessor, int component_type, std::string_view bytes) {
    if (!appends_to_binary_ || binary_.empty() || accessor >= json_["accessors"].size())
        return false;
    const Json& old = json_["accessors"][accessor];
    if (!old.contains("bufferView") || old.contains("sparse") || old.value("byteOffset", 0) != 0 ||
        old["componentType"] != component_type)
        return false;
    const auto users = std::count_if(json_["accessors"].begin(), json_["accessors"].end(), [&](const Json& other) {
        return other.contains("bufferView") && other["bufferView"] == old["bufferView"];
    });
    const Json& view = json_["bufferViews"][old["bufferView"].get<std::size_t>()];
    const std::size_t offset = view.value("byteOffset", std::size_t(0));
    if (users != 1 || view["buffer"] != 0 || view["byteLength"] != bytes.size() || view.contains("byteStride") ||
        view.contains("extensions") || offset > binary_.size() || bytes.size() > binary_.size() - offset)
        return false;
    if (rewritten_.empty())
        rewritten_ = binary_;
    binary_ = rewritten_;
    std::copy(bytes.begin(), bytes.end(), rewritten_.begin() + static_cast<std::ptrdiff_t>(offset));
    return true;
}

/// Gives the buffers their final lengths and, in a .gltf, their data.
void GltfOutput::finish_buffers() {
    if (!added_.empty()) {
        const std::size_t length = (appends_to_binary_ ? padded(binary_.size()) : 0) + added_.size();
        if (!appends_to_binary_)
            json_["buffers"].push_back({{"uri", data_uri(octets, added_)}, {"byteLength", length}});
        else if (json_.contains("buffers"))
            json_["buffers"][0]["byteLength"] = length;
        else
            json_["buffers"].push_back({{"byteLength", length}});
    }
    if (!is_binary_ && json_.contains("buffers") && !json_["buffers"][0].contains("uri")) {
        Json buffer; // with the URI first, as is usual
        const bool grows = appends_to_binary_ && !added_.empty();
        const std::string_view old = grows ? binary_ : binary_.substr(0, json_["buffers"][0]["byteLength"]);
        buffer["uri"] = data_uri(octets, old, grows ? padding(binary_.size(), '\0') + added_ : "");
        buffer.update(json_["buffers"][0]);
        json_["buffers"][0] = std::move(buffer);
    }
}

void GltfOutput::write() {
    finish_buffers();
    const std::string text = json_.dump(!is_binary_ && is_indented_ ? 2 : -1);
    AtomicFile output(target_);
    if (!is_binary_) {
        output.write(text);
        output.commit();
        return;
    }
    const bool grows = appends_to_binary_ && !added_.empty();
    const std::string before = grows ? padding(binary_.size(), '\0') : "";
    const std::size_t binary_size = binary_.size() + before.size() + (grows ? added_.size() : 0);
    constexpr std::size_t header = 12, chunk_header = 8;
    const std::size_t total = header + chunk_header + padded(text.size()) +
                              (binary_size > 0 ? chunk_header + padded(binary_size) : 0) + other_chunks_.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw LimitError(target_.string() + ": a .glb has at most 4 GB; write a .gltf, or split the scene");
    const auto number = [](std::size_t value) { return little_endian(static_cast<std::uint32_t>(value)); };
    output.write("glTF" + number(2) + number(total) + number(padded(text.size())) + "JSON");
    output.write(text);
    std::string after_text = padding(text.size(), ' ');
    if (binary_size > 0)
        after_text += number(padded(binary_size)) + std::string("BIN\0", 4);
    output.write(after_text);
    if (binary_size > 0) {
        output.write(binary_);
        if (grows) {
            output.write(before);
            output.write(added_);
        }
        output.write(padding(binary_size, '\0'));
    }
    output.write(other_chunks_);
    output.commit();
}

}
