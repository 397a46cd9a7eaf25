#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/ply/ply_parse.h"
#include "alcove/mesh/formats/text_encoding.h"
#include "alcove/mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove {
namespace {

/// Calls f(row, bytes of the property) for all rows.
template <class F>
void for_each_value(const PlyElement& element, const PlyProperty& wanted, F&& f) {
    if (element.count == 0)
        return; // the pointer may be null
    const std::byte* at = element.rows.data();
    if (!element.has_lists()) {
        const std::size_t stride = element.smallest_row();
        for (const PlyProperty* p = element.properties.data(); p != &wanted; ++p)
            at += size_of(p->type);
        for (std::size_t row = 0; row < element.count; ++row, at += stride)
            f(row, at);
        return;
    }
    for (std::size_t row = 0; row < element.count; ++row)
        for (const PlyProperty& property : element.properties) {
            if (&property == &wanted)
                f(row, at);
            at += stored_size(property, at);
        }
}

const PlyProperty* find_scalar(const PlyElement& element, std::string_view name) {
    const PlyProperty* property = element.find(name);
    return property != nullptr && !property->count_type ? property : nullptr;
}

template <class T, std::size_t N>
void read_components(const PlyElement& element, const std::array<const PlyProperty*, N>& properties,
                     std::vector<T>& values) {
    reserve_huge(values, element.count);
    values.resize(element.count);
    for (std::size_t c = 0; c < N; ++c)
        for_each_value(element, *properties[c], [&](std::size_t row, const std::byte* bytes) {
            values[row][static_cast<int>(c)] =
                static_cast<typename T::value_type>(number_at(bytes, properties[c]->type));
        });
}

template <std::size_t N>
std::optional<std::array<const PlyProperty*, N>> find_all(const PlyElement& element,
                                                          const std::array<std::string_view, N>& names) {
    std::array<const PlyProperty*, N> properties{};
    for (std::size_t i = 0; i < N; ++i)
        if ((properties[i] = find_scalar(element, names[i])) == nullptr)
            return {};
    return properties;
}

/// The list of vertex indices; null if there is none.
const PlyProperty* corner_list(const PlyElement& faces) {
    const PlyProperty* list = faces.find("vertex_indices");
    if (list == nullptr)
        list = faces.find("vertex_index");
    return list != nullptr && list->count_type && is_integral(list->type) ? list : nullptr;
}

void check_header(const FileBytes& file, const PlyHeader& header) {
    const auto fail = [&](const std::string& message) { file.fail_at_line(header.body - 1, message); };
    const PlyElement* vertices = header.document.find("vertex");
    const PlyElement* faces = header.document.find("face");
    if (vertices == nullptr)
        fail("the header declares no element 'vertex'; export the file again");
    for (const std::string_view name : {"x", "y", "z"}) {
        const PlyProperty* property = vertices->find(name);
        if (property == nullptr)
            fail("the header declares no property " + in_quotes(name) + " of the vertices; export the file again");
        if (property->count_type)
            fail("the header declares " + in_quotes(name) +
                 " as a list where one number is needed; export the file again");
    }
    if (faces == nullptr && header.document.find("tristrips") != nullptr)
        fail("the header stores the surface as triangle strips; export it with faces");
    if (faces != nullptr && faces->count > 0 && corner_list(*faces) == nullptr)
        fail("the header declares no list of whole numbers 'vertex_indices' of the faces; export the file "
             "again");
}

void read_normals(const PlyElement& vertices, Mesh& mesh) {
    const auto properties = find_all<3>(vertices, {"nx", "ny", "nz"});
    if (!properties)
        return;
    read_components(vertices, *properties, mesh.normals);
    for (Vec3& n : mesh.normals)
        n = unit_or_zero(Vec3d(n));
}

void read_vertex_uvs(const PlyElement& vertices, Mesh& mesh) {
    constexpr std::array<std::array<std::string_view, 2>, 4> names{
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"s0", "t0"}}};
    for (const auto& pair : names)
        if (const auto properties = find_all<2>(vertices, pair))
            return read_components(vertices, *properties, mesh.vertex_uvs);
}

/// A colour component as a byte: floats range to 1, ushorts to 65535, the other types to 255.
std::uint8_t color_component(double value, PlyType type) {
    if (!is_integral(type))
        value *= 255.0;
    else if (type == PlyType::uint16)
        value /= 257.0;
    return color_byte(value);
}

