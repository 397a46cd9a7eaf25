#include "alcove/render/detail/image_method.h"

#include "alcove/render/detail/march_steps.h"
#include "alcove/render/detail/screen_space.h"

#include <algorithm>
#include <array>

namespace alcove {
namespace {

template <class M>
constexpr ImageMethod method() {
    return {info_of<M>(), M::bytes_per_pixel,
            [](const Renderable& renderable, const Camera& camera, const Settings& settings) {
                return with_settings<M>(settings)(renderable, camera);
            }};
}

constexpr std::array methods{method<MarchSteps>(), method<ScreenSpace>()};

}

std::span<const ImageMethod> image_methods() {
    return methods;
}

const ImageMethod* find_image_method(std::string_view name) {
    const auto found = std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
    return found == methods.end() ? nullptr : &*found;
}

}
