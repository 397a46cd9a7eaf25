/// Grids and fields made by OpenVDB alone, in unit space.
#pragma once

#include "scan.h"

#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

namespace alcove {

struct OpenVdbMesh {
    explicit OpenVdbMesh(const Scan& scan) {
        points.reserve(scan.mesh.positions.size());
        for (const Vec3& p : unit_positions(scan))
            points.emplace_back(p.x, p.y, p.z);
        triangles.reserve(scan.triangles.size());
        for (const Triangle& t : scan.triangles)
            triangles.emplace_back(t[0], t[1], t[2]);
    }

    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
};

/// A single level that stores distances up to the radius, made with the default flags of meshToVolume.
inline openvdb::FloatGrid::Ptr openvdb_grid(const OpenVdbMesh& mesh, float voxel, float radius) {
    constexpr float inner_band = 2.0f;
    return openvdb::tools::meshToSignedDistanceField<openvdb::FloatGrid>(
        *openvdb::math::Transform::createLinearTransform(voxel), mesh.points, mesh.triangles, {}, radius / voxel + 1.0f,
        inner_band);
}

/// Models Field. Not thread-safe: the accessor caches its path through the tree.
class OpenVdbField {
  public:
    OpenVdbField(openvdb::FloatGrid::ConstPtr grid, float voxel)
        : grid_(std::move(grid)), accessor_(grid_->getConstAccessor()), voxel_(voxel) {}

    float map(const Vec3& p) const {
        const Vec3 index = p / voxel_;
        return openvdb::tools::BoxSampler::sample(accessor_, openvdb::Vec3d(index.x, index.y, index.z));
    }

  private:
    openvdb::FloatGrid::ConstPtr grid_;
    openvdb::FloatGrid::ConstAccessor accessor_;
    float voxel_;
};

}
