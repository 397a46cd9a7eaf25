/// Bakes OpenMesh meshes and stores the values in vertex properties. Link OpenMeshCore to use it.
///
///     OpenMesh::PolyMesh_ArrayKernelT<> mesh;
///     OpenMesh::IO::read_mesh(mesh, "dragon.off");
///     alcove::bake(mesh, {.radius = "10%"});
///     const auto ao = OpenMesh::getProperty<OpenMesh::VertexHandle, float>(mesh, "ao");
///
/// OpenMesh represents only manifolds. Its readers duplicate the vertices of non-manifold faces and drop faces with a
/// repeated vertex, so the baked mesh differs from the file. Use read_mesh() of mesh/files.h for such files, as
/// examples/bake_openmesh.cpp does. OpenMesh's readers also round coordinates to float, read an OFF file with comments
/// as empty, and, for a TriMesh, cut polygons into fans, which is wrong for concave polygons. The values equal those of
/// `alcove bake` if to_mesh() returns the same mesh as read_mesh().
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/mesh/normals.h"

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <OpenMesh/Core/Utils/PropertyManager.hh>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace alcove {

/// TriMesh_ArrayKernelT or PolyMesh_ArrayKernelT with any traits whose points have three coordinates.
template <class T>
concept OpenMeshType = std::derived_from<T, OpenMesh::PolyConnectivity> &&
    requires(const T& mesh, OpenMesh::VertexHandle v) {
    { mesh.point(v)[2] } -> std::convertible_to<double>;
    { mesh.normal(v)[2] } -> std::convertible_to<double>;
    { mesh.has_vertex_normals() } -> std::same_as<bool>;
};

/// Converts positions, faces and, if the mesh has them, vertex normals, which are scaled to unit length. Keeps the
/// order of the elements; leaves out those that are marked as deleted. Cost: linear.
template <OpenMeshType T>
Mesh to_mesh(const T& mesh) {
    Mesh result;
    result.positions.reserve(mesh.n_vertices());
    std::vector<std::uint32_t> index(mesh.n_vertices());
    for (const OpenMesh::VertexHandle v : mesh.vertices()) {
        index[static_cast<std::size_t>(v.idx())] = static_cast<std::uint32_t>(result.positions.size());
        const auto& p = mesh.point(v);
        result.positions.emplace_back(p[0], p[1], p[2]);
        if (mesh.has_vertex_normals()) {
            const auto& n = mesh.normal(v);
            result.normals.push_back(unit_or_zero(Vec3d(n[0], n[1], n[2])));
        }
    }
    std::vector<std::uint32_t> corners;
    for (const OpenMesh::FaceHandle f : mesh.faces()) {
        corners.clear();
        for (const OpenMesh::VertexHandle v : mesh.fv_range(f))
            corners.push_back(index[static_cast<std::size_t>(v.idx())]);
        result.add_face(corners);
    }
    return result;
}

/// Bakes the vertices of a mesh. Values, cost, thread-safety and exceptions are those of bake() for to_mesh(mesh). If
/// baking throws, the mesh is not changed.
///
/// Each requested channel is stored in the vertex property of its name ("ao", "bent_normal"), of type `float` or
/// `OpenMesh::Vec3f`. If the property is missing, it is added, but not as persistent. Values of deleted vertices are
/// not changed. Normals that were requested from OpenMesh but never computed are zero; NormalSource::automatic replaces
/// them.
template <OpenMeshType T>
Baked bake(T& mesh, const BakeOptions& options = {}) {
    Baked baked = bake(to_mesh(mesh), options);
    for (const ChannelInfo& channel : channels) {
        const std::vector<float>& values = baked[channel.channel];
        if (values.empty())
            continue;
        const std::string name(channel.name);
        std::size_t at = 0;
        if (channel.components == 3) {
            auto property = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, OpenMesh::Vec3f>(mesh, name.c_str());
            for (const OpenMesh::VertexHandle v : mesh.vertices()) {
                property[v] = OpenMesh::Vec3f(values[at], values[at + 1], values[at + 2]);
                at += 3;
            }
        } else {
            auto property = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, float>(mesh, name.c_str());
            for (const OpenMesh::VertexHandle v : mesh.vertices())
                property[v] = values[at++];
        }
    }
    return baked;
}

}
