// Renders a torus around a sphere, on a ground plane, with ambient occlusion:
//
//     render_scene OUTPUT.png
#include <alcove/render/image.h>
#include <alcove/render/renderer.h>
#include <alcove/scene/scene.h>

#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments) try {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: render_scene OUTPUT.png\n");
        return 2;
    }
    alcove::Scene scene;
    scene.objects.push_back({.name = "sphere", .shape = alcove::SphereShape{.center = {0.0, 1.0, 0.0}}});
    scene.objects.push_back({.name = "torus",
                             .shape = alcove::TorusShape{.center = {0.0, 0.4, 0.0}, .ring = 1.5, .tube = 0.4},
                             .material = {.color = {0.8f, 0.5f, 0.3f}}});
    scene.ground = alcove::SceneGround{};
    scene.occlusion.radius = alcove::Length(1.0);
    scene.size = {640, 480};

    const alcove::PassSet passes = alcove::Pass::beauty;
    const alcove::BuiltScene built = alcove::build_scene(scene, passes);
    const alcove::Camera camera = alcove::make_camera(scene.camera, built.points, scene.size);
    const alcove::RenderOptions options = alcove::rendering_of(scene, built, camera, passes);
    const alcove::Image image = alcove::render(built.renderable, camera, options);
    alcove::write_png(image, arguments[1], alcove::Pass::beauty);

    std::printf("%s: %d x %d pixels\n", arguments[1], image.width, image.height);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "render_scene: %s\n", error.what());
    return 1;
}
