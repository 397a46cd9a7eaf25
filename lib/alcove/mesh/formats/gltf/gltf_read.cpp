#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/srgb.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/gltf/gltf_accessor.h"
#include "alcove/mesh/formats/gltf/gltf_compression.h"
#include "alcove/mesh/formats/gltf/gltf_document.h"
#include "alcove/mesh/normals.h"

#include <fmt/format.h>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <unordered_map>

namespace alcove {
namespace {

enum Mode : std::size_t { triangles = 4, triangle_strip, triangle_fan };

constexpr Color white{255, 255, 255, 255};

constexpr std::array<std::string_view, 4> geometry_extensions{"KHR_mesh_quantization", "EXT_meshopt_compression",
                                                              "KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing"};
/// Extensions of these kinds do not change geometry.
constexpr std::array<std::string_view, 9> appearance_extensions{"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                                                "MSFT_texture_",  "KHR_lights_",  "EXT_lights_",
                                                                "KHR_animation_", "KHR_xmp",      "KHR_audio"};

void check_extensions(const GltfValue& root) {
    const std::optional<GltfValue> required = root.find("extensionsRequired");
    for (std::size_t i = 0; required && i < required->size(); ++i) {
        const std::string& name = (*required)[i].text();
        const auto begins = [&](std::string_view prefix) { return name.starts_with(prefix); };
        if (std::find(geometry_extensions.begin(), geometry_extensions.end(), name) == geometry_extensions.end() &&
            std::none_of(appearance_extensions.begin(), appearance_extensions.end(), begins))
            (*required)[i].fail(
                fmt::format("the file needs {}, which Alcove cannot read; export the file without that extension",
                            in_quotes(name)));
    }
}

std::optional<GltfValue> draco_of(const GltfValue& primitive) {
    const std::optional<GltfValue> extensions = primitive.find("extensions");
    return extensions ? extensions->find("KHR_draco_mesh_compression") : std::nullopt;
}

// Takes an attribute out of a decoded primitive; empty if there is none.
std::vector<float> take_attribute(DracoMesh& mesh, const GltfValue& extension, const std::string& name, int least,
                                  int most) {
    const auto found = mesh.attributes.find(name);
    if (found == mesh.attributes.end())
        return {};
    if (found->second.components < least || found->second.components > most)
        extension.fail(fmt::format("{} has {} components; export the file again", name, found->second.components));
    return std::move(found->second.floats);
}

// glTF counts v from the top of the image, Alcove from the bottom.
std::vector<Vec2> as_uvs(const std::vector<float>& floats) {
    std::vector<Vec2> uvs(floats.size() / 2);
    for (std::size_t i = 0; i < uvs.size(); ++i)
        uvs[i] = {floats[2 * i], 1.0f - floats[2 * i + 1]};
    return uvs;
}

std::optional<GltfValue> accessor_of(const GltfValue& root, const GltfValue& primitive, const char* attribute) {
    const GltfValue attributes = primitive["attributes"];
    if (!attributes.has(attribute))
        return {};
    return attributes[attribute].target(root, "accessors");
}

/// Whether the faces of a primitive are read.
bool is_surface(const GltfValue& primitive) {
    const std::size_t mode = primitive.count_or("mode", triangles);
    return mode >= triangles && mode <= triangle_fan && primitive["attributes"].has("POSITION");
}

/// Primitives of one mesh that share their vertices, decoded.
struct DecodedVertices {
    std::vector<std::size_t> primitives;
    std::vector<std::vector<std::uint32_t>> corners; ///< of the triangles of each primitive
    std::vector<float> positions, normals, colors;   ///< three, three and color_components per vertex
    int color_components = 4;
    std::vector<Vec2> uvs;

    std::size_t count() const { return positions.size() / 3; }
};

/// The corners of the triangles of a list, strip or fan. Degenerate triangles of strips are dropped, as they only
/// connect parts.
std::vector<std::uint32_t> as_triangles(std::vector<std::uint32_t> indices, std::size_t mode) {
    if (mode == triangles) {
        indices.resize(indices.size() / 3 * 3);
        return indices;
    }
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 2; i < indices.size(); ++i) {
        const std::uint32_t c = indices[i];
        std::uint32_t a = indices[mode == triangle_fan ? 0 : i - 2], b = indices[i - 1];
        if (mode == triangle_strip && i % 2 == 1)
            std::swap(a, b);
        if (a != b && b != c && a != c)
            corners.insert(corners.end(), {a, b, c});
    }
    return corners;
}

class GltfReader {
  public:
    explicit GltfReader(const FileBytes& bytes)
        : document_(std::make_shared<GltfDocument>(bytes)), file_(*document_->file), root_(file_.root()) {}

