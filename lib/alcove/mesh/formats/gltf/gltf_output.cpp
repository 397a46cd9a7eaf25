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

std::size_t count_values(const Json& json, std::string_view key, const Json& value) {
    std::size_t count = 0;
    if (json.is_structured())
        for (const auto& [own, element] : json.items())
            count += json.is_object() && own == key && element == value ? 1 : count_values(element, key, value);
    return count;
}

GltfOutput::GltfOutput(const fs::path& target) : target_(target), is_binary_(is_glb(target)), in_chunk_(is_binary_) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Alcove " ALCOVE_VERSION}};
}

GltfOutput::GltfOutput(const fs::path& target, GltfFile& file)
    : target_(target), is_binary_(is_glb(target)), is_indented_(file.is_indented()), json_(file.root().json()),
      other_chunks_(is_binary_ ? file.other_chunks() : FilePart()) {
    choose_buffer(file);
    if (!same_folder(file.bytes().path().parent_path(), target.parent_path())) {
        embed_buffers(file);
        move_images(file.bytes().path().parent_path());
    }
}

/// Chooses the buffer to which new data is appended, and loads its contents.
void GltfOutput::choose_buffer(GltfFile& file) {
    const std::size_t buffers = json_.contains("buffers") ? json_["buffers"].size() : 0;
    const bool has_chunk = file.has_binary_chunk() && !(buffers > 0 && json_["buffers"][0].contains("uri"));
    const auto old_buffer = [&](std::size_t b) { return file.buffer(file.root()["buffers"][b]); };
    if (is_binary_) {
        chunk_ = file.binary_chunk();
        buffer_ = has_chunk || buffers == 0 || (buffers == 1 && !file.has_binary_chunk()) ? 0 : buffers;
        if (buffer_ == 0 && !file.has_binary_chunk() && buffers == 1) {
            chunk_ = old_buffer(0);
            json_["buffers"][0].erase("uri");
        }
        in_chunk_ = buffer_ == 0;
        if (in_chunk_)
            binary_ = chunk_;
        return;
    }
    in_chunk_ = false;
    if (has_chunk && buffers > 0)
        set_data_uri(0, old_buffer(0));
    const bool embedded = buffers > 0 && json_["buffers"][buffers - 1].contains("uri") &&
                          is_data_uri(json_["buffers"][buffers - 1]["uri"].get_ref<const std::string&>());
    buffer_ = embedded ? buffers - 1 : buffers;
    if (embedded)
        binary_ = old_buffer(buffer_);
}

void GltfOutput::set_data_uri(std::size_t buffer, const FilePart& first, std::string_view second) {
    Json made; // with the URI first, as is usual
    std::string bytes;
    made["uri"] = data_uri(octets, first.read(bytes), second);
    Json& old = json_["buffers"][buffer];
    old.erase("uri");
    made.update(old);
    made["byteLength"] = first.size() + second.size();
    old = std::move(made);
}

