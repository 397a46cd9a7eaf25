#include "alcove/mesh/formats/gltf/gltf_write.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/srgb.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/gltf/gltf_textures.h"
#include "alcove/mesh/formats/gltf/gltf_values.h"
#include "alcove/mesh/formats/obj/materials.h"
#include "alcove/mesh/formats/obj/obj_document.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <unordered_map>

namespace alcove {
namespace {

/// The vertices of a glTF mesh: one for each distinct combination of a vertex, a texture coordinate and a normal.
struct SplitVertices {
    std::vector<std::uint32_t> source; ///< vertex of the Mesh
    std::vector<std::uint32_t> corner; ///< a corner with these values; empty if vertices are not split
    std::vector<Triangle> triangles;
};

/// A vertex, and the bits of u, v and the normal.
using CornerKey = std::array<std::uint32_t, 6>;

struct CornerHash {
    std::size_t operator()(const CornerKey& key) const {
        return std::hash<std::string_view>()({reinterpret_cast<const char*>(key.data()), sizeof(key)});
    }
};

SplitVertices split(const Mesh& mesh) {
    SplitVertices result;
    result.triangles = triangulate(mesh).triangles;
    if (mesh.corner_uvs.empty() && mesh.corner_normals.empty()) {
        result.source.resize(mesh.vertex_count());
        for (std::uint32_t v = 0; v < result.source.size(); ++v)
            result.source[v] = v;
        return result;
    }
    const std::vector<Triangle> corners = corners_of_triangles(mesh);
    std::unordered_map<CornerKey, std::uint32_t, CornerHash> known;
    for (std::size_t t = 0; t < result.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = corners[t][k];
            const Vec2 uv = mesh.corner_uvs.empty() ? Vec2(0.0f) : mesh.corner_uvs[corner];
            const Vec3 n = mesh.corner_normals.empty() ? Vec3(0.0f) : mesh.corner_normals[corner];
            const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
            const CornerKey key{result.triangles[t][k], bits(uv.x), bits(uv.y), bits(n.x), bits(n.y), bits(n.z)};
            const auto [place, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(result.source.size()));
            if (is_new) {
                result.source.push_back(key[0]);
                result.corner.push_back(corner);
            }
            result.triangles[t][k] = place->second;
        }
    return result;
}

/// Builds a file with one node for a mesh that does not come from a glTF file.
class GltfMaker {
  public:
    GltfMaker(GltfOutput& output, const Mesh& mesh) : output_(output), mesh_(mesh), vertices_(split(mesh)) {
        if (mesh.face_count() == 0)
            throw InputError((mesh.name.empty() ? "" : mesh.name + ": ") +
                             "points are not written as glTF: write a .ply");
        if (vertices_.triangles.empty())
            throw InputError((mesh.name.empty() ? "" : mesh.name + ": ") +
                             "no face can be stored in glTF: each has fewer than three different corners, or a corner "
                             "that is not finite");
    }

    std::vector<std::string> make() {
        Json& json = output_.json();
        json["scene"] = 0;
        json["scenes"] = {{{"nodes", {0}}}};
        json["nodes"] = {{{"mesh", 0}}};
        json["meshes"] = Json::array();
        Json attributes = {{"POSITION", add_positions()}};
        add_normals(attributes);
        add_uvs(attributes);
        for (const Attribute& attribute : mesh_.attributes)
            if (attribute.components > 4) {
                lost_.push_back("not stored in glTF: attribute " + in_quotes(attribute.name) +
                                ", which has more than four components");
            } else if (attribute.name != "quality") {
                const auto components = static_cast<std::size_t>(attribute.components);
                attributes[gltf_attribute_name(attribute.name)] =
                    output_.add_floats(gathered(attribute.values, components), components);
            }
        const bool adds = !mesh_.added_colors.empty();
        if (colors_are_ao(mesh_))
            attributes["COLOR_0"] = output_.add_colors(linear_greys(gathered(mesh_.find_attribute("ao")->values, 1)));
        else if (const std::vector<Color>& colors = adds ? mesh_.added_colors : mesh_.vertex_colors; !colors.empty())
            attributes["COLOR_0"] = output_.add_colors(
                linear_colors(gathered(colors, 1), adds ? mesh_.added_encoding : ColorEncoding::srgb));
        Json made = primitives(attributes); // adds materials, which may move the arrays of the root
        json["meshes"].push_back({{"primitives", std::move(made)}});
        if (const std::string name = object_name(); !name.empty())
            json["nodes"][0]["name"] = json["meshes"][0]["name"] = in_one_line(name);
        return std::move(lost_);
    }

