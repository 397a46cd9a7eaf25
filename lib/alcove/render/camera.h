/// A pinhole camera: pixels to rays and back, in scene space.
///
/// Pixel coordinates are continuous: (0, 0) is the upper left corner of the image, (width, height) the lower
/// right, so the centre of the first pixel is (0.5, 0.5). Depth is the distance along the view axis, not
/// along the ray.
#pragma once

#include "alcove/base/types.h"

#include <glm/mat4x4.hpp>

#include <optional>
#include <span>

namespace alcove {

struct ImageSize {
    int width = 1280;
    int height = 720;
};
inline constexpr int longest_side = 65536; ///< pixels

/// The view. Unset members are chosen so that the renderable fills the image.
struct CameraOptions {
    std::optional<Vec3d> eye{};     ///< scene units
    std::optional<Vec3d> look_at{}; ///< scene units
    Vec3d up{0.0, 1.0, 0.0};        ///< any length but 0
    double fov = 40.0;              ///< degrees across the width, in (0, 180)
};

class Camera {
  public:
    /// If `up` is parallel to the view, a perpendicular direction replaces it. \throw InputError if `eye` equals
    /// `look_at`.
    Camera(const Vec3d& eye, const Vec3d& look_at, const Vec3d& up, double fov, ImageSize size);

    const Vec3d& eye() const { return eye_; }
    const Vec3d& right() const { return right_; }
    const Vec3d& up() const { return up_; } ///< perpendicular to the view, unlike `up` of the constructor
    const Vec3d& forward() const { return forward_; }
    ImageSize size() const { return size_; }
    double fov() const;                                              ///< degrees across the width
    double screen_window_width() const { return 2.0 * half_width_; } ///< of the image plane at depth 1

    /// Unit direction of the ray through the pixel coordinates (x, y).
    Vec3d direction(double x, double y) const { return glm::normalize(corner_ + x * pixel_right_ + y * pixel_down_); }
    /// (x, y, depth) of a point in front of the eye. (x, y) is outside [0, width] × [0, height] if the image does not
    /// show the point.
    Vec3d project(const Vec3d& p) const;

    /// Left-handed: x right, y up, z forward; column vectors. The convention of OpenEXR's standard attributes.
    glm::dmat4 world_to_camera() const;
    /// After division by w, x and y run from (0, 0) at the upper left to (1, 1) at the lower right; z is
    /// 1/depth.
    glm::dmat4 world_to_ndc() const;

  private:
    Vec3d eye_, right_, up_, forward_;
    // The image plane at depth 1: its half sizes, its upper left corner relative to the eye, and the sides of a pixel.
    double half_width_, half_height_;
    Vec3d corner_, pixel_right_, pixel_down_;
    ImageSize size_;
};

/// The camera that the options describe. By default it looks at the middle of the points from above and in front, in a
/// three-quarter view, and is as near as possible with all points in the image and a margin of 5 %. The front is +z, or
/// −y if `up` is nearer to z than to the other axes. Cost: linear in the points. \throw InputError as Camera().
Camera make_camera(const CameraOptions& options, std::span<const Vec3d> points, ImageSize size);

}