    Mesh read() {
        check_extensions(root_);
        document_->placements = placements_of(file_);
        check_size();
        std::map<std::size_t, std::size_t> last; // placement of each mesh
        for (std::size_t p = 0; p < document_->placements.size(); ++p)
            last[document_->placements[p].mesh] = p;
        for (std::size_t p = 0; p < document_->placements.size(); ++p) {
            add(p);
            if (const std::size_t mesh = document_->placements[p].mesh; last[mesh] == p)
                decoded_[mesh].clear();
        }
        if (mesh_.face_count() == 0)
            file_.bytes().fail(left_out_ > 0 ? "contains points or lines but no faces; export it with triangles"
                                             : "contains no mesh in its scene; export it again");
        round_to_floats();
        warn();
        describe_contents();
        mesh_.source = document_;
        return std::move(mesh_);
    }

  private:
    GltfValue mesh_value(std::size_t mesh) const { return root_["meshes"][mesh]; }

    /// Counts vertices and corners, including all instances, before any are decoded.
    void check_size() {
        struct Size {
            double vertices = 0.0, corners = 0.0, groups = 0.0;
        };
        std::map<std::size_t, Size> sizes; // by mesh
        Size all;
        for (const GltfPlacement& placement : document_->placements) {
            const auto [known, is_new] = sizes.try_emplace(placement.mesh);
            if (is_new) {
                const GltfValue primitives = mesh_value(placement.mesh)["primitives"];
                for (std::size_t i = 0; i < primitives.size(); ++i) {
                    if (!is_surface(primitives[i]))
                        continue;
                    const GltfValue positions = *accessor_of(root_, primitives[i], "POSITION");
                    const GltfAccessor checked(file_, positions, 3, 3); // its count fits its buffer view
                    const auto count = static_cast<double>(checked.count());
                    const bool strip = primitives[i].count_or("mode", triangles) != triangles;
                    known->second.vertices += count;
                    known->second.groups += 1.0;
                    known->second.corners +=
                        (strip ? 3.0 : 1.0) *
                        (primitives[i].has("indices")
                             ? double(count_of_accessor(primitives[i]["indices"].target(root_, "accessors")))
                             : count);
                }
            }
            all.vertices += known->second.vertices;
            all.corners += known->second.corners;
            all.groups += known->second.groups + 1.0;
        }
        constexpr double bytes_per_vertex = sizeof(Vec3d) + sizeof(Vec3) + sizeof(Vec2) + sizeof(Color);
        constexpr double bytes_per_corner = sizeof(std::uint32_t) * (1.0 + 1.0 / 3.0);
        constexpr double bytes_per_group = 1024.0; // with its names
        const double bytes =
            bytes_per_vertex * all.vertices + bytes_per_corner * all.corners + bytes_per_group * all.groups;
        const std::string name = file_.bytes().path().string();
        if (bytes > memory_limit())
            throw LimitError(fmt::format("{}: with all its instances, the scene takes {}, more than the limit of {}: "
                                         "raise --max-memory, or split the scene",
                                         name, bytes_text(bytes), bytes_text(memory_limit())));
        constexpr auto most = static_cast<double>(std::numeric_limits<std::uint32_t>::max());
        if (all.vertices > most || all.corners > most)
            throw LimitError(name + ": more than 2^32 vertices or corners; split the scene");
    }

    const std::vector<DecodedVertices>& decoded(std::size_t mesh) {
        auto known = decoded_.find(mesh);
        if (known == decoded_.end())
            known = decoded_.try_emplace(mesh, decode(mesh_value(mesh))).first;
        return known->second;
    }

    std::vector<DecodedVertices> decode(const GltfValue& mesh) {
        std::vector<DecodedVertices> all;
        std::unordered_map<std::string, std::size_t> by_attributes; // indices into `all`
        const GltfValue primitives = mesh["primitives"];
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const GltfValue primitive = primitives[i];
            if (primitive.has("targets"))
                morphed_.insert(primitive.place());
            if (!is_surface(primitive)) {
                ++left_out_;
                continue;
            }
            if (const std::optional<GltfValue> draco = draco_of(primitive)) {
                all.push_back(decode_compressed(primitive, *draco));
                all.back().primitives.push_back(i);
                continue;
            }
            const auto [same, is_new] = by_attributes.try_emplace(primitive["attributes"].json().dump(), all.size());
            if (is_new)
                all.push_back(decode_vertices(primitive));
            DecodedVertices& vertices = all[same->second];
            vertices.primitives.push_back(i);
            vertices.corners.push_back(corners_of(primitive, vertices.count()));
        }
        return all;
    }

