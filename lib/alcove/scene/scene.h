/// Scenes: as plain data (objects, light, camera, image size), as files, and built for rendering.
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/base/types.h"
#include "alcove/grid/voxelize.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"
#include "alcove/render/renderer.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace alcove {

/// p' = rotation · (scale · p) + translation, in scene units; rotated about x, then y, then z.
struct Placement {
    Vec3d translation{0.0};
    Vec3d rotation{0.0}; ///< degrees, counterclockwise as seen from the tip of each axis
    double scale = 1.0;  ///< > 0
};

// The shapes, in scene units, before placement. field/primitives.h defines their distances.
struct SphereShape {
    Vec3d center{0.0};
    double radius = 1.0;
};
struct BoxShape {
    Vec3d center{0.0};
    Vec3d size{1.0}; ///< full edge lengths
};
struct TorusShape {
    Vec3d center{0.0};
    double ring = 1.0, tube = 0.25; ///< radii
};
struct CapsuleShape {
    Vec3d start{0.0}, end{0.0, 1.0, 0.0};
    double radius = 0.5;
};
/// The half-space below the plane is solid.
struct PlaneShape {
    Vec3d point{0.0};
    Vec3d normal{0.0, 1.0, 0.0}; ///< of any length but 0
};
struct MeshShape {
    std::filesystem::path file;
    std::optional<Length> voxel{}; ///< by default automatic; a percentage is of the mesh's own diagonal
    SignChoice sign = SignChoice::automatic;
    bool own_normals = true; ///< use the normals of the mesh (corner_normals()) instead of the field's
    bool painted = false;    ///< the brightness of its vertex colours multiplies the ao
    /// Whether the mesh's own colours (own_colors()) replace the colour of the material. If unset, they do not, and a
    /// warning says so.
    std::optional<bool> own_colors{};
    std::optional<Length> weld{};    ///< join vertices closer than this; a percentage is of the mesh's own diagonal
    std::filesystem::path texture{}; ///< a .png or .exr that colours the mesh by its UVs, one per scene; empty: none
};
/// A level set in a .vdb file.
struct GridShape {
    std::filesystem::path file;
    std::vector<std::string> names{}; ///< see GridSelection
};
struct SceneObject;
struct CompositeShape {
    enum class Operation { unite, subtract };
    Operation operation = Operation::unite;
    std::vector<SceneObject> parts; ///< at least one; their materials are ignored
    double blend = 0.0;             ///< width of the rounded seams, scene units, >= 0
};

using Shape =
    std::variant<SphereShape, BoxShape, TorusShape, CapsuleShape, PlaneShape, MeshShape, GridShape, CompositeShape>;

struct SceneObject {
    std::string name; ///< used in messages
    Shape shape;
    Placement placement{};
    Material material{};
};

/// A ground plane that fades into the background.
struct SceneGround {
    Material material{};
    std::optional<double> height{}; ///< along the camera's up direction; by default the lowest point
};

/// Members that are not set get their values from studio_lighting().
struct SceneLight {
    std::optional<Vec3d> toward_sun{};          ///< of any length but 0
    std::optional<Vec3> sun{}, sky{}, bounce{}; ///< key, sky and ground of Lighting
    SoftShadow shadow{};                        ///< of the sun
    bool casts_shadow = true;                   ///< whether the sun casts shadows
};

struct SceneOcclusion {
    /// If no method is named, chooses a method and its number of rays: guided, or traced if a shape has no zero
    /// isosurface.
    std::optional<Quality> quality = Quality::good;
    const Method* method = nullptr;             ///< null if no method is named, or if an image method is
    const ImageMethod* image_method = nullptr;  ///< set only if `method` is null
    Length radius{0.1, Length::Unit::diagonal}; ///< a percentage is of the box around all bounded objects
    std::vector<std::pair<std::string, double>> parameters{};
    OcclusionUse use = OcclusionUse::sky;
    std::optional<int> far_samples{}; ///< samples at the distance `far` from the eye and beyond
    double far = 0.0;                 ///< scene units; > 0 if far_samples is set

    /// Whether the quality chooses the method.
    bool is_planned() const { return quality && !method && !image_method; }
    /// The named method or image method; null if none is named.
    const MethodInfo* info() const;
    /// Chooses a method by name, or "none"; clears the parameters if the method changes. \throw InputError for an
    /// unknown name, listing the known ones.
    void choose(std::string_view name);
    /// Chooses by quality; clears the parameters.
    void choose(Quality wanted);
};

struct Scene {
    std::vector<SceneObject> objects;
    std::optional<SceneGround> ground{};
    SceneLight light{};
    SceneOcclusion occlusion{};
    CameraOptions camera{};
    ImageSize size{};
    int samples = 4; ///< rays per pixel
};

/// A scene with one file as its only object, on a ground. A .vdb is a level set; any other file is a mesh, which is
/// shown in its own colours.
Scene scene_of(const std::filesystem::path& file);

/// Paths in the scene are relative to its folder; the files are not opened. \throw InputError, with file, line and fix,
/// for invalid TOML, an unknown key (naming the closest known one), a value of the wrong type or out of range, and if
/// the file cannot be read; LimitError as read_mesh().
Scene read_scene(const std::filesystem::path& file);

struct BuiltScene {
    Renderable renderable;
    std::vector<Vec3d> points; ///< surface points of the bounded objects, to aim a camera at; scene units
    float radius = 0.0f;       ///< radius of occlusion, unit space
    MethodChoice occlusion{};  ///< empty for "none" and for image methods
    double voxel = 0.0;        ///< largest of the objects' finest voxels, scene units; 0 without grids
    std::size_t levels = 0;    ///< largest number of levels of an object
    std::vector<std::string> warnings{};
};

/// Builds a scene for rendering. Unit space belongs to the box around all bounded objects; a radius in % refers to the
/// diagonal of that box. Level sets with a smaller reach than occlusion and soft shadows need for `passes` are extended
/// by extend_levels(). The ground is perpendicular to `up` of the scene's camera.
///
/// \throw what read_mesh(), read_grids() and voxelize() throw; InputError also for an open surface in a difference or
/// blended union, for a plane that is in a union or the first part of a difference, and for an empty scene. The
/// messages name the object or its file.
BuiltScene build_scene(const Scene& scene, PassSet passes = standard_passes, const Progress& progress = {});

/// The options for rendering a built scene. By default, named methods that trace rays use at most 16 rays per sample.
RenderOptions rendering_of(const Scene& scene, const BuiltScene& built, const Camera& camera,
                           PassSet passes = standard_passes);

}
