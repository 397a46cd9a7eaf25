/// Screen-space occlusion against traced rays on complete scenes.
#include "alcove/render/detail/screen_space.h"
#include "alcove/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

class ScreenSpaceScene : public testing::TestWithParam<const char*> {};

TEST_P(ScreenSpaceScene, BilateralBlurIsNearerToTracedRaysThanNoneAndGaussian) {
    Scene scene = read_scene(std::string(ALCOVE_DATA "/") + GetParam() + ".toml");
    scene.samples = 1;
    scene.size = {scene.size.width / 4, scene.size.height / 4};
    const BuiltScene built = build_scene(scene);
    const Camera camera = make_camera(scene.camera, built.points, scene.size);
    RenderOptions options = rendering_of(scene, built, camera, Pass::ao);
    options.settings.parameters = {{"rays", 64.0}};
    const Image traced = render(built.renderable, camera, options);
    const DepthBuffer seen = look(built.renderable, camera);
    const auto error = [&](Blur blur) {
        ScreenSpace method{.blur = static_cast<int>(blur)};
        const std::vector<float> ao = method(seen, double(built.radius) * built.renderable.frame.diagonal);
        double sum = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < ao.size(); ++i)
            if (traced.alpha[i] == 1.0f) {
                sum += std::pow(double(ao[i]) - double(traced.ao[i]), 2.0);
                ++count;
            }
        return std::sqrt(sum / count);
    };
    const double none = error(Blur::none), gaussian = error(Blur::gaussian), bilateral = error(Blur::bilateral);
    std::printf("%s: RMSE %.4f without blur, %.4f Gaussian, %.4f bilateral\n", GetParam(), none, gaussian, bilateral);
    EXPECT_LT(bilateral, none);
    EXPECT_LT(bilateral, gaussian);
}

INSTANTIATE_TEST_SUITE_P(Data, ScreenSpaceScene, testing::Values("documents", "pedestal", "bracket"),
                         [](const auto& scene) { return scene.param; });

}
}
