// Bakes ambient occlusion at the vertices of an OpenMesh mesh and writes the mesh with the result:
//
//     bake_openmesh INPUT OUTPUT.ply
#include <alcove/bake/openmesh.h>
#include <alcove/mesh/files.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <cstdio>
#include <exception>

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3f;
};
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

// Reads a file with OpenMesh. Returns whether that gives the mesh in the file: OpenMesh changes non-manifold meshes,
// may choose other normals and does not read OFF files with comments.
bool read(PolyMesh& mesh, const char* path, const alcove::Mesh& file) {
    omerr().disable(); // it reports each non-manifold face
    OpenMesh::IO::Options options = OpenMesh::IO::Options::VertexNormal;
    mesh.request_vertex_normals();
    if (!OpenMesh::IO::read_mesh(mesh, path, options))
        return false;
    if (!options.vertex_has_normal())
        mesh.release_vertex_normals();
    const alcove::Mesh result = alcove::to_mesh(mesh);
    if (result.vertex_count() != file.vertex_count() || result.face_begin != file.face_begin ||
        result.corners != file.corners || result.normals != file.normals)
        return false;
    for (const auto v : mesh.vertices()) { // OpenMesh rounds coordinates to float
        const alcove::Vec3d& p = file.positions[static_cast<std::size_t>(v.idx())];
        mesh.set_point(v, {p.x, p.y, p.z});
    }
    return true;
}

int main(int argument_count, char** arguments) try {
    if (argument_count != 3) {
        std::fprintf(stderr, "usage: bake_openmesh INPUT OUTPUT.ply\n");
        return 2;
    }
    alcove::Mesh file = alcove::read_mesh(arguments[1]); // also keeps the data that OpenMesh does not read
    const alcove::BakeOptions options{.radius = "10%", .quality = alcove::Quality::good};
    alcove::Baked baked;
    PolyMesh mesh;
    if (read(mesh, arguments[1], file)) {
        baked = alcove::bake(mesh, options);
        const auto ao = OpenMesh::getProperty<OpenMesh::VertexHandle, float>(mesh, "ao");
        std::printf("ao of the first vertex: %.2f\n", static_cast<double>(ao[OpenMesh::VertexHandle(0)]));
    } else {
        baked = alcove::bake(file, options);
        std::printf("OpenMesh would change this mesh: baked without OpenMesh\n");
    }
    alcove::add(file, baked);
    alcove::write_mesh(file, arguments[2]);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bake_openmesh: %s\n", error.what());
    return 1;
}
