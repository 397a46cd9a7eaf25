/// What a picture is of, as plain data: objects, light, camera and size, before any file is read or grid made.
#pragma once

#include "alcove/base/length.h"
#include "alcove/grid/voxelize.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"
#include "alcove/render/image_method.h"
#include "alcove/render/shading.h"
#include "alcove/render/soft_shadow.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace alcove {

/// p' = rotation · (scale · p) + translation, in scene units; turned about x, then y, then z.
struct Placement {
    Vec3d translation{0.0};
    Vec3d rotation{0.0}; ///< degrees, counterclockwise seen from the end of each axis
    double scale = 1.0;  ///< > 0
};

// The shapes, in scene units before they are placed. What they mean is in field/primitives.h.
struct SphereShape {
    Vec3d center{0.0};
    double radius = 1.0;
};
struct BoxShape {
    Vec3d center{0.0};
    Vec3d size{1.0}; ///< from face to face
};
struct TorusShape {
    Vec3d center{0.0};
    double ring = 1.0, tube = 0.25; ///< radii
};
struct CapsuleShape {
    Vec3d start{0.0}, end{0.0, 1.0, 0.0};
    double radius = 0.5;
};
/// Below it all is solid.
struct PlaneShape {
    Vec3d point{0.0};
    Vec3d normal{0.0, 1.0, 0.0}; ///< of any length but 0
};
struct MeshShape {
    std::filesystem::path file;
    std::optional<Length>
        voxel{}; ///< of the mesh's own diagonal where it is a share; chosen where it is none
    SignChoice sign = SignChoice::automatic;
    bool own_normals = true; ///< of the mesh (corner_normals()) instead of those of the field
    bool painted = false;    ///< the brightness of its vertex colours multiplies occlusion
};
/// A level set in a .vdb.
struct GridShape {
    std::filesystem::path file;
};
struct SceneObject;
struct CompositeShape {
    enum class Operation { unite, subtract };
    Operation operation = Operation::unite;
    std::vector<SceneObject> parts; ///< at least one; their materials are passed over
    double blend = 0.0;             ///< width of rounded seams, scene units, >= 0
};

using Shape = std::variant<SphereShape, BoxShape, TorusShape, CapsuleShape, PlaneShape, MeshShape, GridShape,
                           CompositeShape>;

struct SceneObject {
    std::string name; ///< for messages
    Shape shape;
    Placement placement{};
    Material material{};
};

/// The plane below the lowest point of all that is bounded; it fades into the background.
struct SceneGround {
    Material material{};
    std::optional<double> height{}; ///< along the camera's up direction; none: below the lowest point
};

/// What is not given is that of studio_lighting().
struct SceneLight {
    std::optional<Vec3d> toward_sun{};          ///< of any length but 0
    std::optional<Vec3> sun{}, sky{}, bounce{}; ///< Lighting's key, sky and ground
    SoftShadow shadow{};                        ///< of the sun
    bool casts_shadow = true;                   ///< else it shines through
};

struct SceneOcclusion {
    const Method* method = &find_method("traced"); ///< null: none, or that of images
    const ImageMethod* image_method = nullptr;     ///< beside a method that is null
    Length radius{0.1, Length::Unit::diagonal};    ///< of the box around all that is bounded
    std::vector<std::pair<std::string, double>> parameters{};
    OcclusionUse use = OcclusionUse::sky;
    std::optional<int> far_samples{}; ///< at the distance `far` from the eye and beyond; else as near it
    double far = 0.0;                 ///< scene units, > 0 where there are far_samples

    /// Of whichever it is; null for none.
    const MethodInfo* info() const { return method ? static_cast<const MethodInfo*>(method) : image_method; }
    /// Chooses by name, `none` included, and forgets the parameters of another. \throw InputError listing the names.
    void choose(std::string_view name);
};

struct Scene {
    std::vector<SceneObject> objects;
    std::optional<SceneGround> ground{};
    SceneLight light{};
    SceneOcclusion occlusion{};
    CameraOptions camera{};
    ImageSize size{};
    int samples = 4; ///< rays a pixel
};

/// The scene of one file without a word on how it is to be seen: on a ground. A .vdb is a level set, all else a mesh.
Scene scene_of(const std::filesystem::path& file);

}