  private:
    template <class T>
    std::vector<T> gathered(const std::vector<T>& values, std::size_t components) const {
        std::vector<T> result;
        result.reserve(vertices_.source.size() * components);
        for (const std::uint32_t v : vertices_.source) {
            const auto first = values.begin() + static_cast<std::ptrdiff_t>(v * components);
            result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(components));
        }
        return result;
    }

    /// Adds the positions as floats. If rounding to floats would move a vertex by more than 1e-6 of the diagonal, the
    /// positions are relative to the centre of the mesh, and the node is translated to this centre.
    std::size_t add_positions() {
        constexpr double tolerance = 1e-6;
        const Box box = mesh_.box();
        const bool fits = std::all_of(mesh_.positions.begin(), mesh_.positions.end(), [&](const Vec3d& p) {
            return !is_finite(p) || glm::distance(Vec3d(Vec3(p)), p) <= tolerance * box.diagonal();
        });
        const Vec3d center = fits ? Vec3d(0.0) : box.center();
        if (!fits)
            output_.json()["nodes"][0]["translation"] = {center.x, center.y, center.z};
        std::vector<float> floats;
        std::size_t not_finite = 0;
        for (const std::uint32_t v : vertices_.source) {
            const Vec3 p(mesh_.positions[v] - center);
            const bool finite = alcove::is_finite(Vec3d(p));
            not_finite += !finite;
            for (int c = 0; c < 3; ++c)
                floats.push_back(finite ? p[c] : 0.0f);
        }
        if (not_finite > 0)
            lost_.push_back("not stored in glTF: " + counted(not_finite, "vertex that is", "vertices that are") +
                            " not finite; put at the origin");
        return output_.add_positions(floats);
    }

    void add_normals(Json& attributes) {
        const bool by_corner = !mesh_.corner_normals.empty();
        if (!by_corner && mesh_.normals.empty())
            return;
        const std::vector<Vec3> of_faces = angle_weighted_normals(mesh_, triangulate(mesh_).triangles);
        std::vector<float> floats;
        floats.reserve(3 * vertices_.source.size());
        for (std::size_t i = 0; i < vertices_.source.size(); ++i) {
            Vec3 normal = by_corner ? mesh_.corner_normals[vertices_.corner[i]] : mesh_.normals[vertices_.source[i]];
            normal = unit_or_zero(Vec3d(normal));
            if (normal == Vec3(0.0f))
                normal = of_faces[vertices_.source[i]];
            if (normal == Vec3(0.0f)) // glTF does not allow zero normals
                normal = {0.0f, 0.0f, 1.0f};
            floats.insert(floats.end(), {normal.x, normal.y, normal.z});
        }
        attributes["NORMAL"] = output_.add_floats(floats, 3);
    }

    void add_uvs(Json& attributes) {
        if (mesh_.vertex_uvs.empty() && mesh_.corner_uvs.empty())
            return;
        std::vector<float> floats;
        floats.reserve(2 * vertices_.source.size());
        for (std::size_t i = 0; i < vertices_.source.size(); ++i) {
            const Vec2& uv = mesh_.corner_uvs.empty() ? mesh_.vertex_uvs[vertices_.source[i]]
                                                      : mesh_.corner_uvs[vertices_.corner[i]];
            for (const float value : {uv.x, 1.0f - uv.y})
                floats.push_back(std::isfinite(value) ? value : 0.0f);
        }
        attributes["TEXCOORD_0"] = output_.add_floats(floats, 2);
    }

    /// The name of the object or group of an OBJ that all faces belong to; empty if there are several, or none.
    std::string object_name() const {
        const auto* obj = dynamic_cast<const ObjDocument*>(mesh_.source.get());
        if (obj == nullptr || mesh_.groups.empty() || mesh_.groups.front().names.empty())
            return "";
        const std::string& name = mesh_.groups.front().names.front();
        const bool is_material = std::any_of(obj->material_uses.begin(), obj->material_uses.end(),
                                             [&](const auto& use) { return use.name == name; });
        const bool is_of_all = std::all_of(mesh_.groups.begin(), mesh_.groups.end(), [&](const FaceGroup& group) {
            return !group.names.empty() && group.names.front() == name;
        });
        return is_of_all && !is_material ? name : "";
    }

    struct Material {
        std::string name;
        std::array<float, 4> color; ///< linear
        auto operator<=>(const Material&) const = default;
    };

