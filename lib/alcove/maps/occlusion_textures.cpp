#include "alcove/bake/detail/selection.h"
#include "alcove/base/detail/file_kind.h"
#include "alcove/base/detail/messages.h"
#include "alcove/maps/detail/map_provenance.h"
#include "alcove/maps/detail/packed_texture.h"
#include "alcove/maps/detail/rasterize.h"
#include "alcove/maps/detail/uv_faces.h"
#include "alcove/maps/detail/uv_layout.h"
#include "alcove/maps/maps.h"
#include "alcove/mesh/formats/gltf/gltf_document.h"
#include "alcove/mesh/formats/gltf/gltf_images.h"
#include "alcove/mesh/formats/gltf/gltf_write.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace alcove {
namespace {

/// The faces of each material. Of a mesh with several instances, only the faces of the first instance.
class MaterialFaces {
  public:
    MaterialFaces(const Mesh& mesh, const GltfDocument* document, const FaceSelection& selection) {
        std::vector<std::uint8_t> baked(mesh.face_count(), 1);
        if (!selection.empty())
            baked = select_faces(mesh, selection).baked;
        if (document == nullptr) {
            faces_[{}] = std::move(baked);
            return;
        }
        std::map<std::size_t, std::size_t> first; // first placement of each mesh
        for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
            const std::size_t begin = mesh.groups[g].first_face, end = mesh.group_end(g);
            if (!baked[begin])
                continue;
            const auto& [placement, primitive, material] = document->group_primitives[g];
            if (first.try_emplace(document->placements[placement].mesh, placement).first->second != placement) {
                others_.insert(placement);
                continue;
            }
            std::vector<std::uint8_t>& own = faces_[material];
            own.resize(mesh.face_count(), 0);
            std::fill(own.begin() + static_cast<std::ptrdiff_t>(begin), own.begin() + static_cast<std::ptrdiff_t>(end),
                      1);
            primitives_[material].insert({document->placements[placement].mesh, primitive});
        }
    }

    const std::map<std::optional<std::size_t>, std::vector<std::uint8_t>>& faces() const { return faces_; }
    /// The primitives with a material: pairs of a mesh of the file and a primitive in it.
    std::vector<std::pair<std::size_t, std::size_t>> primitives(const std::optional<std::size_t>& material) const {
        const auto found = primitives_.find(material);
        if (found == primitives_.end())
            return {};
        return {found->second.begin(), found->second.end()};
    }
    std::size_t other_instances() const { return others_.size(); }

  private:
    std::map<std::optional<std::size_t>, std::vector<std::uint8_t>> faces_;
    std::map<std::optional<std::size_t>, std::set<std::pair<std::size_t, std::size_t>>> primitives_;
    std::set<std::size_t> others_;
};

/// Whether every face of a layout has texels of its own: when rasterized, at most a thousandth of the texels overlap,
/// and all UVs lie in the texture.
bool is_unwrapped(const Mesh& mesh, const UvLayout& layout, const MapOptions& options) {
    constexpr float rounding = 1e-3f;
    const UvFaces faces(mesh, {NormalSource::automatic, layout.uv_set, layout.wanted});
    if (faces.without_texels() > 0)
        return false;
    for (const UvTriangle& uvs : faces.uvs())
        for (const Vec2& uv : uvs)
            if (std::max(std::fabs(uv.x - 0.5f), std::fabs(uv.y - 0.5f)) > 0.5f + rounding)
                return false;
    const TexelOwners owners = rasterize(faces.uvs(), {options.width, options.height});
    const auto covered = owners.size() - static_cast<std::size_t>(
                                             std::count(owners.triangles.begin(), owners.triangles.end(), no_triangle));
    constexpr double most = 1e-3;
    return covered > 0 && static_cast<double>(owners.overlaps) <= most * static_cast<double>(covered);
}