void GltfOutput::embed_buffers(GltfFile& file) {
    std::string bytes;
    for (std::size_t b = 0; json_.contains("buffers") && b < json_["buffers"].size(); ++b) {
        Json& buffer = json_["buffers"][b];
        if (buffer.contains("uri") && !is_data_uri(buffer["uri"].get_ref<const std::string&>()))
            buffer["uri"] = data_uri(octets, file.buffer(file.root()["buffers"][b]).read(bytes));
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

std::size_t GltfOutput::append(std::string_view bytes) {
    added_ += padding(added_.size(), '\0');
    const std::size_t offset = padded(binary_.size()) + added_.size();
    added_ += bytes;
    return offset;
}

std::size_t GltfOutput::add_view(std::string_view bytes, int target) {
    Json view{{"buffer", buffer_}, {"byteOffset", append(bytes)}, {"byteLength", bytes.size()}};
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
    constexpr std::size_t restart = 0xffff; // not allowed as a 16-bit index
    const bool is_short = vertex_count <= restart;
    const std::vector<std::uint16_t> shorts(is_short ? values.begin() : values.end(), values.end());
    const std::string_view bytes = is_short ? bytes_of(std::span(shorts)) : bytes_of(values);
    return add_accessor({{"bufferView", add_view(bytes, element_array_buffer)},
                         {"componentType", is_short ? uint16 : uint32},
                         {"count", values.size()},
                         {"type", "SCALAR"}});
}

std::size_t GltfOutput::add_png(std::string_view bytes, Json image) {
    image.erase("uri");
    image["bufferView"] = add_view(bytes, no_target);
    image["mimeType"] = "image/png";
    json_["images"].push_back(std::move(image));
    return json_["images"].size() - 1;
}

void GltfOutput::replace_png(std::size_t number, std::string_view bytes) {
    Json& image = json_["images"][number];
    image.erase("uri");
    image["mimeType"] = "image/png";
    const auto old = image.find("bufferView");
    if (old == image.end() || count_values(json_, "bufferView", *old) > 1 ||
        json_["bufferViews"][old->get<std::size_t>()].contains("extensions")) {
        image["bufferView"] = add_view(bytes, no_target);
        return;
    }
    const auto view = old->get<std::size_t>();
    take_out(view);
    json_["bufferViews"][view].update(
        {{"buffer", buffer_}, {"byteOffset", append(bytes)}, {"byteLength", bytes.size()}});
}

/// Removes the bytes of a view from the buffer, unless other data overlap them, and moves the bytes that follow.
void GltfOutput::take_out(std::size_t number) {
    struct Range {
        Json* place; // the object that has the offset
        std::size_t begin, end;
    };
    std::vector<Range> ranges;
    std::size_t own = 0;
    for (std::size_t v = 0; v < json_["bufferViews"].size(); ++v) {
        Json& view = json_["bufferViews"][v];
        std::vector<Json*> places{&view};
        if (view.contains("extensions"))
            for (auto& [name, extension] : view["extensions"].items()) {
                if (name != "EXT_meshopt_compression") // others may have offsets, too
                    return;
                places.push_back(&extension);
            }
        if (v == number)
            own = ranges.size();
        for (Json* const place : places)
            if (v == number || place->at("buffer") == buffer_) {
                const auto begin = place->value("byteOffset", std::size_t(0));
                ranges.push_back({place, begin, begin + place->at("byteLength").get<std::size_t>()});
            }
    }
    const auto [view, begin, end] = ranges[own];
    if (view->at("buffer") != buffer_ || begin > end || end > binary_.size())
        return;
    std::size_t next = std::min(padded(end), binary_.size());
    for (std::size_t r = 0; r < ranges.size(); ++r)
        if (r != own && ranges[r].end > begin) {
            if (ranges[r].begin < end)
                return;
            next = std::min(next, ranges[r].begin);
        }
    const bool is_last = next == binary_.size(); // only new data follows
    const std::size_t count = is_last ? next - begin : (next - begin) / 4 * 4, old_size = binary_.size();
    own_binary().erase(begin, count);
    binary_ = FilePart(rewritten_);
    const std::size_t shift = is_last ? padded(old_size) - padded(begin) : count; // keeps later bytes aligned
    for (const Range& range : ranges)
        if (range.begin > begin)
            (*range.place)["byteOffset"] = range.begin - shift;
}

std::string& GltfOutput::own_binary() {
    if (!is_rewritten_)
        rewritten_ = binary_.read();
    is_rewritten_ = true;
    return rewritten_;
}

bool GltfOutput::overwrite(std::size_t accessor, int component_type, std::string_view bytes) {
    if (binary_.empty() || accessor >= json_["accessors"].size())
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
    if (users != 1 || view["buffer"] != buffer_ || view["byteLength"] != bytes.size() || view.contains("byteStride") ||
        view.contains("extensions") || offset > binary_.size() || bytes.size() > binary_.size() - offset)
        return false;
    own_binary().replace(offset, bytes.size(), bytes);
    binary_ = FilePart(rewritten_);
    return true;
}

/// Gives the buffer its final length and, outside the binary chunk, its data.
void GltfOutput::finish_buffer() {
    if (added_.empty() && !is_rewritten_)
        return;
    if (!added_.empty())
        added_.insert(0, padding(binary_.size(), '\0'));
    while (!json_.contains("buffers") || json_["buffers"].size() <= buffer_)
        json_["buffers"].push_back(Json::object());
    if (!in_chunk_)
        set_data_uri(buffer_, binary_, added_);
    else if (!added_.empty())
        json_["buffers"][buffer_]["byteLength"] = binary_.size() + added_.size();
}

void GltfOutput::write() {
    finish_buffer();
    const std::string text = json_.dump(!is_binary_ && is_indented_ ? 2 : -1);
    AtomicFile output(target_);
    if (!is_binary_) {
        output.write(text);
        output.commit();
        return;
    }
    const FilePart first = in_chunk_ ? binary_ : chunk_;
    const std::string_view second = in_chunk_ ? added_ : std::string_view();
    const std::size_t binary_size = first.size() + second.size();
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
        first.write_to(output);
        output.write(second);
        output.write(padding(binary_size, '\0'));
    }
    other_chunks_.write_to(output);
    output.commit();
}

}
