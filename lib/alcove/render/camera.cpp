#include "alcove/render/camera.h"

#include "alcove/base/types.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace alcove {
namespace {

constexpr double margin = 0.05;

/// The component of v perpendicular to `axis` (unit length), normalised; zero if v is parallel to it.
Vec3d perpendicular(const Vec3d& v, const Vec3d& axis) {
    const Vec3d rest = v - glm::dot(v, axis) * axis;
    const double length = glm::length(rest);
    return length > 1e-9 * glm::length(v) ? rest / length : Vec3d(0.0);
}

/// The direction in which the front of a scene faces.
Vec3d front_of(const Vec3d& up) {
    const Vec3d size = glm::abs(up);
    return size.z > size.x && size.z > size.y ? Vec3d(0.0, -1.0, 0.0) : Vec3d(0.0, 0.0, 1.0);
}

/// Direction from the renderable toward the eye, unit length.
Vec3d three_quarter_view(const Vec3d& up) {
    const Vec3d front = perpendicular(front_of(up), up);
    const Vec3d side = glm::cross(up, front);
    return glm::normalize(0.55 * side + 0.45 * up + front);
}

/// The eye positions that see all points, along one axis of the image.
///
/// A point at (x, depth) is visible from an eye at (e, d) if |x − e| <= t (depth − d). So e − t d >= max(x − t
/// depth) and e + t d <= min(x + t depth).
struct Visibility {
    double left = std::numeric_limits<double>::infinity();   // min(x + t depth)
    double right = -std::numeric_limits<double>::infinity(); // max(x − t depth)
    double slope;

    explicit Visibility(double t) : slope(t) {}
    void add(double x, double depth) {
        left = std::min(left, x + slope * depth);
        right = std::max(right, x - slope * depth);
    }
    double offset() const { return 0.5 * (left + right); }
    double depth() const { return 0.5 * (left - right) / slope; }
};

}

Camera::Camera(const Vec3d& eye, const Vec3d& look_at, const Vec3d& up, double fov, ImageSize size)
    : eye_(eye), size_(size) {
    const Vec3d view = look_at - eye;
    const double distance = glm::length(view);
    if (!(distance > 0.0))
        throw InputError("the camera looks at its own eye position: move one of them");
    forward_ = view / distance;
    up_ = perpendicular(up, forward_);
    if (up_ == Vec3d(0.0))
        up_ = perpendicular(-front_of(up), forward_);
    right_ = glm::cross(forward_, up_);
    half_width_ = std::tan(0.5 * fov * std::numbers::pi / 180.0);
    half_height_ = half_width_ * size.height / size.width;
    corner_ = forward_ - half_width_ * right_ + half_height_ * up_;
    pixel_right_ = 2.0 * half_width_ / size.width * right_;
    pixel_down_ = -2.0 * half_height_ / size.height * up_;
}

double Camera::fov() const {
    return 2.0 * std::atan(half_width_) * 180.0 / std::numbers::pi;
}

Vec3d Camera::project(const Vec3d& p) const {
    const Vec3d q = p - eye_;
    const double depth = glm::dot(q, forward_);
    return {0.5 * size_.width * (1.0 + glm::dot(q, right_) / (depth * half_width_)),
            0.5 * size_.height * (1.0 - glm::dot(q, up_) / (depth * half_height_)), depth};
}

glm::dmat4 Camera::world_to_camera() const {
    glm::dmat4 m(1.0);
    for (int column = 0; column < 3; ++column)
        m[column] = {right_[column], up_[column], forward_[column], 0.0};
    m[3] = {-glm::dot(eye_, right_), -glm::dot(eye_, up_), -glm::dot(eye_, forward_), 1.0};
    return m;
}

glm::dmat4 Camera::world_to_ndc() const {
    glm::dmat4 projection(0.0);
    projection[0] = {0.5 / half_width_, 0.0, 0.0, 0.0};
    projection[1] = {0.0, -0.5 / half_height_, 0.0, 0.0};
    projection[2] = {0.5, 0.5, 0.0, 1.0};
    projection[3] = {0.0, 0.0, 1.0, 0.0};
    return projection * world_to_camera();
}

Camera make_camera(const CameraOptions& options, std::span<const Vec3d> points, ImageSize size) {
    Box box;
    for (const Vec3d& p : points)
        box.add(p);
    const Vec3d center = box.empty() ? Vec3d(0.0) : box.center();
    const Vec3d target = options.look_at.value_or(center);
    if (options.eye)
        return Camera(*options.eye, target, options.up, options.fov, size);

    const Vec3d up = glm::normalize(options.up);
    const Vec3d toward_eye = three_quarter_view(up);
    // This camera looks at the origin and only provides the axes, which a distant target would make imprecise.
    const Camera orientation(toward_eye, Vec3d(0.0), up, options.fov, size);
    const double half_width = std::tan(0.5 * options.fov * std::numbers::pi / 180.0);
    Visibility horizontal((1.0 - 2.0 * margin) * half_width);
    Visibility vertical((1.0 - 2.0 * margin) * half_width * size.height / size.width);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3d& p : points) {
        const Vec3d q = p - target;
        const double depth = glm::dot(q, orientation.forward());
        horizontal.add(glm::dot(q, orientation.right()), depth);
        vertical.add(glm::dot(q, orientation.up()), depth);
        nearest = std::min(nearest, depth);
    }
    const double extent = frame_of(box).diagonal;
    if (points.empty())
        return Camera(target + 2.0 * toward_eye, target, up, options.fov, size);
    // The eye stays a little in front of the nearest point, even if all points are on the view axis.
    const double depth = std::min({horizontal.depth(), vertical.depth(), nearest - 1e-2 * extent});
    Vec3d eye = target + depth * orientation.forward();
    Vec3d aim = target;
    if (!options.look_at) {
        const Vec3d shift = horizontal.offset() * orientation.right() + vertical.offset() * orientation.up();
        eye += shift;
        aim += shift;
    }
    return Camera(eye, aim, up, options.fov, size);
}

}
