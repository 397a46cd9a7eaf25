// Format: glTF 2.0 (Khronos 2021).
#include "alcove/mesh/formats/gltf/gltf_file.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/formats/gltf/gltf_compression.h"
#include "alcove/mesh/formats/gltf/gltf_uri.h"
#include "alcove/mesh/formats/text_encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace alcove {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is read without swapping bytes");

constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk_type = 0x004e4942;
constexpr std::size_t header_size = 12, chunk_header_size = 8;
constexpr std::size_t max_depth = 200; // limited because writing the JSON is recursive

}

GltfFile::GltfFile(const FileBytes& bytes) : bytes_(bytes) {
    if (bytes_.view().starts_with("glTF"))
        parse_chunks();
    else
        json_text_ = without_byte_order_mark(bytes_.view());
    parse_json(json_text_);
    if (!json_.is_object())
        bytes_.fail("is not glTF: its JSON is not an object");
    const std::string version = root()["asset"].text_or("minVersion", root()["asset"].text_or("version", ""));
    if (version.substr(0, 3) != "2.0" && !(version.starts_with("2.") && !root()["asset"].has("minVersion")))
        root()["asset"].fail(fmt::format("version {} cannot be read; convert it to glTF 2.0", in_quotes(version)));
    if (has_binary_chunk_ && root().has("buffers") && root()["buffers"].size() > 0) {
        const std::size_t length = root()["buffers"][0].count_or("byteLength", 0);
        constexpr std::size_t padding = 3;
        if (length <= binary_chunk_.size() && binary_chunk_.size() - length <= padding)
            binary_chunk_ = binary_chunk_.part(0, length);
    }
}

/// A 32-bit integer, little endian like all numbers in glTF.
std::uint32_t GltfFile::number_at(std::size_t place, const char* expected) const {
    std::uint32_t number = 0;
    const std::size_t size = bytes_.size_of_file();
    if (size - std::min(place, size) < sizeof(number))
        bytes_.fail_at_byte(size, fmt::format("the file ends early: {} is missing; copy or export it again", expected));
    std::memcpy(&number, bytes_.part(place, sizeof(number)).read().data(), sizeof(number));
    return number;
}

void GltfFile::parse_chunks() {
    is_binary_ = true;
    const std::uint32_t version = number_at(4, "the version");
    if (version != 2)
        bytes_.fail_at_byte(8,
                            fmt::format("version {} of binary glTF cannot be read; convert it to version 2", version));
    const std::uint32_t end = number_at(8, "the length");
    if (end > bytes_.size_of_file() || end < header_size)
        bytes_.fail_at_byte(header_size, fmt::format("the header gives a length of {} bytes, but the file has {}; copy "
                                                     "or export it again",
                                                     grouped(end), grouped(bytes_.size_of_file())));
    std::size_t at = header_size;
    for (int number = 0; at < end; ++number) {
        const std::uint32_t size = number_at(at, "the length of a chunk");
        const std::uint32_t type = number_at(at + 4, "the type of a chunk");
        const std::size_t left = end - at, data = at + chunk_header_size;
        if (left < chunk_header_size || size > left - chunk_header_size)
            bytes_.fail_at_byte(data, fmt::format("a chunk of {} bytes does not fit the rest of the file; copy or "
                                                  "export it again",
                                                  grouped(size)));
        if (number == 0) {
            if (type != json_chunk)
                bytes_.fail_at_byte(data, "the first chunk is not JSON; export the file again");
            json_text_ = bytes_.view().substr(data, size);
        } else if (number == 1 && type == binary_chunk_type) {
            has_binary_chunk_ = true;
            binary_chunk_ = bytes_.part(data, size);
        } else {
            other_chunks_ = bytes_.part(at, left);
            break;
        }
        at = data + size;
    }
}

/// Before parsing, refuses JSON that would take much more memory or time than its size suggests.
void GltfFile::check_json(std::string_view text) const {
    constexpr std::size_t most_keys = 4096; // of one object, as they are searched one by one
    constexpr double bytes_per_value = 64.0;
    std::vector<std::size_t> commas; // in each open object or array
    double values = 1.0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            for (++i; i < text.size() && text[i] != '"'; ++i)
                i += text[i] == '\\';
        } else if (c == '{' || c == '[') {
            commas.push_back(c == '{' ? 0 : std::numeric_limits<std::size_t>::max() / 2);
            values += 1.0;
            if (commas.size() > max_depth)
                bytes_.fail(fmt::format("its JSON is nested more than {} levels deep; export it again", max_depth));
        } else if ((c == '}' || c == ']') && !commas.empty()) {
            commas.pop_back();
        } else if (c == ',' && !commas.empty()) {
            values += 1.0;
            if (++commas.back() == most_keys)
                bytes_.fail_at_line(
                    text.data() + i,
                    fmt::format("an object has more than {} keys; export the file again", grouped(most_keys)));
        }
    }
    if (bytes_per_value * values > memory_limit())
        throw LimitError(fmt::format("{}: its JSON takes about {} of memory, more than the limit of {}: raise "
                                     "--max-memory, or split the scene",
                                     bytes_.path().string(), bytes_text(bytes_per_value * values),
                                     bytes_text(memory_limit())));
}

