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

/// Where to look from; what is not given is chosen so that the renderable fills the image.
struct CameraOptions {
    std::optional<Vec3d> eye{};     ///< scene units
    std::optional<Vec3d> look_at{}; ///< scene units
    Vec3d up{0.0, 1.0, 0.0};        ///< any length but 0
    double fov = 40.0;              ///< degrees across the width, in (0, 180)
};

class Camera {
  public:
    /// An up direction along the view is replaced by one across it. \throw InputError if `eye` is `look_at`.
    Camera(const Vec3d& eye, const Vec3d& look_at, const Vec3d& up, double fov, ImageSize size);

    const Vec3d& eye() const { return eye_; }
    const Vec3d& right() const { return right_; }
    const Vec3d& up() const { return up_; } ///< across the view, unlike the one it was made from
    const Vec3d& forward() const { return forward_; }
    ImageSize size() const { return size_; }
    double fov() const;                                              ///< degrees across the width
    double screen_window_width() const { return 2.0 * half_width_; } ///< of the image plane at depth 1

    /// Unit direction of the ray through a place of the image.
    Vec3d direction(double x, double y) const {
        return glm::normalize(corner_ + x * pixel_right_ + y * pixel_down_);
    }
    /// (x, y, depth) of a point in front of the eye; places outside the image are outside [0, width] × [0,
    /// height].
    Vec3d project(const Vec3d& p) const;

    /// Left-handed: x right, y up, z forward; column vectors. As OpenEXR's standard attributes want it.
    glm::dmat4 world_to_camera() const;
    /// After division by w, x and y run from (0, 0) at the upper left to (1, 1) at the lower right; z is
    /// 1/depth.
    glm::dmat4 world_to_ndc() const;

  private:
    Vec3d eye_, right_, up_, forward_;
    double half_width_, half_height_;         // of the image plane at depth 1
    Vec3d corner_, pixel_right_, pixel_down_; // its upper left one from the eye, and the sides of a pixel
    ImageSize size_;
};

/// The camera that was asked for. Without an eye it looks from above and in front, three quarters to the
/// side, from as near as keeps all points in the image with a margin of 5 % around them; without a target, at
/// their centre. The front is +z, or −y where up is nearer to z than to the other axes. Cost: linear in the
/// points. \throw InputError as Camera().
Camera make_camera(const CameraOptions& options, std::span<const Vec3d> points, ImageSize size);

}
