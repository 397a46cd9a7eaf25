#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/srgb.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/gltf/gltf_accessor.h"
#include "alcove/mesh/formats/gltf/gltf_document.h"
#include "alcove/mesh/formats/gltf/gltf_primitive.h"
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

constexpr Color white{255, 255, 255, 255};

constexpr std::array<std::string_view, 4> geometry_extensions{"KHR_mesh_quantization", "EXT_meshopt_compression",
                                                              "KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing"};
/// Prefixes of extensions that do not change geometry.
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

class GltfReader {
  public:
    explicit GltfReader(const FileBytes& bytes)
        : document_(std::make_shared<GltfDocument>(bytes)), file_(*document_->file), root_(file_.root()) {}

    Mesh read() {
        check_extensions(root_);
        document_->placements = placements_of(file_);
        check_size();
        for (const GltfPlacement& placement : document_->placements)
            ++uses_[placement.mesh];
        for (std::size_t p = 0; p < document_->placements.size(); ++p) {
            add(p);
            if (const std::size_t mesh = document_->placements[p].mesh; --uses_[mesh] == 0)
                primitives_.erase(mesh);
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

    /// Counts the vertices and corners of all instances before any are decoded, and makes room for them.
    void check_size() {
        struct Size {
            double vertices = 0.0, corners = 0.0, groups = 0.0;
            std::size_t shared = 0; // vertices; those that several primitives share count once
        };
        std::map<std::size_t, Size> sizes; // by mesh
        Size all;
        for (const GltfPlacement& placement : document_->placements) {
            const auto [known, is_new] = sizes.try_emplace(placement.mesh);
            if (is_new) {
                const GltfValue primitives = mesh_value(placement.mesh)["primitives"];
                std::set<std::string> attributes;
                for (std::size_t i = 0; i < primitives.size(); ++i) {
                    if (!is_surface(primitives[i]))
                        continue;
                    const GltfValue positions = *accessor_of(root_, primitives[i], "POSITION");
                    const GltfAccessor checked(file_, positions, 3, 3); // checks that the count fits the buffer view
                    const auto count = static_cast<double>(checked.count());
                    known->second.vertices += count;
                    known->second.groups += 1.0;
                    known->second.corners += most_corners(root_, primitives[i], checked.count());
                    if (attributes.insert(primitives[i]["attributes"].json().dump()).second)
                        known->second.shared += checked.count();
                }
            }
            all.vertices += known->second.vertices;
            all.corners += known->second.corners;
            all.groups += known->second.groups + 1.0;
            all.shared += known->second.shared;
        }
        constexpr double bytes_per_vertex = sizeof(Vec3d) + sizeof(Vec3) + sizeof(Vec2) + sizeof(Color);
        constexpr double bytes_per_corner = sizeof(std::uint32_t) * (1.0 + 1.0 / 3.0);
        constexpr double bytes_per_group = 1024.0; // including its names
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
        vertex_room_ = all.shared;
        reserve_huge(mesh_.corners, static_cast<std::size_t>(all.corners));
        reserve_huge(mesh_.face_begin, static_cast<std::size_t>(all.corners) / 3 + 1);
    }

    const std::vector<GltfPrimitives>& primitives_of(std::size_t mesh) {
        const auto [known, is_new] = primitives_.try_emplace(mesh);
        if (is_new) {
            known->second = find_primitives(mesh_value(mesh));
            if (uses_[mesh] > 1) // otherwise they are decoded straight into the mesh
                for (GltfPrimitives& primitives : known->second)
                    primitives.keep();
        }
        return known->second;
    }

    std::vector<GltfPrimitives> find_primitives(const GltfValue& mesh) {
        std::vector<GltfPrimitives> all;
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
            if (is_draco(primitive)) {
                all.push_back(vertices_of(file_, primitive));
                all.back().numbers.push_back(i);
                continue;
            }
            const auto [same, is_new] = by_attributes.try_emplace(primitive["attributes"].json().dump(), all.size());
            if (is_new)
                all.push_back(vertices_of(file_, primitive));
            GltfPrimitives& shared = all[same->second];
            shared.numbers.push_back(i);
            shared.corners.push_back(corners_of(file_, primitive, shared.count()));
        }
        return all;
    }

    void add(std::size_t placement_number) {
        const GltfPlacement& placement = document_->placements[placement_number];
        skinned_ += placement.is_skinned;
        for (const GltfPrimitives& primitives : primitives_of(placement.mesh)) {
            const std::size_t first = mesh_.vertex_count();
            document_->vertices.push_back({placement_number, primitives.numbers, first, primitives.count()});
            // In parallel if this saves time: neither part needs what the other adds.
            constexpr std::size_t many = 10'000; // vertices
            parallel_for(2, primitives.count() < many ? 2 : 1, [&](std::size_t begin, std::size_t end) {
                if (begin == 0)
                    add_vertices(primitives, placement.to_scene);
                if (end == 2)
                    for (std::size_t i = 0; i < primitives.numbers.size(); ++i)
                        add_faces(primitives.corners[i], first, placement_number, primitives.numbers[i]);
            });
        }
    }

    void add_vertices(const GltfPrimitives& vertices, const glm::dmat4& to_scene) {
        const std::size_t first = mesh_.vertex_count();
        const glm::dmat3 linear(to_scene);
        // The cofactors transform normals even if the matrix is singular (Pharr, Jakob and Humphreys 2016).
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        const double side = glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
        add_values(mesh_.positions, first, vertices.positions, 3,
                   [&](const float* p) { return linear * Vec3d(p[0], p[1], p[2]) + Vec3d(to_scene[3]); });
        are_floats_ = are_floats_ && to_scene == glm::dmat4(1.0);
        add_values(mesh_.normals, first, vertices.normals, 3,
                   [&](const float* n) { return unit_or_zero(side * (cofactors * Vec3d(n[0], n[1], n[2]))); });
        add_values(mesh_.vertex_uvs, first, vertices.uvs, 2, [](const float* uv) { return as_uv(uv); });
        const auto step = static_cast<std::size_t>(vertices.color_components);
        add_values(
            mesh_.vertex_colors, first, vertices.colors, step,
            [&](const float* c) {
                return srgb_color({c[0], c[1], c[2]}, step == 4 ? c[3] : 1.0f);
            },
            white);
    }

    /// Appends the values of new vertices to those of the vertices before index `first`. If only one of the two groups
    /// has values, the other gets `missing`.
    template <class T, class Convert>
    void add_values(std::vector<T>& values, std::size_t first, const GltfArray<float>& floats, std::size_t components,
                    const Convert& convert, const T& missing = T(0.0f)) {
        if (floats.empty() && values.empty())
            return;
        if (values.empty())
            reserve_huge(values, vertex_room_);
        values.resize(first, missing);
        std::vector<T> converted; // stays in the cache, so that fresh memory is written only once
        floats.for_each_block([&](std::span<const float> block) {
            converted.clear();
            for (std::size_t i = 0; i < block.size(); i += components)
                converted.push_back(convert(block.data() + i));
            values.insert(values.end(), converted.begin(), converted.end());
        });
        values.resize(mesh_.vertex_count(), missing);
    }

    void add_faces(const GltfArray<std::uint32_t>& corners, std::size_t first_vertex, std::size_t placement_number,
                   std::size_t primitive_number) {
        if (corners.empty())
            return;
        const GltfPlacement& placement = document_->placements[placement_number];
        const GltfValue primitive = mesh_value(placement.mesh)["primitives"][primitive_number];
        const std::size_t first_face = mesh_.face_count();
        add_triangles(corners, static_cast<std::uint32_t>(first_vertex),
                      glm::determinant(glm::dmat3(placement.to_scene)) < 0.0);
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

    void add_triangles(const GltfArray<std::uint32_t>& corners, std::uint32_t first_vertex, bool mirrored) {
        const std::size_t second = mirrored ? 2 : 1, third = mirrored ? 1 : 2;
        corners.for_each_block([&](std::span<const std::uint32_t> block) {
            const std::size_t first = mesh_.corners.size(), first_face = mesh_.face_begin.size();
            mesh_.corners.resize(first + block.size());
            std::uint32_t* const to = mesh_.corners.data() + first;
            for (std::size_t c = 0; c < block.size(); c += 3) {
                to[c] = first_vertex + block[c];
                to[c + 1] = first_vertex + block[c + second];
                to[c + 2] = first_vertex + block[c + third];
            }
            mesh_.face_begin.resize(first_face + block.size() / 3);
            for (std::size_t f = 0; f < block.size() / 3; ++f)
                mesh_.face_begin[first_face + f] = static_cast<std::uint32_t>(first + 3 * (f + 1));
        });
    }

    static Color base_color(const GltfValue& material) {
        const std::optional<GltfValue> pbr = material.find("pbrMetallicRoughness");
        const std::optional<GltfValue> factor = pbr ? pbr->find("baseColorFactor") : std::nullopt;
        if (!factor || factor->size() != 4)
            return white;
        const auto at = [&](std::size_t i) { return static_cast<float>((*factor)[i].number()); };
        return srgb_color({at(0), at(1), at(2)}, at(3));
    }

    /// Rounds coordinates to floats. Other formats store floats, so a scene and its copy in such a format then have the
    /// same coordinates.
    void round_to_floats() {
        if (are_floats_)
            return;
        double largest = 0.0; // distance by which rounding moves a vertex
        for (const Vec3d& p : mesh_.positions)
            if (const Vec3d rounded{Vec3(p)}; rounded != p && is_finite(p))
                largest = std::max(largest, glm::distance(rounded, p));
        constexpr double tolerance = 1e-6; // of the diagonal
        if (!(largest <= tolerance * mesh_.box().diagonal()))
            return;
        // A separate array, because GCC 12 at -O3 drops the conversion to float and back in a loop that works in place.
        constexpr std::size_t block = 4096;
        for (std::size_t v = 0; v < mesh_.positions.size(); v += block) {
            const auto first = mesh_.positions.begin() + static_cast<std::ptrdiff_t>(v);
            const auto end = first + static_cast<std::ptrdiff_t>(std::min(block, mesh_.positions.size() - v));
            const std::vector<Vec3> floats(first, end);
            std::copy(floats.begin(), floats.end(), first);
        }
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
    std::size_t vertex_room_ = 0;
    std::map<std::size_t, std::size_t> uses_;                       ///< placements of each mesh that are still to come
    std::map<std::size_t, std::vector<GltfPrimitives>> primitives_; ///< by mesh
    bool are_floats_ = true;                                        ///< whether no transform has moved a vertex
    std::size_t left_out_ = 0, skinned_ = 0;
    std::set<std::string> morphed_;
};

}

Mesh read_gltf(const FileBytes& file) {
    return GltfReader(file).read();
}

}
