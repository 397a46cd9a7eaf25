/// The basic types: vectors, boxes, frames, surfels. Also defines units and signs.
///
/// Two spaces:
///  - *scene space*: the coordinates of the file, in double precision. Used by meshes and everything read or written.
///  - *unit space*: coordinates relative to the centre of the mesh's bounding box, divided by the diagonal D of the
///    box, in single precision. Used by grids, fields, surfels and radii. A radius of 10 % of D is 0.1, so a bake does
///    not depend on the size and position of the scene. A Frame converts between the two spaces.
///
/// Signs: a distance is positive outside, negative inside (in the solid), zero on the surface.
/// Occlusion values are visibilities in [0, 1]: 1 is unoccluded, 0 fully occluded.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

namespace alcove {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec3d = glm::dvec3;
using Triangle = std::array<std::uint32_t, 3>;
using Color = std::array<std::uint8_t, 4>; ///< red, green, blue, alpha

/// An axis-aligned box; empty until a point is added.
struct Box {
    Vec3d min{std::numeric_limits<double>::infinity()};
    Vec3d max{-std::numeric_limits<double>::infinity()};

    void add(const Vec3d& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    bool empty() const { return !(min.x <= max.x); }
    Vec3d center() const { return min + 0.5 * (max - min); }
    double diagonal() const; ///< infinite if it exceeds the range of a double
};

/// Converts between scene space and unit space: unit = (scene - center) / diagonal.
struct Frame {
    Vec3d center{0.0};
    double diagonal = 1.0;

    Vec3 to_unit(const Vec3d& scene) const { return Vec3((scene - center) / diagonal); }
    Vec3d to_scene(const Vec3& unit) const { return Vec3d(unit) * diagonal + center; }
};

/// The frame of a box, with a diagonal of 1 if the box is empty or a single point. \throw InputError if the
/// diagonal of the box is infinite or subnormal.
Frame frame_of(const Box& box);

/// A point on the surface and its unit normal; the normal is zero if the point has none.
struct Surfel {
    Vec3 position;
    Vec3 normal;
    /// The sum of the unit normals of the other faces that the surfel touches. Each of these normals points to the side
    /// of its face on which the surfel's own faces lie.
    Vec3 away{0.0f};
    bool covered = false; ///< other faces lie on the surfel's own faces: nothing is visible
    /// The maximum height at which rays against triangles start. Finite where other faces are near and the surfel's own
    /// faces are so small that rays could otherwise start beyond the other faces.
    float highest = std::numeric_limits<float>::infinity();

    bool has_normal() const { return normal != Vec3(0.0f); }
    /// Where rays start: `height` above the surfel's own faces, and equally far from other faces that it touches.
    Vec3 origin(float height) const { return position + height * (normal + away); }
    /// Like origin(), but at no more than the maximum height.
    Vec3 ray_origin(float height) const { return origin(height < highest ? height : highest); }
};

struct Ray {
    Vec3 origin;
    Vec3 direction; ///< unit length
};

/// A set of values of an enumeration that has at most 32 values, numbered from 0.
template <class E>
class EnumSet {
  public:
    constexpr EnumSet() = default;
    constexpr EnumSet(E value) : bits_(1u << static_cast<unsigned>(value)) {}

    constexpr bool has(E value) const { return (bits_ & EnumSet(value).bits_) != 0; }
    constexpr bool empty() const { return bits_ == 0; }
    constexpr EnumSet operator|(EnumSet other) const { return EnumSet(bits_ | other.bits_); }
    constexpr EnumSet operator&(EnumSet other) const { return EnumSet(bits_ & other.bits_); }
    constexpr EnumSet without(EnumSet other) const { return EnumSet(bits_ & ~other.bits_); }
    constexpr bool operator==(const EnumSet&) const = default;

  private:
    constexpr explicit EnumSet(unsigned bits) : bits_(bits) {}
    unsigned bits_ = 0;
};

/// A length as people write it: `0.2` scene units, `10%` of the diagonal, `3vx` finest voxels, `inf`.
struct Length {
    enum class Unit { scene, diagonal, voxels };
    double value = 0.0;
    Unit unit = Unit::scene;

    Length() = default;
    Length(double v, Unit u = Unit::scene) : value(v), unit(u) {}
    /// \throw InputError "takes a positive length, not ..." if the text is anything else.
    Length(const std::string& text);
    Length(const char* text) : Length(std::string(text)) {}

    /// The length in unit space. `diagonal` is in scene units, `voxel` in unit space. \throw InputError for a length in
    /// voxels if `voxel` is 0, and for a length less than 1e-12 or (if finite) more than 1e6 times the diagonal.
    float to_unit(double diagonal, float voxel = 0.0f) const;
};

// The exceptions thrown at the boundaries of the library. Each message is one line that says how to fix the problem
// and, if it lies in a file, names the file and the location in it.

/// The input is invalid: a file that cannot be read or is damaged, a mesh without faces, a grid of an unsupported type.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file could not be written.
struct IoError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The request would clearly exceed the time limit.
struct TimeLimitError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The system ran out of memory, though the request is within the limits.
struct MemoryError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The request is valid but too large: it exceeds the limit on memory or on reading, or the range of the indices.
struct LimitError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}
