#include "alcove/mesh/formats/ply/ply_document.h"

#include "alcove/base/detail/messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace alcove {
namespace {

struct TypeNames {
    std::string_view name, sized_name;
};
constexpr std::array<TypeNames, 8> types{{{"char", "int8"},
                                          {"uchar", "uint8"},
                                          {"short", "int16"},
                                          {"ushort", "uint16"},
                                          {"int", "int32"},
                                          {"uint", "uint32"},
                                          {"float", "float32"},
                                          {"double", "float64"}}};

template <class T>
std::byte* store(std::byte* to, T value) {
    std::memcpy(to, &value, sizeof value);
    return to + sizeof value;
}

bool needs_double(const Mesh& mesh) {
    const double tolerance = 1e-6 * mesh.box().diagonal();
    return std::any_of(mesh.positions.begin(), mesh.positions.end(), [&](const Vec3d& p) {
        return is_finite(p) && !(glm::distance(p, Vec3d(Vec3(p))) <= tolerance);
    });
}

template <class T>
std::byte* store_count(std::byte* to, std::size_t count) {
    return store(to, static_cast<T>(count));
}

std::byte* store_count(std::byte* to, std::size_t count, PlyType type) {
    return type == PlyType::uint8 ? store_count<std::uint8_t>(to, count) : store_count<std::int32_t>(to, count);
}

void add_color_properties(PlyElement& element) {
    for (const char* name : {"red", "green", "blue", "alpha"})
        element.properties.push_back({name, PlyType::uint8, {}});
}

PlyElement vertex_element(const Mesh& mesh) {
    PlyElement element{"vertex", mesh.vertex_count(), {}};
    const bool wide = needs_double(mesh);
    for (const char* name : {"x", "y", "z"})
        element.properties.push_back({name, wide ? PlyType::float64 : PlyType::float32, {}});
    if (!mesh.normals.empty())
        for (const char* name : {"nx", "ny", "nz"})
            element.properties.push_back({name, PlyType::float32, {}});
    if (!mesh.vertex_uvs.empty())
        for (const char* name : {"s", "t"})
            element.properties.push_back({name, PlyType::float32, {}});
    if (!mesh.vertex_colors.empty())
        add_color_properties(element);

    std::vector<std::byte> rows(element.count * element.smallest_row());
    std::byte* to = rows.data();
    for (std::size_t v = 0; v < element.count; ++v) {
        to = wide ? store(to, mesh.positions[v]) : store(to, Vec3(mesh.positions[v]));
        if (!mesh.normals.empty())
            to = store(to, mesh.normals[v]);
        if (!mesh.vertex_uvs.empty())
            to = store(to, mesh.vertex_uvs[v]);
        if (!mesh.vertex_colors.empty())
            to = store(to, mesh.vertex_colors[v]);
    }
    element.keep(std::move(rows));
    return element;
}

}

std::string_view name_of(PlyType type) {
    return types[static_cast<std::size_t>(type)].name;
}

std::optional<PlyType> ply_type_named(std::string_view name) {
    for (std::size_t i = 0; i < types.size(); ++i)
        if (name == types[i].name || name == types[i].sized_name)
            return static_cast<PlyType>(i);
    return {};
}

void PlyElement::keep(std::vector<std::byte> new_rows) {
    const auto kept = std::make_shared<const std::vector<std::byte>>(std::move(new_rows));
    rows = *kept;
    keeper = kept;
}

const PlyProperty* PlyElement::find(std::string_view property) const {
    const auto found =
        std::find_if(properties.begin(), properties.end(), [&](const PlyProperty& p) { return p.name == property; });
    return found == properties.end() ? nullptr : &*found;
}

bool PlyElement::has_lists() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const PlyProperty& p) { return p.count_type.has_value(); });
}

std::size_t PlyElement::smallest_row() const {
    std::size_t size = 0;
    for (const PlyProperty& p : properties)
        size += size_of(p.count_type.value_or(p.type));
    return size;
}

const PlyElement* PlyDocument::find(std::string_view element) const {
    const auto found =
        std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == element; });
    return found == elements.end() ? nullptr : &*found;
}

