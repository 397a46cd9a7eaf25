#include "alcove/mesh/formats/gltf/gltf_compression.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

namespace alcove {
namespace {

/// \throw LimitError if `bytes` exceed the memory limit. Called before they are allocated.
void check_memory(const GltfValue& place, double bytes) {
    if (bytes > memory_limit())
        throw LimitError(fmt::format("{}: decompressed, it takes {}, more than the limit of {}: raise --max-memory",
                                     place.place(), bytes_text(bytes), bytes_text(memory_limit())));
}

bool decode_view(std::string_view mode, char* to, std::size_t count, std::size_t stride, std::string_view from) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(from.data());
    if (mode == "ATTRIBUTES")
        return stride % 4 == 0 && stride <= 256 &&
               meshopt_decodeVertexBuffer(to, count, stride, bytes, from.size()) == 0;
    if (stride != 2 && stride != 4)
        return false;
    if (mode == "TRIANGLES")
        return count % 3 == 0 && meshopt_decodeIndexBuffer(to, count, stride, bytes, from.size()) == 0;
    return mode == "INDICES" && meshopt_decodeIndexSequence(to, count, stride, bytes, from.size()) == 0;
}

bool apply_filter(std::string_view filter, char* to, std::size_t count, std::size_t stride) {
    if (filter == "NONE")
        return true;
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(to, count, stride);
    else if (filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(to, count, stride);
    else if (filter == "EXPONENTIAL" && stride % 4 == 0)
        meshopt_decodeFilterExp(to, count, stride);
    else
        return false;
    return true;
}

}

FilePart range_in(const FilePart& bytes, const GltfValue& object) {
    const std::size_t offset = object.count_or("byteOffset", 0), length = object["byteLength"].count();
    if (offset > bytes.size() || length > bytes.size() - offset)
        object.fail(fmt::format("{} bytes from byte {} exceed the buffer of {} bytes; copy or export the file again",
                                grouped(length), grouped(offset), grouped(bytes.size())));
    return bytes.part(offset, length);
}

std::optional<GltfValue> meshopt_of(const GltfValue& view) {
    const std::optional<GltfValue> extensions = view.find("extensions");
    return extensions ? extensions->find("EXT_meshopt_compression") : std::nullopt;
}

std::string decompress(GltfFile& file, const GltfValue& meshopt) {
    const FilePart part = range_in(file.buffer(meshopt["buffer"].target(file.root(), "buffers")), meshopt);
    const std::size_t count = meshopt["count"].count(), stride = meshopt["byteStride"].count();
    constexpr std::size_t max_stride = 256;
    if (stride == 0 || stride > max_stride)
        meshopt["byteStride"].fail(fmt::format("is {}, not from 1 to {}; export the file again", stride, max_stride));
    check_memory(meshopt, static_cast<double>(count) * static_cast<double>(stride));
    std::string buffer, to(count * stride, '\0');
    const std::string_view from = part.read(buffer);
    if (!decode_view(meshopt["mode"].text(), to.data(), count, stride, from) ||
        !apply_filter(meshopt.text_or("filter", "NONE"), to.data(), count, stride))
        meshopt.fail("the compressed data is damaged; export the file again");
    return to;
}

DracoMesh decode_draco(GltfFile& file, const GltfValue& draco) {
    std::string bytes;
    const std::string_view from = file.view(draco["bufferView"].target(file.root(), "bufferViews")).read(bytes);
    draco::DecoderBuffer buffer;
    buffer.Init(from.data(), from.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        draco.fail(fmt::format("the compressed data is damaged ({}); export the file again",
                               in_one_line(decoded.status().error_msg_string())));
    const draco::Mesh& mesh = *decoded.value();
    DracoMesh result;
    result.vertices = mesh.num_points();
    check_memory(draco, 64.0 * static_cast<double>(result.vertices));
    result.indices.reserve(std::size_t(3) * mesh.num_faces());
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& corner : mesh.face(f)) {
            if (corner.value() >= result.vertices)
                draco.fail("the compressed data is damaged (an index is out of range); export the file again");
            result.indices.push_back(corner.value());
        }
    const GltfValue ids = draco["attributes"];
    for (const auto& [name, id] : ids.json().items()) {
        if (name != "POSITION" && name != "NORMAL" && name != "COLOR_0" && !name.starts_with("TEXCOORD_"))
            continue;
        const GltfValue number = ids[name.c_str()];
        const draco::PointAttribute* attribute =
            mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(number.count()));
        if (attribute == nullptr)
            number.fail("names an attribute that the compressed data lacks; export the file again");
        constexpr int most = 4;
        const int components = attribute->num_components();
        if (components < 1 || components > most)
            continue;
        DracoMesh::Values& values = result.attributes[name];
        values.components = components;
        values.floats.resize(result.vertices * static_cast<std::size_t>(components));
        for (std::size_t v = 0; v < result.vertices; ++v) {
            const draco::AttributeValueIndex at =
                attribute->mapped_index(draco::PointIndex(static_cast<std::uint32_t>(v)));
            if (at.value() >= attribute->size() ||
                !attribute->ConvertValue<float>(at, static_cast<std::int8_t>(components),
                                                values.floats.data() + v * static_cast<std::size_t>(components)))
                number.fail("the compressed data is damaged; export the file again");
        }
    }
    return result;
}

}
