/// What is in front of the camera: fields, where in the scene they are, and what they are made of.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/render/renderable_mesh.h"
#include "alcove/render/shading.h"

#include <memory>
#include <vector>

namespace alcove {

/// One of the things that a field is the union of.
struct Part {
    AnyField field; ///< unit space
    Material material{};
};

/// A plane, seen from its front alone, that vanishes into the background.
struct Ground {
    Plane plane; ///< unit space
    /// Distances from the origin, unit space, within which it is whole and beyond which it is gone.
    float whole = 50.0f, gone = 100.0f;
    Material material{};

    /// Its share of a pixel that shows the place p of it.
    float coverage(const Vec3& p) const;
};

struct Renderable {
    AnyField field;            ///< of all that is bounded, unit space
    Frame frame;               ///< of that unit space
    Box box;                   ///< scene units; nothing of the field is drawn outside it
    std::vector<Part> parts{}; ///< whose union the field is; of none the field is one part
    std::vector<Ground> grounds{};
    std::shared_ptr<const RenderableMesh>
        mesh{}; ///< of all or some of it; null where nothing asks for triangles

    /// The field and the grounds: what occludes.
    AnyField surroundings() const;
};

/// The material of an object that is one.
const Material& material_of(const Renderable& renderable, ObjectId object);

/// Whether a material has a colour for convex edges.
bool has_edge_colors(const Renderable& renderable);

/// The ground that an object is, or null.
const Ground* ground_of(const Renderable& renderable, ObjectId object);

/// The surface of a field within the cube of side 1 around the origin of unit space: cells of 1/64 that it passes
/// through, as points to aim a camera at. \throw InputError if there are none. Cost: 64³ map() calls.
struct Outline {
    std::vector<Vec3d> points; ///< centres of the cells, scene units
    Box box;                   ///< around the cells
};
Outline outline(const AnyField& field, const Frame& frame);

}
