#include "alcove/scene/scene.h"

#include "alcove/base/types.h"
#include "alcove/render/detail/image_method.h"

#include <algorithm>
#include <cctype>

namespace alcove {

const MethodInfo* SceneOcclusion::info() const {
    return method ? static_cast<const MethodInfo*>(method) : image_method;
}

void SceneOcclusion::choose(std::string_view name) {
    const MethodInfo* before = info();
    image_method = find_image_method(name);
    try {
        method = image_method || name == "none" ? nullptr : &find_method(name);
    } catch (const InputError& unknown) {
        std::string all = unknown.what();
        for (const ImageMethod& other : image_methods())
            all += ", " + std::string(other.name);
        throw InputError(all + ", none");
    }
    if (info() != before)
        parameters.clear();
    quality.reset();
}

void SceneOcclusion::choose(Quality wanted) {
    method = nullptr;
    image_method = nullptr;
    parameters.clear();
    quality = wanted;
}

Scene scene_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    Scene scene;
    const bool is_grid = extension == ".vdb";
    scene.objects.push_back(
        {file.string(), is_grid ? Shape(GridShape{file}) : Shape(MeshShape{.file = file, .own_colors = true})});
    scene.ground = SceneGround{};
    return scene;
}

}
