/// Tangent frames for normal maps.
#pragma once

#include "alcove/maps/detail/rasterize.h"

#include <array>
#include <span>
#include <vector>

namespace alcove {

/// A corner of a triangle, with everything that its tangent depends on.
struct TangentCorner {
    Vec3d position;
    Vec3 normal; ///< unit length
    Vec2 uv;
};

struct TangentTriangle {
    std::array<Vec3, 3> tangents; ///< of the corners: unit length along u, at right angles to the normal
    float sign = 1.0f;            ///< the bitangent is sign · (normal × tangent); −1 where UVs are mirrored
};

/// The tangents of MikkTSpace (Mikkelsen 2008), which Blender, Unreal, Unity and glTF use. Corners with the same
/// position, normal and UV are one vertex; its tangent is the mean over the triangles around it that are connected by
/// edges and equally mirrored, weighted by their angles. Cost: about 1 µs per triangle.
std::vector<TangentTriangle> tangent_frames(std::span<const std::array<TangentCorner, 3>> triangles);

}