/// The names of the meshes of the wanted faces, for a message.
std::string names_of_meshes(const Mesh& mesh, const GltfDocument* document, const std::vector<std::uint8_t>& wanted) {
    std::set<std::string> names;
    if (document != nullptr)
        for (std::size_t g = 0; g < mesh.groups.size(); ++g)
            if (wanted[mesh.groups[g].first_face]) {
                const std::size_t number = document->placements[document->group_primitives[g].placement].mesh;
                names.insert(
                    in_quotes(document->file->root()["meshes"][number].text_or("name", fmt::format("{}", number))));
            }
    constexpr std::size_t most = 5;
    if (names.empty())
        return "the mesh";
    const std::size_t more = names.size() > most ? names.size() - most : 0;
    while (names.size() > most)
        names.erase(std::prev(names.end()));
    return fmt::format("{} {}{}", names.size() + more == 1 ? "mesh" : "meshes", fmt::join(names, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
}

/// The set of UVs for the texture of some faces: `preferred`, or else the first set without overlaps.
UvLayout choose_uvs(const Mesh& mesh, const GltfDocument* document, const std::vector<std::uint8_t>& faces,
                    const MapOptions& options, std::optional<std::size_t> preferred) {
    const int sets = document ? static_cast<int>(document->uv_sets()) : 1;
    UvLayout layout{0, faces};
    if (preferred && *preferred < static_cast<std::size_t>(sets)) {
        layout.uv_set = static_cast<int>(*preferred);
        if (is_unwrapped(mesh, layout, options))
            return layout;
    }
    for (layout.uv_set = 0; layout.uv_set < sets; ++layout.uv_set)
        if (is_unwrapped(mesh, layout, options))
            return layout;
    const std::string names = names_of_meshes(mesh, document, faces);
    throw InputError(fmt::format(
        "{}{} {} no set of UVs without overlaps inside the texture, which an occlusion texture needs: unwrap it, bake "
        "it to vertices (--into vertices), or leave it out (--exclude)",
        mesh.name.empty() ? "" : mesh.name + ": ", names, names.starts_with("meshes") ? "have" : "has"));
}

std::string name_of_material(const GltfDocument* document, const std::optional<std::size_t>& material) {
    if (document == nullptr || !material)
        return "no material";
    return in_quotes(document->file->root()["materials"][*material].text_or("name", fmt::format("{}", *material)));
}

/// A warning that materials got textures of their own, although ao was to be packed.
std::string not_packed(const std::vector<std::string>& materials) {
    constexpr std::size_t most = 5;
    const std::size_t named = std::min(materials.size(), most);
    return fmt::format("--pack-orm: {} instead of being packed: {}{} {} no metallic-roughness texture "
                       "on UVs without overlaps",
                       counted(materials.size(), "occlusion texture gets an image of its own",
                               "occlusion textures get images of their own"),
                       fmt::join(materials.begin(), materials.begin() + static_cast<std::ptrdiff_t>(named), ", "),
                       materials.size() > most ? fmt::format(" and {} more", materials.size() - most) : "",
                       materials.size() == 1 ? "has" : "have");
}

}

OcclusionTextures bake_occlusion_textures(const Mesh& mesh, const BakeOptions& bake, const MapOptions& options,
                                          TexturePacking packing) {
    check(options);
    const auto* document = dynamic_cast<const GltfDocument*>(mesh.source.get());
    OcclusionTextures result;
    std::vector<UvLayout> layouts;
    std::vector<std::string> own_images;
    MapSize largest;
    const MaterialFaces materials(mesh, document, bake.faces);
    for (const auto& [material, faces] : materials.faces()) {
        std::optional<std::size_t> packed_set;
        if (packing != TexturePacking::none && document != nullptr && material)
            packed_set = metallic_roughness_uv_set(*document->file, *material);
        layouts.push_back(choose_uvs(mesh, document, faces, options, packed_set));
        const int uv_set = layouts.back().uv_set;
        result.textures.push_back({material, materials.primitives(material), uv_set, options.width, options.height});
        OcclusionTextures::Texture& texture = result.textures.back();
        texture.is_packed = packed_set == static_cast<std::size_t>(uv_set);
        if (texture.is_packed) {
            const GltfImage image = metallic_roughness_image(*document->file, *material);
            const MapSize size = size_of(image);
            if (packing == TexturePacking::size_of_image)
                std::tie(texture.width, texture.height) = std::tie(size.width, size.height);
            check_packing(image, {texture.width, texture.height});
            largest = {std::max(largest.width, texture.width), std::max(largest.height, texture.height)};
        } else if (packing != TexturePacking::none) {
            own_images.push_back(name_of_material(document, material));
        }
    }
    BakeOptions ao = bake;
    ao.attributes = Channel::ao;
    MapOptions plain;
    plain.width = largest.width > 0 ? std::min(largest.width, largest_map) : options.width;
    plain.height = largest.height > 0 ? std::min(largest.height, largest_map) : options.height;
    plain.subsamples = options.subsamples;
    plain.margin = options.margin;
    for (OcclusionTextures::Texture& texture : result.textures)
        if (!texture.is_packed)
            std::tie(texture.width, texture.height) = std::tie(plain.width, plain.height);
    result.maps = bake_layouts(mesh, ao, plain, layouts);
    if (!own_images.empty())
        result.maps.baked.warnings.push_back(not_packed(own_images));
    if (materials.other_instances() > 0)
        result.maps.baked.warnings.push_back(
            fmt::format("{} the texture of the first instance of the same mesh: bake to vertices to give each its own "
                        "values",
                        counted(materials.other_instances(), "instance shows", "instances show")));
    return result;
}

std::vector<std::string> write_occlusion_textures(const Mesh& mesh, const OcclusionTextures& textures,
                                                  const std::filesystem::path& file) {
    if (lower_extension(file) != ".glb" && lower_extension(file) != ".gltf")
        throw InputError(file.string() + ": textures are written into a .glb or .gltf: use one of these extensions");
    const auto* document = dynamic_cast<const GltfDocument*>(mesh.source.get());
    const BakedMaps& maps = textures.maps;
    const std::vector<PngText> texts = png_texts(maps);
    std::vector<GltfTexture> images;
    for (std::size_t i = 0; i < textures.textures.size(); ++i) {
        const OcclusionTextures::Texture& texture = textures.textures[i];
        const std::vector<float>& ao = maps.tiles[i].layers.front().values;
        GltfTexture& image = images.emplace_back(GltfTexture{texture.material, texture.primitives, texture.uv_set, ""});
        image.comment = fmt::format("{}: {}", map_software(), how_made(maps));
        image.is_packed = texture.is_packed;
        if (texture.is_packed) {
            image.png = pack_occlusion(ao, {maps.width, maps.height},
                                       metallic_roughness_image(*document->file, *texture.material),
                                       {texture.width, texture.height}, texts);
        } else {
            std::vector<std::uint16_t> bytes(ao.size());
            std::transform(ao.begin(), ao.end(), bytes.begin(), [](float value) {
                return static_cast<std::uint16_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
            });
            image.png = encode_png_file(maps.width, maps.height, 1, 8, bytes, texts);
        }
    }
    return write_gltf(mesh, file, images);
}

}
