// Reports the contents of a mesh file and the defects of the mesh:
//
//     inspect_mesh INPUT
#include <alcove/mesh/diagnose.h>
#include <alcove/mesh/files.h>
#include <alcove/mesh/triangulate.h>

#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments) try {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: inspect_mesh INPUT\n");
        return 2;
    }
    const alcove::Mesh mesh = alcove::read_mesh(arguments[1]);
    for (const std::string& warning : mesh.warnings)
        std::printf("warning: %s\n", warning.c_str());

    const alcove::Triangulation cut = alcove::triangulate(mesh);
    std::printf("%zu vertices, %zu faces, %zu triangles\n", mesh.vertex_count(), mesh.face_count(),
                cut.triangles.size());

    const alcove::Diagnosis diagnosis = alcove::diagnose(mesh);
    std::printf("%s, %zu components\n", diagnosis.closed() ? "closed" : "not closed", diagnosis.components);
    for (const std::string& line : alcove::describe(diagnosis))
        std::printf("- %s\n", line.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "inspect_mesh: %s\n", error.what());
    return 1;
}
