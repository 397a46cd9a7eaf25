#include "alcove/scene/scene.h"

#include <algorithm>
#include <cctype>

namespace alcove {

Scene scene_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    Scene scene;
    scene.objects.push_back(
        {file.string(), extension == ".vdb" ? Shape(GridShape{file}) : Shape(MeshShape{file})});
    scene.ground = SceneGround{};
    return scene;
}

}