std::string_view PlyDocument::comment(std::string_view beginning) const {
    constexpr std::string_view keyword = "comment ";
    for (const std::string_view line : comments)
        if (line.starts_with(keyword) && line.substr(keyword.size()).starts_with(beginning))
            return line.substr(keyword.size());
    return {};
}

bool PlyDocument::has_vertex_property(std::string_view name) const {
    const PlyElement* vertices = find("vertex");
    return vertices != nullptr && vertices->find(name) != nullptr;
}

std::vector<std::string> PlyDocument::contents() const {
    constexpr std::array<std::string_view, 18> of_vertices{"x",  "y",  "z",   "nx",    "ny",        "nz",
                                                           "s",  "t",  "u",   "v",     "texture_u", "texture_v",
                                                           "s0", "t0", "red", "green", "blue",      "alpha"};
    // The colours of faces count as stored, because writers report them for all input formats.
    constexpr std::array<std::string_view, 7> of_faces{"vertex_indices", "vertex_index", "texcoord", "red",
                                                       "green",          "blue",         "alpha"};
    std::vector<std::string> all;
    for (const PlyElement& element : elements) {
        std::span<const std::string_view> stored;
        if (element.name == "vertex")
            stored = of_vertices;
        else if (element.name == "face")
            stored = of_faces;
        else
            all.push_back(grouped(element.count) + " rows of element " + in_quotes(element.name));
        for (const PlyProperty& property : element.properties)
            if (!stored.empty() && std::find(stored.begin(), stored.end(), property.name) == stored.end())
                all.push_back("property " + in_quotes(property.name) + " of element " + in_quotes(element.name));
    }
    if (!comments.empty())
        all.push_back(counted(comments.size(), "comment line", "comment lines"));
    return all;
}

const PlyProperty* corner_list(const PlyElement& element) {
    const PlyProperty* list = element.find("vertex_indices");
    if (list == nullptr)
        list = element.find("vertex_index");
    return list != nullptr && list->count_type && is_integral(list->type) ? list : nullptr;
}

PlyElement face_element(const Mesh& mesh) {
    std::size_t most_corners = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        most_corners = std::max(most_corners, mesh.face(f).size());
    const bool has_uvs = !mesh.corner_uvs.empty();
    const bool has_colors = !mesh.face_colors.empty();
    const PlyType count_type = most_corners <= 255 ? PlyType::uint8 : PlyType::int32;
    const PlyType uv_count_type = 2 * most_corners <= 255 ? PlyType::uint8 : PlyType::int32;
    const bool large = mesh.vertex_count() > 0x7fffffffu;

    PlyElement element{"face", mesh.face_count(), {}};
    element.properties.push_back({"vertex_indices", large ? PlyType::uint32 : PlyType::int32, count_type});
    if (has_uvs)
        element.properties.push_back({"texcoord", PlyType::float32, uv_count_type});
    if (has_colors)
        add_color_properties(element);

    std::vector<std::byte> rows(element.count * element.smallest_row() + mesh.corners.size() * sizeof(std::uint32_t) +
                                mesh.corner_uvs.size() * sizeof(Vec2));
    std::byte* to = rows.data();
    for (std::size_t f = 0; f < element.count; ++f) {
        const auto face = mesh.face(f);
        to = store_count(to, face.size(), count_type);
        to = std::copy_n(std::as_bytes(face).data(), face.size_bytes(), to);
        if (has_uvs) {
            const auto uvs = std::as_bytes(std::span(mesh.corner_uvs).subspan(mesh.face_begin[f], face.size()));
            to = store_count(to, 2 * face.size(), uv_count_type);
            to = std::copy(uvs.begin(), uvs.end(), to);
        }
        if (has_colors)
            to = store(to, mesh.face_colors[f]);
    }
    element.keep(std::move(rows));
    return element;
}

PlyDocument make_ply_document(const Mesh& mesh) {
    PlyDocument document;
    document.elements.push_back(vertex_element(mesh));
    document.elements.push_back(face_element(mesh));
    return document;
}

}
