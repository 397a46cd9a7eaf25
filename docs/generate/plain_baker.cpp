// The baker that docs/performance.md compares `alcove` with: Embree alone, from file to file.
//
//     alcove_plain_baker INPUT OUTPUT RADIUS RAYS
#include "plain_embree.h"

#include <alcove/alcove.h>

#include <iostream>

int main(int argc, char** argv) {
    using namespace alcove;
    if (argc != 5) {
        std::cerr << "usage: alcove_plain_baker INPUT OUTPUT RADIUS RAYS\n";
        return 2;
    }
    try {
        const ThreadLimit one_thread(1);
        Mesh mesh = read_mesh(argv[1]);
        const std::vector<Triangle> triangles = triangulate(mesh).triangles;
        const std::vector<Surfel> surfels = make_surfels(mesh, triangles, frame_of(mesh.box()));
        std::vector<Vec3> positions;
        positions.reserve(surfels.size());
        for (const Surfel& surfel : surfels)
            positions.push_back(surfel.position);
        const PlainEmbree bvh(positions, triangles, RTC_BUILD_QUALITY_LOW);
        mesh.set_attribute(
            {"ao", 1, bvh.bake(surfels, std::stof(argv[3]), std::stoi(argv[4]), PlainEmbree::Calls::stream)});
        write_mesh(mesh, argv[2]);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