void read_colors(const PlyElement& element, std::vector<Color>& colors) {
    const auto properties = find_all<3>(element, {"red", "green", "blue"});
    if (!properties)
        return;
    colors.assign(element.count, Color{0, 0, 0, 255});
    const auto read_component = [&](const PlyProperty& property, std::size_t component) {
        for_each_value(element, property, [&](std::size_t row, const std::byte* bytes) {
            colors[row][component] = color_component(number_at(bytes, property.type), property.type);
        });
    };
    for (std::size_t c = 0; c < 3; ++c)
        read_component(*(*properties)[c], c);
    if (const PlyProperty* alpha = find_scalar(element, "alpha"))
        read_component(*alpha, 3);
}

void read_faces(const FileBytes& file, const PlyHeader& header, const PlyElement& faces, Mesh& mesh) {
    const PlyProperty* list = corner_list(faces);
    const std::size_t size = size_of(list->type);
    reserve_huge(mesh.face_begin, faces.count + 1);
    reserve_huge(mesh.corners, (faces.rows.size() - faces.count * faces.smallest_row()) / size);
    const auto vertices = static_cast<std::int64_t>(mesh.vertex_count());
    for_each_value(faces, *list, [&](std::size_t row, const std::byte* bytes) {
        const std::int64_t corners = integer_at(bytes, *list->count_type);
        bytes += size_of(*list->count_type);
        for (std::int64_t c = 0; c < corners; ++c, bytes += size) {
            const std::int64_t index = integer_at(bytes, list->type);
            if (index < 0 || index >= vertices)
                fail_in_row(file, header, faces, row, static_cast<std::size_t>(bytes - faces.rows.data()),
                            "vertex index " + std::to_string(index) + " is out of range: there are " +
                                grouped(mesh.vertex_count()) + " vertices, counted from 0; export the file again");
            mesh.corners.push_back(static_cast<std::uint32_t>(index));
        }
        close_face(mesh);
    });
}

void read_corner_uvs(const PlyElement& faces, Mesh& mesh) {
    const PlyProperty* list = faces.find("texcoord");
    if (list == nullptr || !list->count_type || !mesh.vertex_uvs.empty())
        return;
    std::size_t without = 0;
    const std::size_t size = size_of(list->type);
    mesh.corner_uvs.assign(mesh.corners.size(), Vec2(0.0f));
    for_each_value(faces, *list, [&](std::size_t row, const std::byte* bytes) {
        if (static_cast<std::size_t>(integer_at(bytes, *list->count_type)) != 2 * mesh.face(row).size()) {
            ++without;
            return;
        }
        bytes += size_of(*list->count_type);
        for (std::size_t c = mesh.face_begin[row]; c < mesh.face_begin[row + 1]; ++c, bytes += 2 * size)
            mesh.corner_uvs[c] = {static_cast<float>(number_at(bytes, list->type)),
                                  static_cast<float>(number_at(bytes + size, list->type))};
    });
    if (without == faces.count)
        mesh.corner_uvs.clear();
    else if (without > 0)
        mesh.warnings.push_back(counted(without, "face has", "faces have") +
                                " no texture coordinates for each corner; (0, 0) is used");
}

}

bool begins_as_ply(const FileBytes& file) {
    const std::string_view bytes = without_byte_order_mark(file.view());
    return bytes.starts_with("ply") && (bytes.size() == 3 || bytes.substr(3, 1).find_first_of(" \t\r\n") == 0);
}

Mesh read_ply(const FileBytes& file) {
    PlyHeader header = parse_ply_header(file);
    check_header(file, header);
    const PlyElement* vertices = header.document.find("vertex");
    const PlyElement* faces = header.document.find("face");

    Mesh mesh;
    if (const std::size_t left = parse_ply_rows(file, header); left > 0)
        mesh.warnings.push_back(grouped(left) + " bytes after the last row were not read");
    if (faces == nullptr)
        fail_without_faces(file, header.body - 1, vertices->count);
    if (faces->count == 0)
        fail_without_faces(file, header.element_line[static_cast<std::size_t>(faces - header.document.elements.data())],
                           vertices->count);
    read_components(*vertices, *find_all<3>(*vertices, {"x", "y", "z"}), mesh.positions);
    read_normals(*vertices, mesh);
    read_vertex_uvs(*vertices, mesh);
    read_colors(*vertices, mesh.vertex_colors);
    read_faces(file, header, *faces, mesh);
    read_corner_uvs(*faces, mesh);
    read_colors(*faces, mesh.face_colors);
    mesh.source = std::make_shared<PlyDocument>(std::move(header.document));
    return mesh;
}

}
