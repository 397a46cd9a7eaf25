/// The geometry and materials that a camera renders.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/occlusion/occluders.h"
#include "alcove/render/shading.h"
#include <cstdint>

#include <memory>
#include <vector>

namespace alcove {

/// The object that a sample shows: 0 for the background, then the parts counted from 1, then the grounds.
using ObjectId = std::uint16_t;
inline constexpr ObjectId no_object = 0;

/// The vectors have one value per position of the surface.
struct RenderableMesh {
    RaySurface surface;            ///< unit space
    std::vector<ObjectId> objects; ///< part number
    std::vector<Vec3> normals;     ///< of any length; zero keeps the normal of the field
    std::vector<float> painted;    ///< factor of the ao, in [0, 1]; may be empty
};

/// One operand of the union that forms a field.
struct Part {
    AnyField field; ///< unit space
    Material material{};
};

/// A plane, visible from its front only, that fades into the background.
struct Ground {
    Plane plane; ///< unit space
    /// Distances from the origin, unit space: fully opaque up to `whole`, invisible beyond `gone`.
    float whole = 50.0f, gone = 100.0f;
    Material material{};

    /// Opacity at the point p of the plane, in [0, 1].
    float coverage(const Vec3& p) const;
};

struct Renderable {
    AnyField field;            ///< everything except the grounds, unit space
    Frame frame;               ///< maps unit space to scene space
    Box box;                   ///< scene units; the field is not rendered outside it
    std::vector<Part> parts{}; ///< `field` is their union; if empty, `field` is a single part
    std::vector<Ground> grounds{};
    /// Triangles of all or some of the parts; null if not needed.
    std::shared_ptr<const RenderableMesh> mesh{};

    /// All occluders: the field and the grounds.
    AnyField surroundings() const;
};

/// The material of an object, which must not be no_object.
const Material& material_of(const Renderable& renderable, ObjectId object);

/// Whether a material has a colour for convex edges.
bool has_edge_colors(const Renderable& renderable);

/// The ground with that object number, or null if it is a part.
const Ground* ground_of(const Renderable& renderable, ObjectId object);

/// The cells that the surface of a field passes through, to aim a camera at.
struct Outline {
    std::vector<Vec3d> points; ///< centres of the cells, scene units
    Box box;                   ///< around the cells, scene units
};

/// Searches the cube of side 1 around the origin of unit space, in cells of 1/64. \throw InputError if no cell
/// contains the surface. Cost: 64³ map() calls.
Outline outline(const AnyField& field, const Frame& frame);

}
