/// The real meshes that the setup unpacks.
#pragma once

#include "alcove/mesh/files.h"
#include "alcove/mesh/triangulate.h"

#include <string>

namespace alcove::test {

struct RealMesh {
    explicit RealMesh(const std::string& name)
        : mesh(read_mesh(std::string(ALCOVE_REAL_MESHES) + "/" + name)), triangles(triangulate(mesh).triangles),
          frame(frame_of(mesh.box())) {}

    Mesh mesh;
    std::vector<Triangle> triangles;
    Frame frame;
};

}