    std::vector<float> floats(const GltfValue& primitive, const char* attribute, int least, int most, std::size_t count,
                              int* components = nullptr) {
        const std::optional<GltfValue> value = accessor_of(root_, primitive, attribute);
        if (!value)
            return {};
        const GltfAccessor accessor(file_, *value, least, most);
        if (accessor.count() != count)
            value->fail(fmt::format("{} has {} elements, but POSITION has {}; export the file again", attribute,
                                    grouped(accessor.count()), grouped(count)));
        if (components != nullptr)
            *components = accessor.components();
        return accessor.floats();
    }

    DecodedVertices decode_vertices(const GltfValue& primitive) {
        DecodedVertices vertices;
        const std::size_t count = count_of_accessor(*accessor_of(root_, primitive, "POSITION"));
        vertices.positions = floats(primitive, "POSITION", 3, 3, count);
        vertices.normals = floats(primitive, "NORMAL", 3, 3, count);
        vertices.colors = floats(primitive, "COLOR_0", 3, 4, count, &vertices.color_components);
        vertices.uvs = uvs_of_primitive(file_, primitive, 0);
        return vertices;
    }

    DecodedVertices decode_compressed(const GltfValue& primitive, const GltfValue& extension) {
        DracoMesh draco = decode_draco(file_, extension);
        DecodedVertices vertices;
        const auto take = [&](const char* name, int least, int most) {
            return take_attribute(draco, extension, name, least, most);
        };
        const std::size_t count = count_of_accessor(*accessor_of(root_, primitive, "POSITION"));
        vertices.positions = take("POSITION", 3, 3);
        vertices.normals = take("NORMAL", 3, 3);
        if (const auto colors = draco.attributes.find("COLOR_0"); colors != draco.attributes.end())
            vertices.color_components = colors->second.components;
        vertices.colors = take("COLOR_0", 3, 4);
        // Attributes that are not compressed.
        if (vertices.normals.empty())
            vertices.normals = floats(primitive, "NORMAL", 3, 3, count);
        if (vertices.colors.empty())
            vertices.colors = floats(primitive, "COLOR_0", 3, 4, count, &vertices.color_components);
        vertices.uvs = as_uvs(take("TEXCOORD_0", 2, 2));
        if (vertices.uvs.empty() && !extension["attributes"].has("TEXCOORD_0"))
            vertices.uvs = uvs_of_primitive(file_, primitive, 0);
        if (vertices.positions.empty())
            extension.fail("has no POSITION; export the file again");
        // Written values refer to these vertices.
        if (count != vertices.count())
            extension.fail(fmt::format("has {} vertices, but POSITION has {}; export the file again",
                                       grouped(vertices.count()), grouped(count)));
        vertices.corners.push_back(std::move(draco.indices));
        return vertices;
    }

    std::vector<std::uint32_t> corners_of(const GltfValue& primitive, std::size_t vertex_count) {
        std::vector<std::uint32_t> indices;
        if (primitive.has("indices")) {
            indices = GltfAccessor(file_, primitive["indices"].target(root_, "accessors"), 1, 1).indices();
            const auto too_large = std::find_if(indices.begin(), indices.end(),
                                                [&](std::uint32_t index) { return index >= vertex_count; });
            if (too_large != indices.end())
                primitive["indices"].fail(fmt::format("element {} is {}, but there are {} vertices; export the file "
                                                      "again",
                                                      grouped(static_cast<std::size_t>(too_large - indices.begin())),
                                                      *too_large, grouped(vertex_count)));
        } else {
            indices.resize(vertex_count);
            for (std::uint32_t i = 0; i < indices.size(); ++i)
                indices[i] = i;
        }
        return as_triangles(std::move(indices), primitive.count_or("mode", triangles));
    }

