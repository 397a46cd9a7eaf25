#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/ply/ply_parse.h"
#include "alcove/mesh/formats/ply/ply_strips.h"
#include "alcove/mesh/formats/text_encoding.h"
#include "alcove/mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove {
namespace {

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

/// An element that may be the faces under another name, because it has a list of whole numbers.
const PlyElement* misnamed_faces(const PlyDocument& document) {
    for (const PlyElement& element : document.elements)
        if (element.name != "vertex" && element.name != "range_grid") // range_grid: rows of scanned points
            for (const PlyProperty& property : element.properties)
                if (property.count_type && is_integral(property.type))
                    return &element;
    return nullptr;
}

/// The names in quotes, separated by commas.
template <class Named>
std::string names_in(const std::vector<Named>& items) {
    std::string names;
    for (const Named& item : items)
        names += (names.empty() ? "" : ", ") + in_quotes(item.name);
    return names.empty() ? "nothing" : names;
}

void check_vertices(const PlyDocument& document, const auto& fail) {
    const PlyElement* vertices = document.find("vertex");
    if (vertices == nullptr)
        fail("the header declares no element 'vertex' but " + names_in(document.elements) +
             "; rename the one that holds the points, or export the file again");
    for (const std::string_view name : {"x", "y", "z"}) {
        const PlyProperty* property = vertices->find(name);
        if (property == nullptr)
            fail("the header declares no property " + in_quotes(name) + " of the vertices but " +
                 names_in(vertices->properties) + "; export the file again");
        if (property->count_type)
            fail("the header declares " + in_quotes(name) +
                 " as a list where one number is needed; export the file again");
    }
}

/// `surface`: faces or strips; null if there are none.
void check_surface(const PlyDocument& document, const PlyElement* surface, const auto& fail) {
    const PlyElement* misnamed = surface == nullptr ? misnamed_faces(document) : nullptr;
    if (misnamed != nullptr)
        fail("the header declares no element 'face' but " + in_quotes(misnamed->name) + " with " +
             names_in(misnamed->properties) + "; if these are the faces, rename them to 'face' and 'vertex_indices'");
    if (surface != nullptr && surface->count > 0 && corner_list(*surface) == nullptr)
        fail("the header declares no list of whole numbers 'vertex_indices' of the faces but " +
             names_in(surface->properties) + "; rename the list that holds the corners, or export the file again");
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

/// The value that stands for full brightness, as inferred from the largest value.
double full_scale(double largest, bool integral) {
    constexpr double rounding = 1e-3;
    return largest <= 1.0 + rounding && !integral ? 1.0 : largest <= 255.0 + rounding ? 255.0 : 65535.0;
}

/// Reads the components of colours from index `first` on. These components have a common range.
void read_components_of_colors(const PlyElement& element, std::span<const PlyProperty* const> properties,
                               std::size_t first, std::vector<Color>& colors) {
    double largest = 0.0;
    for (const PlyProperty* property : properties)
        if (property->type != PlyType::uint8)
            for_each_value(element, *property, [&](std::size_t, const std::byte* bytes) {
                const double value = number_at(bytes, property->type);
                largest = value > largest ? value : largest; // ignores NaN
            });
    for (const PlyProperty* property : properties) {
        const double scale = 255.0 / full_scale(largest, is_integral(property->type));
        for_each_value(element, *property, [&](std::size_t row, const std::byte* bytes) {
            colors[row][first] = color_byte(scale * number_at(bytes, property->type));
        });
        ++first;
    }
}

void read_colors(const PlyElement& element, std::vector<Color>& colors) {
    constexpr std::array<std::array<std::string_view, 4>, 3> names{
        {{"red", "green", "blue", "alpha"},
         {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
         {"r", "g", "b", "a"}}};
    for (const auto& [red, green, blue, alpha] : names) {
        const auto properties = find_all<3>(element, {red, green, blue});
        if (!properties)
            continue;
        colors.assign(element.count, Color{0, 0, 0, 255});
        read_components_of_colors(element, *properties, 0, colors);
        if (const PlyProperty* found = find_scalar(element, alpha))
            read_components_of_colors(element, std::array{found}, 3, colors);
        return;
    }
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

/// Warns of bytes after the rows. If these are text, quotes their first line.
void warn_of_rest(const FileBytes& file, PlyFormat format, std::size_t bytes, Mesh& mesh) {
    const std::string_view rest = file.view().substr(file.size() - bytes);
    const bool is_text = format == PlyFormat::ascii;
    if (bytes == 0 || (is_text && is_padding(rest)))
        return;
    mesh.warnings.push_back(counted(bytes, "byte after the last row was", "bytes after the last row were") +
                            " not read" +
                            (is_text ? ": " + in_quotes(rest.substr(0, rest.find_first_of("\r\n"))) : ""));
}

}

bool begins_as_ply(const FileBytes& file) {
    const std::string_view bytes = without_byte_order_mark(file.view());
    return bytes.starts_with("ply") && (bytes.size() == 3 || bytes.substr(3, 1).find_first_of(" \t\r\n") == 0);
}

Mesh read_ply(const FileBytes& file) {
    PlyHeader header = parse_ply_header(file);
    const auto fail = [&](const std::string& message) { file.fail_at_line(header.body - 1, message); };
    const PlyElement *faces = header.document.find("face"), *strips = header.document.find("tristrips");
    const bool in_strips = strips != nullptr && strips->count > 0 && (faces == nullptr || faces->count == 0);
    check_vertices(header.document, fail);
    check_surface(header.document, in_strips ? strips : faces, fail);

    Mesh mesh;
    const std::size_t left = parse_ply_rows(file, header);
    warn_of_rest(file, header.format, left, mesh);
    const PlyElement& vertices = *header.document.find("vertex");
    const bool is_cloud = !in_strips && (faces == nullptr || faces->count == 0);
    if (is_cloud && vertices.count == 0)
        fail_without_faces(file, header.body - 1, vertices.count);
    read_components(vertices, *find_all<3>(vertices, {"x", "y", "z"}), mesh.positions);
    read_normals(vertices, mesh);
    read_vertex_uvs(vertices, mesh);
    read_colors(vertices, mesh.vertex_colors);
    if (in_strips) {
        read_strips(file, header, mesh);
    } else if (!is_cloud) {
        read_faces(file, header, *faces, mesh);
        read_corner_uvs(*faces, mesh);
        read_colors(*faces, mesh.face_colors);
        if (strips != nullptr && strips->count > 0)
            mesh.warnings.push_back("the file has faces and " + grouped(strips->count) +
                                    " rows of triangle strips; these are kept but are no part of the surface");
    }
    mesh.source = std::make_shared<PlyDocument>(std::move(header.document));
    return mesh;
}

}
