/// Depth and normals of the surface that a camera sees.
#pragma once

#include "alcove/render/camera.h"
#include "alcove/render/renderer.h"

#include <vector>

namespace alcove {

struct DepthBuffer {
    Camera camera;
    /// Depth along the view axis, at the centre of each pixel, in scene units; far_depth on the background.
    std::vector<float> depth;
    std::vector<Vec3> normal; ///< scene directions, unit length; zero on the background

    std::size_t width() const { return static_cast<std::size_t>(camera.size().width); }
    std::size_t height() const { return static_cast<std::size_t>(camera.size().height); }
    bool seen(std::size_t pixel) const { return normal[pixel] != Vec3(0.0f); }
    /// The point that a pixel shows, relative to the eye, scene units.
    Vec3d from_eye(std::size_t pixel) const {
        const Vec3d direction =
            camera.direction(static_cast<double>(pixel % width()) + 0.5, static_cast<double>(pixel / width()) + 0.5);
        return double(depth[pixel]) / glm::dot(direction, camera.forward()) * direction;
    }
};

/// Renders the depth buffer. Cost: one camera ray per pixel (camera_rays.h).
DepthBuffer look(const Renderable& renderable, const Camera& camera);

}