void GltfFile::parse_json(std::string_view text) {
    check_json(text);
    try {
        json_ = Json::parse(text.begin(), text.end());
    } catch (const Json::parse_error& error) {
        const std::size_t at = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
        bytes_.fail_at_line(text.data() + at, "the JSON is damaged here; export the file again");
    } catch (const Json::exception& error) {
        bytes_.fail(fmt::format("the JSON cannot be read: {}; export the file again", error.what()));
    }
}

bool GltfFile::is_indented() const {
    const std::size_t brace = json_text_.find('{');
    return brace != std::string_view::npos && brace + 1 < json_text_.size() &&
           (json_text_[brace + 1] == '\n' || json_text_[brace + 1] == '\r');
}

FilePart GltfFile::bytes_of_uri(const GltfValue& holder) {
    const std::string& uri = holder["uri"].text();
    const std::string key = is_data_uri(uri) ? holder.place() : uri;
    auto known = files_.find(key);
    if (known == files_.end()) {
        if (is_data_uri(uri)) {
            const std::optional<std::string> data = data_of_uri(uri);
            if (!data)
                holder["uri"].fail("is not a data URI in base64; export the file again");
            known = files_.try_emplace(key, bytes_.path(), *data).first;
        } else {
            const std::optional<std::filesystem::path> path = path_of_uri(uri);
            if (!path)
                holder["uri"].fail(fmt::format("{} is not a file in the folder of this one, and no other file is "
                                               "read; put it beside this one",
                                               in_quotes(uri)));
            const std::filesystem::path file = bytes_.path().parent_path() / *path;
            std::error_code error;
            if (!std::filesystem::is_regular_file(file, error))
                holder["uri"].fail(fmt::format("the file {} is missing; put it beside this one", in_quotes(uri)));
            // A link may also lead out of the folder.
            const auto folder = bytes_.path().has_parent_path() ? bytes_.path().parent_path() : ".";
            const auto inside = std::filesystem::weakly_canonical(file, error)
                                    .lexically_relative(std::filesystem::weakly_canonical(folder, error));
            if (inside.empty() || *inside.begin() == "..")
                holder["uri"].fail(fmt::format("{} leads out of the folder of this file, and no other file is read; "
                                               "put the data beside this one",
                                               in_quotes(uri)));
            known = files_.try_emplace(key, file).first;
        }
    }
    return FilePart(known->second.view());
}

FilePart GltfFile::buffer(const GltfValue& buffer) {
    const std::lock_guard lock(mutex_);
    const std::size_t length = buffer["byteLength"].count();
    FilePart bytes;
    if (!buffer.has("uri")) {
        if (!has_binary_chunk_ || buffer.place() != "buffers[0]")
            buffer.fail("has no data; export the file again");
        bytes = binary_chunk_;
    } else {
        bytes = bytes_of_uri(buffer);
    }
    if (bytes.size() < length)
        buffer.fail(fmt::format("has {} bytes, fewer than its byteLength of {}; copy or export the file again",
                                grouped(bytes.size()), grouped(length)));
    return bytes.part(0, length);
}

FilePart GltfFile::image(const GltfValue& image) {
    const std::lock_guard lock(mutex_);
    return image.has("uri") ? bytes_of_uri(image) : view(image["bufferView"].target(root(), "bufferViews"));
}

FilePart GltfFile::view(const GltfValue& view) {
    const std::lock_guard lock(mutex_);
    if (const std::optional<GltfValue> compression = meshopt_of(view)) {
        auto known = decompressed_.find(view.place());
        if (known == decompressed_.end()) {
            known = decompressed_.try_emplace(view.place(), decompress(*this, *compression)).first;
            decompressed_bytes_ += static_cast<double>(known->second.size());
            if (decompressed_bytes_ > memory_limit())
                throw LimitError(fmt::format("{}: decompressed, its buffers take more than the limit of {}: raise "
                                             "--max-memory",
                                             bytes_.path().string(), bytes_text(memory_limit())));
        }
        return FilePart(known->second);
    }
    return range_in(buffer(view["buffer"].target(root(), "buffers")), view);
}

std::size_t head_of_glb(std::string_view first_bytes) {
    if (!first_bytes.starts_with("glTF") || first_bytes.size() < header_size + chunk_header_size)
        return std::string_view::npos;
    std::uint32_t json_size = 0;
    std::memcpy(&json_size, first_bytes.data() + header_size, sizeof(json_size));
    return header_size + chunk_header_size + json_size;
}

}
