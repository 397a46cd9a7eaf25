#include "facts.h"

#include "alcove/base/detail/messages.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/detail/outlier_faces.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/formats/obj/obj_document.h"
#include "alcove/mesh/formats/ply/ply_document.h"
#include "alcove/mesh/triangulate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace alcove::cli {
namespace {

void add_faces(Facts& facts, const Diagnosis& diagnosis) {
    facts.add_count("vertices", diagnosis.vertices);
    std::vector<std::string> kinds;
    const std::size_t counts[] = {diagnosis.triangles, diagnosis.quads, diagnosis.larger_polygons};
    const char* const names[][2] = {
        {"triangle", "triangles"}, {"quad", "quads"}, {"larger polygon", "larger polygons"}};
    for (int kind = 0; kind < 3; ++kind)
        if (counts[kind] > 0)
            kinds.push_back(counted(counts[kind], names[kind][0], names[kind][1]));
    facts.add("faces", diagnosis.faces,
              kinds.empty() ? grouped(diagnosis.faces)
                            : fmt::format("{}: {}", grouped(diagnosis.faces), fmt::join(kinds, ", ")));
    facts.add("triangles", diagnosis.triangles);
    facts.add("quads", diagnosis.quads);
    facts.add("larger_polygons", diagnosis.larger_polygons);
}

void add_attributes(Facts& facts, const Mesh& mesh) {
    const bool normals = !mesh.normals.empty();
    facts.add("normals", normals, normals ? "one per vertex" : "none; angle-weighted ones will be used");
    const auto where = [&](const char* key, bool vertex, bool other, const char* name) {
        facts.add(key,
                  vertex  ? nlohmann::ordered_json("vertex")
                  : other ? nlohmann::ordered_json(name)
                          : nullptr,
                  vertex  ? "one per vertex"
                  : other ? fmt::format("one per {}", name)
                          : "none");
    };
    where("uvs", !mesh.vertex_uvs.empty(), !mesh.corner_uvs.empty(), "corner");
    where("colors", !mesh.vertex_colors.empty(), !mesh.face_colors.empty(), "face");
}

void add_ply(Facts& facts, const PlyDocument& document) {
    auto elements = nlohmann::ordered_json::array();
    std::vector<std::string> lines;
    for (const PlyElement& element : document.elements) {
        auto properties = nlohmann::ordered_json::array();
        std::vector<std::string> names;
        for (const PlyProperty& property : element.properties) {
            const std::string type{name_of(property.type)};
            properties.push_back({{"name", property.name}, {"type", type}, {"list", property.count_type.has_value()}});
            names.push_back(property.name);
        }
        elements.push_back({{"name", element.name}, {"count", element.count}, {"properties", properties}});
        lines.push_back(fmt::format("{} {}: {}", grouped(element.count), element.name, fmt::join(names, " ")));
    }
    facts.add("elements", elements, lines);
    lines.clear();
    constexpr std::string_view keyword = "comment ";
    for (const std::string& comment : document.comments)
        lines.push_back(comment.starts_with(keyword) ? comment.substr(keyword.size()) : comment);
    facts.add("comments", document.comments, lines);
}

void add_obj(Facts& facts, const ObjDocument& document) {
    auto other = nlohmann::ordered_json::object();
    for (const auto& [what, count] : document.other_lines)
        other[what] = count;
    facts.add("other_lines", other, document.other_line_counts());
}

void add_diagnosis(Facts& facts, const Diagnosis& d, const Mesh& mesh) {
    const std::pair<const char*, std::size_t> counts[] = {{"edges", d.edges},
                                                          {"open_edges", d.open_edges},
                                                          {"boundary_edges", d.boundary_edges},
                                                          {"boundary_loops", d.boundary_loops},
                                                          {"seam_edges", d.seam_edges()},
                                                          {"non_manifold_edges", d.non_manifold_edges},
                                                          {"non_manifold_vertices", d.non_manifold_vertices},
                                                          {"flipped_edges", d.flipped_edges},
                                                          {"components", d.components},
                                                          {"closed_components", d.closed_components},
                                                          {"inverted_components", d.inverted_components},
                                                          {"degenerate_faces", d.degenerate_faces},
                                                          {"duplicate_faces", d.duplicate_faces},
                                                          {"coincident_vertices", d.coincident_vertices},
                                                          {"unreferenced_vertices", d.unreferenced_vertices},
                                                          {"non_finite_vertices", d.non_finite_vertices},
                                                          {"closable_edges", d.closable_edges}};
    auto numbers = nlohmann::ordered_json::object();
    for (const auto& [name, count] : counts)
        numbers[name] = count;
    numbers["closing_distance"] = d.closing_distance;
    numbers["closed"] = d.closed();
    numbers["watertight"] = d.watertight();
    numbers["oriented"] = d.oriented();
    numbers["signed_volume"] = d.signed_volume;
    facts.add("diagnosis", numbers);
    facts.add("parts", d.components,
              d.closed_components > 0
                  ? fmt::format("{}, {} of them closed, with a volume of {:.6g}", grouped(d.components),
                                d.closed_components == d.components ? "all" : grouped(d.closed_components),
                                d.signed_volume)
                  : fmt::format("{}, none of them closed", grouped(d.components)));
    std::vector<std::string> findings = describe(d);
    if (const std::optional<OutlierFaces> outliers = find_outlier_faces(mesh))
        findings.push_back(outliers->text(mesh) + ": remove the outliers, or give lengths in scene units");
    facts.add("findings", findings, findings);
}

/// Adds the sign that a bake would choose.
void add_sign(Facts& facts, const Mesh& mesh, bool is_closed) {
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    if (mesh.face_count() == 0)
        return facts.add("sign", nullptr, "none: the file contains points, and a bake reconstructs their surface");
    if (triangles.empty())
        return facts.add("sign", nullptr, "none: there is nothing to bake");
    try {
        const bool solid = sign_of(mesh, triangles) == Sign::solid;
        facts.add("sign", solid ? "solid" : "sheet",
                  solid ? "a solid"
                  : is_closed
                      ? "a sheet, although it is closed: it is inside out, crosses itself, or has parts inside others"
                      : "a sheet: both sides of the faces count as outside, and there is no inside");
    } catch (const LimitError&) {
        facts.add("sign", nullptr, "unknown: no grid fits in memory");
    }
}

}

Facts facts_of_mesh(const Mesh& mesh) {
    const Diagnosis diagnosis = diagnose(mesh);
    Facts facts;
    facts.add("kind", mesh.face_count() > 0 ? "mesh" : "points");
    facts.add("format", mesh.format, std::string(mesh.format));
    add_faces(facts, diagnosis);
    const Box box = mesh.box();
    facts.add_box(box);
    const double diagonal = box.empty() ? 0.0 : box.diagonal();
    facts.add("diagonal", diagonal, fmt::format("{:.6g}", diagonal));
    add_attributes(facts, mesh);
    if (const auto* ply = dynamic_cast<const PlyDocument*>(mesh.source.get()))
        add_ply(facts, *ply);
    if (const auto* obj = dynamic_cast<const ObjDocument*>(mesh.source.get()))
        add_obj(facts, *obj);
    if (mesh.face_count() > 0)
        add_diagnosis(facts, diagnosis, mesh);
    add_sign(facts, mesh, diagnosis.closed());
    facts.add("warnings", mesh.warnings, mesh.warnings);
    return facts;
}

}
