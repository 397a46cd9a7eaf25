/// Renderables of exact shapes.
#pragma once

#include "alcove/render/camera.h"
#include "alcove/render/renderer.h"

namespace alcove {

/// The frame of a scene that is five times as large as its unit space, and whose centre is not the origin.
inline const Frame frame{{10.0, -20.0, 30.0}, 5.0};

inline Renderable renderable_of(AnyField field, const Vec3& low, const Vec3& high) {
    Box box;
    box.add(frame.to_scene(low));
    box.add(frame.to_scene(high));
    return {std::move(field), frame, box};
}

inline Camera camera_at(const Vec3& eye, const Vec3& target, ImageSize size, double fov = 40.0) {
    return Camera(frame.to_scene(eye), frame.to_scene(target), {0.0, 1.0, 0.0}, fov, size);
}

}
