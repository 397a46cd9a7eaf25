/// The vocabulary of every stage: vectors, boxes, surfels, lengths. Units and signs are said here, once.
///
/// Two spaces:
///  - *scene space*: the file's coordinates, in double precision. Meshes and anything read or written.
///  - *unit space*: recentred on the box of the mesh and divided by its diagonal D, in single precision.
///    Grids, fields, surfels and radii. A radius of 10 % of D is 0.1 here, whatever the size and place of the scene,
///    so the numbers behind a bake do not depend on either. A Frame maps one to the other.
///
/// Signs: a distance is positive outside (in the air), negative inside (in the solid), zero on the surface.
/// Occlusion values are visibilities in [0, 1]: 1 is open, 0 is buried.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <limits>

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
    double diagonal() const; ///< infinite where it is more than a double holds
};

/// Scene space <-> unit space: unit = (scene - center) / diagonal.
struct Frame {
    Vec3d center{0.0};
    double diagonal = 1.0;

    Vec3 to_unit(const Vec3d& scene) const { return Vec3((scene - center) / diagonal); }
    Vec3d to_scene(const Vec3& unit) const { return Vec3d(unit) * diagonal + center; }
};

/// The frame of a box; of diagonal 1 where the box is empty or a single point. \throw InputError if the diagonal of the box
/// is infinite, or subnormal.
Frame frame_of(const Box& box);

/// A point of the surface and its unit normal; a zero normal marks a point that has none.
struct Surfel {
    Vec3 position;
    Vec3 normal;

    bool has_normal() const { return normal != Vec3(0.0f); }
};

struct Ray {
    Vec3 origin;
    Vec3 direction; ///< unit length
};

/// Some of the values of an enumeration with at most 32 values, counted from 0.
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

}
