// The baker that `alcove` is compared with: Embree alone, from file to file. Writes vertices to a mesh, or texels to a
// .png.
//
//     alcove_plain_baker INPUT OUTPUT RADIUS RAYS [SIZE]
#include "plain_embree.h"

#include "alcove/maps/detail/padding.h"
#include "alcove/maps/detail/rasterize.h"
#include "alcove/maps/detail/uv_faces.h"
#include "alcove/maps/maps.h"

#include <alcove/alcove.h>

#include <iostream>

namespace {

using namespace alcove;

/// The texels that bake_maps() bakes, each with its own rays, along a Morton curve.
void bake_map(const Mesh& mesh, const PlainEmbree& bvh, float radius, int rays, int size, const char* file) {
    const UvFaces faces(mesh, UvFacesOptions{});
    const UvTile tile{size, size};
    const TexelOwners owners = rasterize(faces.uvs(), tile);
    const Frame frame = frame_of(mesh.box());
    std::vector<Surfel> surfels;
    std::vector<std::uint8_t> covered(owners.size());
    for (std::size_t i = 0; i < owners.size(); ++i)
        if (const std::uint32_t triangle = owners.triangles[i]; triangle != no_triangle) {
            const SurfacePoint point = faces.point(triangle, weights_at(faces.uvs()[triangle], tile, i));
            surfels.push_back({frame.to_unit(point.position), point.normal});
            covered[i] = 1;
        }
    const std::vector<float> ao = bvh.bake(surfels, radius, rays, PlainEmbree::Calls::stream);
    std::vector<float> values(owners.size(), 1.0f);
    for (std::size_t i = 0, k = 0; i < owners.size(); ++i)
        if (covered[i])
            values[i] = ao[k++];
    const std::vector<std::uint32_t> nearest = nearest_covered(covered, size, size, size / 128);
    for (std::size_t i = 0; i < owners.size(); ++i)
        values[i] = values[nearest[i]];
    BakedMaps maps;
    maps.width = maps.height = size;
    maps.tiles.push_back({1001, {{MapAttribute::ao, std::move(values)}}, {}});
    write_maps(maps, file);
}

}

int main(int argc, char** argv) {
    if (argc != 5 && argc != 6) {
        std::cerr << "usage: alcove_plain_baker INPUT OUTPUT RADIUS RAYS [SIZE]\n";
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
        if (argc == 6) {
            bake_map(mesh, bvh, std::stof(argv[3]), std::stoi(argv[4]), std::stoi(argv[5]), argv[2]);
            return 0;
        }
        mesh.set_attribute(
            {"ao", 1, bvh.bake(surfels, std::stof(argv[3]), std::stoi(argv[4]), PlainEmbree::Calls::stream)});
        write_mesh(mesh, argv[2]);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
