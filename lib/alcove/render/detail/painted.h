/// Renders vertex values of a mesh, without lighting and without a grid.
#pragma once

#include "alcove/render/camera.h"
#include "alcove/render/image.h"

#include <span>

namespace alcove {

/// Rasterises the triangles, visible from both sides, and interpolates one value per vertex into `ao` of the image;
/// also fills alpha, depth and face normals. Averages `samples`² samples per pixel. Positions are in scene space.
/// Triangles with a corner behind the eye are skipped. Cost: linear in the pixels that the triangles cover.
Image paint(std::span<const Vec3d> positions, std::span<const Triangle> triangles, std::span<const float> values,
            const Camera& camera, int samples = 3);

}
