#include "mesh_checks.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/gltf/gltf_document.h"
#include "alcove/mesh/formats/obj/obj_document.h"
#include "alcove/mesh/formats/ply/ply_document.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "checks.h"

#include <algorithm>
#include <cmath>

namespace alcove::fuzz {
namespace {

bool is_unit_or_zero(const Vec3& n) {
    return n == Vec3(0.0f) || std::fabs(glm::length(n) - 1.0f) < 1e-5f;
}

template <class T>
void check_size(const std::vector<T>& values, std::size_t wanted, std::string_view what) {
    require(values.empty() || values.size() == wanted, what);
}

void check_arrays(const Mesh& mesh) {
    require(mesh.face_begin.front() == 0 && mesh.face_begin.back() == mesh.corners.size(), "faces cover all corners");
    require(std::is_sorted(mesh.face_begin.begin(), mesh.face_begin.end()), "faces follow each other");
    require(std::all_of(mesh.corners.begin(), mesh.corners.end(), [&](auto v) { return v < mesh.vertex_count(); }),
            "indices are in range");
    check_size(mesh.normals, mesh.vertex_count(), "one normal per vertex");
    check_size(mesh.vertex_uvs, mesh.vertex_count(), "one texture coordinate per vertex");
    check_size(mesh.vertex_colors, mesh.vertex_count(), "one colour per vertex");
    check_size(mesh.corner_uvs, mesh.corners.size(), "one texture coordinate per corner");
    check_size(mesh.corner_normals, mesh.corners.size(), "one normal per corner");
    check_size(mesh.face_colors, mesh.face_count(), "one colour per face");
    require(mesh.vertex_uvs.empty() || mesh.corner_uvs.empty(), "only vertices or corners have texture coordinates");
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
        require(
            mesh.groups[g].first_face < mesh.face_count() &&
                (g == 0 ? mesh.groups[g].first_face == 0 : mesh.groups[g - 1].first_face < mesh.groups[g].first_face),
            "groups cover all faces, in order");
    require(std::all_of(mesh.normals.begin(), mesh.normals.end(), is_unit_or_zero), "normals have length 1 or 0");
}

/// The count at the start of the warning that contains `words`; "0" if there is none.
std::string counted_in_warnings(const Mesh& mesh, std::string_view words) {
    for (const std::string& warning : mesh.warnings)
        if (warning.find(words) != std::string::npos)
            return warning.substr(0, warning.find(' '));
    return "0";
}

void check_warnings(const Mesh& mesh) {
    const auto infinite =
        mesh.vertex_count() -
        static_cast<std::size_t>(std::count_if(mesh.positions.begin(), mesh.positions.end(), is_finite));
    require(counted_in_warnings(mesh, "coordinates that are not finite") == grouped(infinite),
            "vertices that are not finite are counted in a warning");
    std::size_t degenerate = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        degenerate += mesh.face(f).size() < 3;
    require(counted_in_warnings(mesh, "fewer than three corners") == grouped(degenerate),
            "faces of fewer than three corners are counted in a warning");
    for (const std::string& warning : mesh.warnings)
        check_message(warning, "");
}

void check_source(const Mesh& mesh) {
    if (const auto* ply = dynamic_cast<const PlyDocument*>(mesh.source.get())) {
        require(ply->find("vertex")->count == mesh.vertex_count(), "all vertices of the header were read");
        const PlyElement* faces = ply->find("face");
        require((faces ? faces->count : 0) == mesh.face_count(), "all faces of the header were read");
    }
    if (const auto* gltf = dynamic_cast<const GltfDocument*>(mesh.source.get())) {
        require(gltf->vertex_count() == mesh.vertex_count(), "all vertices belong to a primitive");
        require(gltf->group_primitives.size() == mesh.groups.size(), "every group has a primitive");
        for (std::size_t set = 0; set < gltf->uv_sets(); ++set)
            require(gltf->uv_set(set).size() == mesh.vertex_count(), "one texture coordinate per vertex");
    }
    if (const auto* obj = dynamic_cast<const ObjDocument*>(mesh.source.get()))
        require(obj->vertex_lines.size() == mesh.vertex_count(), "every vertex has a line");
}

void check_triangles(const Mesh& mesh, const Triangulation& cut) {
    for (const Triangle& t : cut.triangles) {
        require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "triangles have three vertices");
        for (const std::uint32_t v : t)
            require(v < mesh.vertex_count() && is_finite(mesh.positions[v]), "the vertices of triangles are finite");
    }
    require(cut.faces_left_out <= mesh.face_count() && mesh.face_count() - cut.faces_left_out <= cut.triangles.size(),
            "every face is triangulated or left out");
}

void check_surfels(const Mesh& mesh, const std::vector<Triangle>& triangles) {
    const Frame frame = frame_of(mesh.box());
    require(is_finite(frame.center) && std::isfinite(frame.diagonal) && frame.diagonal > 0.0, "the frame is finite");
    const std::vector<Surfel> surfels = make_surfels(mesh, triangles, frame);
    require(surfels.size() == mesh.vertex_count(), "one surfel per vertex");
    for (const Surfel& surfel : surfels) {
        require(is_unit_or_zero(surfel.normal), "normals of surfels have length 1 or 0");
        require(!surfel.has_normal() || glm::length(surfel.position) < 0.501f,
                "surfels of faces are in the ball around their box");
    }
}

}

void check_mesh(const Mesh& mesh) {
    check_arrays(mesh);
    check_warnings(mesh);
    check_source(mesh);
    const Triangulation cut = triangulate(mesh);
    check_triangles(mesh, cut);
    check_surfels(mesh, cut.triangles);
}

}
