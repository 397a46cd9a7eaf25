/// The scene of an image: a file, and the options that override its settings.
#pragma once

#include "options.h"

#include "alcove/render/image.h"
#include "alcove/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace alcove::cli {

struct SceneRequest {
    std::string input;
    // An empty option keeps the setting of the scene.
    std::optional<Length> radius{}, voxel{}, weld{};
    SignChoice sign = SignChoice::automatic;
    std::optional<Quality> quality{};
    MethodRequest method{};
    std::string size{}, texture{};
    std::optional<Vec3d> eye{}, look_at{}, up{};
    std::optional<double> fov{};
    std::optional<int> pixel_samples{};
    std::vector<std::string> grid_names{};
    bool no_ground = false, no_shadow = false;
    std::optional<bool> own_normals{}, own_colors{};
};

/// Adds the input and the options of SceneRequest.
void add_scene_options(CLI::App& verb, SceneRequest& request);

/// Reads a scene (.toml), or makes a scene with a ground plane from a level set (.vdb) or a mesh (any other file).
/// `passes` determine the memory of the image, which is limited. \throw UsageError, and what read_scene() throws.
Scene requested_scene(const SceneRequest& request, PassSet passes);

}