    /// The material of each face; empty if there are none.
    std::vector<Material> face_materials() {
        std::vector<Material> materials;
        const auto decoded = [](double encoded) { return static_cast<float>(decode_srgb(encoded)); };
        if (!mesh_.face_colors.empty()) {
            for (const Color& c : mesh_.face_colors)
                materials.push_back(
                    {"", {decoded(c[0] / 255.0), decoded(c[1] / 255.0), decoded(c[2] / 255.0), float(c[3]) / 255.0f}});
        } else if (const auto* obj = dynamic_cast<const ObjDocument*>(mesh_.source.get());
                   obj && !obj->material_uses.empty()) {
            const FaceMaterials read = read_materials(mesh_);
            lost_.insert(lost_.end(), read.warnings.begin(), read.warnings.end());
            constexpr std::array<float, 4> white{1.0f, 1.0f, 1.0f, 1.0f};
            materials.resize(mesh_.face_count(), {"", white});
            for (std::size_t i = 0; i < obj->material_uses.size(); ++i)
                for (std::size_t f = obj->material_uses[i].first_face;
                     f < (i + 1 < obj->material_uses.size() ? obj->material_uses[i + 1].first_face : materials.size());
                     ++f)
                    materials[f].name = obj->material_uses[i].name;
            for (std::size_t f = 0; f < materials.size(); ++f)
                if (const std::optional<Vec3>& kd = read.diffuse[f])
                    materials[f].color = {decoded(kd->x), decoded(kd->y), decoded(kd->z), 1.0f};
        }
        return materials;
    }

    Json primitives(const Json& attributes) {
        const std::vector<std::uint32_t> faces = faces_of_triangles(mesh_);
        std::vector<Material> of_faces = face_materials();
        std::map<Material, std::vector<std::uint32_t>> indices;
        for (std::size_t t = 0; t < faces.size(); ++t) {
            std::vector<std::uint32_t>& own = indices[of_faces.empty() ? Material{} : of_faces[faces[t]]];
            own.insert(own.end(), vertices_.triangles[t].begin(), vertices_.triangles[t].end());
        }
        constexpr std::size_t most_materials = 1024;
        if (indices.size() > most_materials) {
            lost_.push_back("not stored in glTF: the colours of the faces, as there are more than " +
                            grouped(most_materials) + " different ones");
            of_faces.clear();
            indices.clear();
            for (const Triangle& t : vertices_.triangles)
                indices[{}].insert(indices[{}].end(), t.begin(), t.end());
        }
        Json primitives = Json::array();
        for (const auto& [material, own] : indices) {
            Json primitive = {{"attributes", attributes},
                              {"indices", output_.add_indices(own, vertices_.source.size())}};
            if (!of_faces.empty()) {
                Json& materials = output_.json()["materials"];
                Json made = Json::object();
                if (!material.name.empty())
                    made["name"] = in_one_line(material.name);
                made["pbrMetallicRoughness"] = {{"baseColorFactor", material.color}, {"metallicFactor", 0}};
                if (material.color[3] < 1.0f)
                    made["alphaMode"] = "BLEND";
                materials.push_back(std::move(made));
                primitive["material"] = materials.size() - 1;
            }
            primitives.push_back(std::move(primitive));
        }
        return primitives;
    }

    GltfOutput& output_;
    const Mesh& mesh_;
    SplitVertices vertices_;
    std::vector<std::string> lost_;
};

std::vector<std::string> write_checked(const Mesh& mesh, const std::filesystem::path& file,
                                       std::span<const GltfTexture> textures) {
    const auto* document = dynamic_cast<const GltfDocument*>(mesh.source.get());
    std::vector<std::string> messages;
    if (document != nullptr && document->vertex_count() == mesh.vertex_count()) {
        GltfOutput output(file, *document->file);
        messages = add_values(output, *document, mesh);
        for (std::string& message : add_textures(output, document->file->root(), textures))
            messages.push_back(std::move(message));
        add_comments(output.json()["asset"], mesh.added_comments);
        output.write();
        messages.insert(messages.end(), output.warnings().begin(), output.warnings().end());
        return messages;
    }
    if (mesh.source != nullptr)
        for (const std::string& content : mesh.source->contents())
            messages.push_back("not stored in glTF: " + content);
    GltfOutput output(file);
    for (std::string& lost : GltfMaker(output, mesh).make())
        messages.push_back(std::move(lost));
    for (const GltfTexture& texture : textures)
        add_texture_to_all(output, texture);
    add_comments(output.json()["asset"], mesh.added_comments);
    output.write();
    return messages;
}

}

std::vector<std::string> write_gltf(const Mesh& mesh, const std::filesystem::path& file) {
    return write_gltf(mesh, file, {});
}

std::vector<std::string> write_gltf(const Mesh& mesh, const std::filesystem::path& file,
                                    std::span<const GltfTexture> textures) {
    try {
        return write_checked(mesh, file, textures);
    } catch (const Json::exception& error) { // from parts that the reader ignores
        throw InputError(fmt::format("{}: its JSON is not valid glTF: {}; export it again", mesh.name, error.what()));
    }
}

}
