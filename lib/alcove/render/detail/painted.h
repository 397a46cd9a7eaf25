/// A picture of values on a mesh, without light or grid.
#pragma once

#include "alcove/render/camera.h"
#include "alcove/render/image.h"

#include <span>

namespace alcove {

/// Draws the triangles, from either side, and interpolates a value a vertex between their corners: as `ao` of
/// the image, with alpha, depth and the normals of the faces. `samples`² places a pixel are averaged. Positions
/// in scene space; a triangle with a corner behind the eye is left out. Cost: that of the pixels the triangles
/// cover.
Image paint(std::span<const Vec3d> positions, std::span<const Triangle> triangles,
            std::span<const float> values, const Camera& camera, int samples = 3);

}
