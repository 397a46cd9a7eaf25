/// What the command line says of a picture: the scene of a file, and what is to be other than it says.
#pragma once

#include "method_options.h"
#include "voxelized.h"

#include "alcove/render/passes.h"
#include "alcove/scene/scene.h"

#include <optional>

namespace alcove::cli {

struct SceneRequest {
    std::string input;
    GridRequest grid;
    MethodRequest method;
    bool radius_given = false, method_given = false; ///< else those of the scene
    std::string size, eye, look_at, up;              ///< empty: those of the scene
    std::optional<double> fov{};
    std::optional<int> pixel_samples{};
    bool no_ground = false, no_shadow = false;
    std::optional<bool> own_normals{};
};

/// Adds the input, and the options of all these.
void add_scene_options(CLI::App& verb, SceneRequest& request);

/// A .toml is a scene, a .vdb a level set, all else a mesh; these are seen on a ground. The passes tell how much memory the
/// picture takes. \throw UsageError, and what read_scene() throws.
Scene requested_scene(const SceneRequest& request, PassSet passes);

}