    void add(std::size_t placement_number) {
        const GltfPlacement& placement = document_->placements[placement_number];
        skinned_ += placement.is_skinned;
        for (const DecodedVertices& vertices : decoded(placement.mesh)) {
            const std::size_t first = mesh_.vertex_count();
            document_->vertices.push_back({placement_number, vertices.primitives, first, vertices.count()});
            add_vertices(vertices, placement.to_scene);
            for (std::size_t i = 0; i < vertices.primitives.size(); ++i)
                add_faces(vertices.corners[i], first, placement_number, vertices.primitives[i]);
        }
    }

    void add_vertices(const DecodedVertices& vertices, const glm::dmat4& to_scene) {
        const std::size_t first = mesh_.vertex_count(), count = vertices.count();
        const glm::dmat3 linear(to_scene);
        // The cofactors transform normals also where the matrix is singular (Pharr, Jakob and Humphreys 2016).
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
        mesh_.positions.resize(first + count);
        for (std::size_t v = 0; v < count; ++v) {
            const float* p = vertices.positions.data() + 3 * v;
            mesh_.positions[first + v] = linear * Vec3d(p[0], p[1], p[2]) + Vec3d(to_scene[3]);
        }
        if (!vertices.normals.empty()) {
            mesh_.normals.resize(first, Vec3(0.0f));
            for (std::size_t v = 0; v < count; ++v) {
                const float* n = vertices.normals.data() + 3 * v;
                mesh_.normals.push_back(unit_or_zero(side * (cofactors * Vec3d(n[0], n[1], n[2]))));
            }
        } else if (!mesh_.normals.empty()) {
            mesh_.normals.resize(first + count, Vec3(0.0f));
        }
        if (!vertices.uvs.empty()) {
            mesh_.vertex_uvs.resize(first, Vec2(0.0f));
            mesh_.vertex_uvs.insert(mesh_.vertex_uvs.end(), vertices.uvs.begin(), vertices.uvs.end());
        } else if (!mesh_.vertex_uvs.empty()) {
            mesh_.vertex_uvs.resize(first + count, Vec2(0.0f));
        }
        if (!vertices.colors.empty()) {
            mesh_.vertex_colors.resize(first, white);
            const auto step = static_cast<std::size_t>(vertices.color_components);
            for (std::size_t v = 0; v < count; ++v) {
                const float* c = vertices.colors.data() + step * v;
                mesh_.vertex_colors.push_back(srgb_color({c[0], c[1], c[2]}, step == 4 ? c[3] : 1.0f));
            }
        } else if (!mesh_.vertex_colors.empty()) {
            mesh_.vertex_colors.resize(first + count, white);
        }
    }

    void add_faces(const std::vector<std::uint32_t>& corners, std::size_t first_vertex, std::size_t placement_number,
                   std::size_t primitive_number) {
        if (corners.empty())
            return;
        const GltfPlacement& placement = document_->placements[placement_number];
        const GltfValue primitive = mesh_value(placement.mesh)["primitives"][primitive_number];
        const std::size_t first_face = mesh_.face_count();
        const bool mirrored = glm::determinant(glm::dmat3(placement.to_scene)) < 0.0;
        const std::size_t first_corner = mesh_.corners.size();
        mesh_.corners.resize(first_corner + corners.size());
        std::uint32_t* to = mesh_.corners.data() + first_corner;
        const std::array<std::size_t, 3> order{0, mirrored ? 2u : 1u, mirrored ? 1u : 2u};
        for (std::size_t c = 0; c < corners.size(); c += 3)
            for (const std::size_t k : order)
                *to++ = static_cast<std::uint32_t>(first_vertex) + corners[c + k];
        mesh_.face_begin.resize(first_face + 1 + corners.size() / 3);
        for (std::size_t f = first_face + 1; f < mesh_.face_begin.size(); ++f)
            mesh_.face_begin[f] = static_cast<std::uint32_t>(first_corner + 3 * (f - first_face));
        FaceGroup group{placement.names, static_cast<std::uint32_t>(first_face)};
        Color color = white;
        std::optional<std::size_t> material_number;
        if (primitive.has("material")) {
            const GltfValue material = primitive["material"].target(root_, "materials");
            material_number = primitive["material"].count();
            if (material.has("name"))
                group.names.push_back(material["name"].text().substr(0, FaceGroup::most_letters));
            group.see_through = material.text_or("alphaMode", "OPAQUE") != "OPAQUE";
            color = base_color(material);
        }
        mesh_.groups.push_back(std::move(group));
        document_->group_primitives.push_back({placement_number, primitive_number, material_number});
        if (color != white || !mesh_.face_colors.empty()) {
            mesh_.face_colors.resize(first_face, white);
            mesh_.face_colors.resize(mesh_.face_count(), color);
        }
    }

