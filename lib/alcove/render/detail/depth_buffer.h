/// What a camera sees: how far it is, and which way it faces.
#pragma once

#include "alcove/render/camera.h"
#include "alcove/render/renderable.h"

#include <vector>

namespace alcove {

struct DepthBuffer {
    Camera camera;
    std::vector<float>
        depth; ///< along the view axis, scene units, at the centre of each pixel; far_depth where nothing is
    std::vector<Vec3> normal; ///< scene directions, unit length; zero where nothing is

    std::size_t width() const { return static_cast<std::size_t>(camera.size().width); }
    std::size_t height() const { return static_cast<std::size_t>(camera.size().height); }
    bool seen(std::size_t pixel) const { return normal[pixel] != Vec3(0.0f); }
    /// The place that a pixel shows, from the eye, scene units.
    Vec3d from_eye(std::size_t pixel) const {
        const Vec3d way = camera.direction(static_cast<double>(pixel % width()) + 0.5,
                                           static_cast<double>(pixel / width()) + 0.5);
        return double(depth[pixel]) / glm::dot(way, camera.forward()) * way;
    }
};

/// Cost: that of the rays, one a pixel (camera_rays.h).
DepthBuffer look(const Renderable& renderable, const Camera& camera);

}
