// Format: the MTL chapter of Wavefront (1993).
#include "alcove/mesh/formats/obj/materials.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/formats/obj/obj_document.h"
#include "alcove/mesh/formats/text_encoding.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

namespace alcove {
namespace {

struct Material {
    std::optional<Vec3> diffuse{};       // Kd
    std::optional<double> opacity{};     // d, or else 1 - Tr
    std::vector<std::string> textures{}; // the keywords of its textures
    bool emits = false;                  // whether Ke is not black
};
using Materials = std::map<std::string, Material, std::less<>>;

/// The text without blanks at its ends.
std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\v\f\r";
    const std::size_t first = text.find_first_not_of(blanks);
    return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

/// Removes the first word from the text and returns it.
std::string_view next_word(std::string_view& text) {
    text = trimmed(text);
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    return word;
}

std::optional<double> number(std::string_view word) {
    double value = 0.0;
    const auto [end, error] = fast_float::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        return {};
    return value;
}

/// Red, green and blue, or one number for all three.
std::optional<Vec3> color(std::string_view values) {
    const std::optional<double> red = number(next_word(values));
    if (!red)
        return {};
    const std::optional<double> green = number(next_word(values)), blue = number(next_word(values));
    return glm::clamp(Vec3(Vec3d(*red, green.value_or(*red), blue.value_or(green.value_or(*red)))), 0.0f, 1.0f);
}

bool is_texture(std::string_view keyword) {
    constexpr std::array<std::string_view, 5> others{"bump", "disp", "decal", "refl", "norm"};
    return keyword.starts_with("map_") || std::find(others.begin(), others.end(), keyword) != others.end();
}

void read_property(std::string_view keyword, std::string_view values, Material& material) {
    std::string lower(keyword);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    if (lower == "kd")
        material.diffuse = color(values);
    else if (lower == "d")
        material.opacity = number(values.starts_with("-halo") ? trimmed(values.substr(5)) : values);
    else if (lower == "tr" && !material.opacity)
        material.opacity = 1.0 - number(values).value_or(0.0);
    else if (lower == "ke")
        material.emits = color(values).value_or(Vec3(0.0f)) != Vec3(0.0f);
    else if (is_texture(lower))
        material.textures.emplace_back(keyword);
}

/// Adds the materials in the text of a file. If a name occurs twice, the first material counts.
void parse(std::string_view text, Materials& materials) {
    Material ignored, *current = &ignored; // properties before the first name belong to no material
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view values = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string_view keyword = next_word(values);
        values = trimmed(values);
        if (keyword == "newmtl") {
            const auto [place, is_new] = materials.try_emplace(std::string(values));
            current = is_new ? &place->second : &ignored;
        } else {
            read_property(keyword, values, *current);
        }
    }
}

/// The path of a file that an OBJ in `folder` names. Accepts backslashes, and falls back to a file of that name beside
/// the OBJ.
std::optional<std::filesystem::path> find_file(std::string name, const std::filesystem::path& folder) {
    std::replace(name.begin(), name.end(), '\\', '/');
    for (const std::filesystem::path& file : {folder / name, folder / std::filesystem::path(name).filename()}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(file, error))
            return file;
    }
    return {};
}

/// The names in a 'mtllib' line: one name, which may contain blanks or be in quotes, or several names.
std::vector<std::string> names_in(std::string_view line, const std::filesystem::path& folder) {
    if (line.size() > 1 && line.front() == '"' && line.back() == '"')
        line = line.substr(1, line.size() - 2);
    std::vector<std::string> names{std::string(line)};
    if (find_file(names.front(), folder))
        return names;
    names.clear();
    while (!trimmed(line).empty())
        names.emplace_back(next_word(line));
    return names;
}

void read_file(const std::string& name, const std::filesystem::path& folder, Materials& materials,
               std::vector<std::string>& warnings) {
    const std::optional<std::filesystem::path> file = find_file(name, folder);
    if (!file) {
        warnings.push_back("the material file " + in_quotes(name) +
                           " is missing: put it beside the mesh, to show its materials");
        return;
    }
    try {
        const FileBytes bytes(*file);
        refuse_wide_text(bytes);
        parse(without_byte_order_mark(bytes.view()), materials);
    } catch (const std::runtime_error& error) {
        warnings.push_back(std::string(error.what()) + "; its materials are not shown");
    }
}

/// A line about the properties of the used materials that the image does not show; empty if there are none.
std::string left_out(const std::set<const Material*>& used) {
    std::size_t textures = 0, transparent = 0, emitting = 0;
    std::set<std::string_view> keywords;
    for (const Material* material : used) {
        textures += material->textures.size();
        keywords.insert(material->textures.begin(), material->textures.end());
        transparent += material->opacity.value_or(1.0) < 1.0;
        emitting += material->emits;
    }
    std::vector<std::string> parts;
    if (textures > 0)
        parts.push_back(fmt::format("{} ({})", counted(textures, "texture", "textures"), fmt::join(keywords, ", ")));
    if (transparent > 0)
        parts.push_back("the transparency of " + counted(transparent, "material", "materials"));
    if (emitting > 0)
        parts.push_back("the light of " + counted(emitting, "material", "materials"));
    return parts.empty() ? "" : fmt::format("not shown: {}; materials are shown by their Kd", fmt::join(parts, ", "));
}

/// Gives the faces of each material use the Kd of that material.
void assign(const Materials& materials, const ObjDocument& document, FaceMaterials& result) {
    std::set<std::string_view> without;
    std::set<const Material*> used;
    for (std::size_t i = 0; i < document.material_uses.size(); ++i) {
        const auto& [first, name] = document.material_uses[i];
        const bool is_last = i + 1 == document.material_uses.size();
        const std::size_t end = is_last ? result.diffuse.size() : document.material_uses[i + 1].first_face;
        if (first == end)
            continue;
        const auto found = materials.find(name);
        if (found != materials.end())
            used.insert(&found->second);
        if (found != materials.end() && found->second.diffuse)
            std::fill(result.diffuse.begin() + static_cast<std::ptrdiff_t>(first),
                      result.diffuse.begin() + static_cast<std::ptrdiff_t>(end), found->second.diffuse);
        else
            without.insert(name);
    }
    if (!without.empty() && result.warnings.empty()) // else a missing file is the cause
        result.warnings.push_back(fmt::format("{} no colour (Kd) in a material file (first: {}); grey is used",
                                              counted(without.size(), "material has", "materials have"),
                                              in_quotes(*without.begin())));
    if (std::string missing = left_out(used); !missing.empty())
        result.warnings.push_back(std::move(missing));
}

}

bool has_materials(const Mesh& mesh) {
    const auto* document = dynamic_cast<const ObjDocument*>(mesh.source.get());
    return document && !document->material_uses.empty();
}

FaceMaterials read_materials(const Mesh& mesh) {
    FaceMaterials result;
    if (!has_materials(mesh))
        return result;
    const auto& document = dynamic_cast<const ObjDocument&>(*mesh.source);
    const std::filesystem::path folder = std::filesystem::path(mesh.name).parent_path();
    Materials materials;
    for (const std::string& line : document.material_files)
        for (const std::string& name : names_in(line, folder))
            read_file(name, folder, materials, result.warnings);
    result.diffuse.resize(mesh.face_count());
    assign(materials, document, result);
    return result;
}

}