    static Color base_color(const GltfValue& material) {
        const std::optional<GltfValue> pbr = material.find("pbrMetallicRoughness");
        const std::optional<GltfValue> factor = pbr ? pbr->find("baseColorFactor") : std::nullopt;
        if (!factor || factor->size() != 4)
            return white;
        const auto at = [&](std::size_t i) { return static_cast<float>((*factor)[i].number()); };
        return srgb_color({at(0), at(1), at(2)}, at(3));
    }

    /// Rounds coordinates to floats, which other formats store, so that a scene and its copy in such a format have the
    /// same coordinates.
    void round_to_floats() {
        constexpr double tolerance = 1e-6; // of the diagonal
        const double diagonal = mesh_.box().diagonal();
        // A separate array, because GCC 12 at -O3 drops the conversion to float and back in a loop that works in place.
        const std::vector<Vec3> floats(mesh_.positions.begin(), mesh_.positions.end());
        for (std::size_t v = 0; v < floats.size(); ++v)
            if (is_finite(mesh_.positions[v]) &&
                !(glm::distance(Vec3d(floats[v]), mesh_.positions[v]) <= tolerance * diagonal))
                return;
        mesh_.positions.assign(floats.begin(), floats.end());
    }

    void warn() {
        if (left_out_ > 0)
            mesh_.warnings.push_back(counted(left_out_, "primitive is", "primitives are") +
                                     " points or lines, or without positions; kept, but ignored");
        if (skinned_ > 0)
            mesh_.warnings.push_back(counted(skinned_, "mesh is", "meshes are") +
                                     " deformed by a skeleton; baked in the bind pose");
        if (!morphed_.empty())
            mesh_.warnings.push_back(counted(morphed_.size(), "primitive has", "primitives have") +
                                     " morph targets; baked without them");
    }

    void describe_contents() {
        constexpr std::array<std::pair<const char*, const char*>, 7> arrays{{{"nodes", "node"},
                                                                             {"materials", "material"},
                                                                             {"textures", "texture"},
                                                                             {"animations", "animation"},
                                                                             {"skins", "skin"},
                                                                             {"cameras", "camera"},
                                                                             {"scenes", "scene"}}};
        for (const auto& [plural, singular] : arrays)
            if (root_.has(plural) && root_[plural].size() > 0)
                document_->content_counts.push_back(counted(root_[plural].size(), singular, plural));
        std::size_t sets = 0;
        for (const GltfVertices& vertices : document_->vertices) {
            const std::size_t mesh = document_->placements[vertices.placement].mesh;
            const GltfValue attributes = mesh_value(mesh)["primitives"][vertices.primitives.front()]["attributes"];
            std::size_t own = 0;
            while (attributes.has(fmt::format("TEXCOORD_{}", own).c_str()))
                ++own;
            sets = std::max(sets, own);
        }
        document_->uv_set_count = sets;
    }

    std::shared_ptr<GltfDocument> document_;
    GltfFile& file_;
    GltfValue root_;
    Mesh mesh_;
    std::map<std::size_t, std::vector<DecodedVertices>> decoded_; ///< by mesh
    std::size_t left_out_ = 0, skinned_ = 0;
    std::set<std::string> morphed_;
};

}

std::vector<Vec2> uvs_of_primitive(GltfFile& file, const GltfValue& primitive, std::size_t set) {
    const std::string name = fmt::format("TEXCOORD_{}", set);
    if (const std::optional<GltfValue> draco = draco_of(primitive); draco && (*draco)["attributes"].has(name.c_str())) {
        DracoMesh decoded = decode_draco(file, *draco);
        return as_uvs(take_attribute(decoded, *draco, name, 2, 2));
    }
    const std::optional<GltfValue> value = accessor_of(file.root(), primitive, name.c_str());
    if (!value)
        return {};
    const GltfAccessor accessor(file, *value, 2, 2);
    const std::size_t count = count_of_accessor(*accessor_of(file.root(), primitive, "POSITION"));
    if (accessor.count() != count)
        value->fail(fmt::format("{} has {} elements, but POSITION has {}; export the file again", name,
                                grouped(accessor.count()), grouped(count)));
    return as_uvs(accessor.floats());
}

Mesh read_gltf(const FileBytes& file) {
    return GltfReader(file).read();
}

}
