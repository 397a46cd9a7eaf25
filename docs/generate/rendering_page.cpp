// Writes docs/rendering.md with its images, and the gallery of README.md: the scenes of data/, one view by several
// methods with the error of each, and the effect of a blur on screen-space occlusion.
//
//     alcove_rendering_page <folder of meshes> <docs folder>
#include "page.h"

#include "alcove/scene/scene.h"

#include <alcove/alcove.h>

#include <fmt/format.h>

#include <cmath>

namespace alcove::docs {
namespace {

constexpr std::array scene_names{"documents", "pedestal", "bracket"};

/// A scene of data/, loaded and built.
struct LoadedScene {
    Scene scene;
    BuiltScene built;
    Camera camera;

    LoadedScene(const std::filesystem::path& data, const std::string& name, double scale,
                PassSet passes = standard_passes)
        : scene(resized(read_scene(data / (name + ".toml")), scale)), built(build_scene(scene, passes)),
          camera(make_camera(scene.camera, built.points, scene.size)) {}

    Image draw(PassSet passes) const {
        return render(built.renderable, camera, rendering_of(scene, built, camera, passes));
    }
    /// The ao of each pixel by a method, at the radius of the scene.
    std::vector<float> ao(std::string_view method, std::vector<std::pair<std::string, double>> parameters = {}) const {
        Scene other = scene;
        other.occlusion.choose(method);
        other.occlusion.parameters = std::move(parameters);
        return render(built.renderable, camera, rendering_of(other, built, camera, Pass::ao)).ao;
    }

  private:
    static Scene resized(Scene scene, double scale) {
        scene.size = {static_cast<int>(scene.size.width * scale), static_cast<int>(scene.size.height * scale)};
        return scene;
    }
};

/// The RMSE over the pixels that the renderable covers completely.
double rmse(const std::vector<float>& ao, const std::vector<float>& truth, const std::vector<float>& alpha) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < ao.size(); ++i)
        if (alpha[i] == 1.0f) {
            sum += std::pow(double(ao[i]) - double(truth[i]), 2.0);
            ++count;
        }
    return std::sqrt(sum / static_cast<double>(count));
}

void write_gallery(const std::filesystem::path& data, const std::filesystem::path& images) {
    for (const char* name : scene_names)
        write_png(LoadedScene(data, name, 0.67).draw(Pass::beauty), images / fmt::format("{}.png", name), Pass::beauty);
    PassSet all;
    for (const PassInfo& info : all_passes)
        all = all | info.pass;
    const Image passes = LoadedScene(data, "bracket", 0.34, all).draw(all);
    for (const PassInfo& info : all_passes)
        write_png(passes, images / fmt::format("pass_{}.png", info.name), info.pass);
}

std::string passes_table() {
    std::string table;
    for (std::size_t i = 0; i < all_passes.size(); i += 3) {
        std::string names("|"), image_cells("|");
        for (std::size_t k = i; k < i + 3; ++k) {
            names += fmt::format(" `{}` |", all_passes[k].name);
            image_cells += fmt::format(" ![{0}](images/gallery/pass_{0}.png) |", all_passes[k].name);
        }
        table += fmt::format("{}\n{}{}\n", names, i == 0 ? "| --- | --- | --- |\n" : "", image_cells);
    }
    return table;
}

std::string comparison(const std::filesystem::path& data, const std::filesystem::path& images) {
    const LoadedScene loaded(data, "pedestal", 0.4);
    const std::vector<float> truth = loaded.ao("traced", {{"rays", 256.0}, {"seed", 1.0}}); // 4 samples per pixel
    Image shown = loaded.draw(Pass::ao);
    std::string table = "| method | RMSE | |\n| --- | --- | --- |\n";
    for (const auto& [method, words] :
         {std::pair("traced", "16 rays per sample and four samples per pixel. The error is the noise of these rays."),
          std::pair("classic", "Too dark under the plate and between the legs, where the five probes along "
                               "the normal soon come near a surface. Black around the foot of the ball, "
                               "except on the seam, where the normals lead the probes outward."),
          std::pair("hemisphere", "A tenth too dark in the open, because of its formula, and soft."),
          std::pair("fibonacci", "Grey in the open (two thirds, because of its formula), and darker only in creases."),
          std::pair("screen_space",
                    "Right where the camera sees the occluder. Nothing is dark below the plate, whose underside "
                    "the camera does not see, and some areas behind outlines are wrongly dark."),
          std::pair("march_steps", "Not occlusion: it shows outlines, where rays pass close to a surface, "
                                   "and the distance to the ground.")}) {
        shown.ao = loaded.ao(method);
        const double error = rmse(shown.ao, truth, shown.alpha);
        write_png(shown, images / fmt::format("by_{}.png", method), Pass::ao);
        table += fmt::format("| `{0}` | {1:.3f} | ![{0}](images/gallery/by_{0}.png) {2} |\n", method, error, words);
    }
    return table;
}

std::string blurs(const std::filesystem::path& data) {
    std::string table = "| scene | no blur | Gaussian | bilateral |\n| --- | --- | --- | --- |\n";
    for (const char* name : scene_names) {
        const LoadedScene loaded(data, name, 0.5);
        const std::vector<float> truth = loaded.ao("traced", {{"rays", 64.0}, {"seed", 1.0}});
        const std::vector<float> alpha = loaded.draw(Pass::ao).alpha;
        table += fmt::format("| {} |", name);
        for (const double blur : {0.0, 1.0, 2.0})
            table += fmt::format(" {:.4f} |", rmse(loaded.ao("screen_space", {{"blur", blur}}), truth, alpha));
        table += "\n";
    }
    return table;
}

void write_page(const std::filesystem::path&, const std::filesystem::path& docs) {
    const std::filesystem::path data = docs / ".." / "data", images = docs / "images" / "gallery";
    std::filesystem::create_directories(images);
    write_gallery(data, images);
    write_text(docs / "rendering.md", fmt::format(R"(# Rendering

Written by `tools/docs.sh rendering`; [scenes.md](scenes.md) is the reference for scene files and passes.

## Passes

These are the passes of `data/bracket.toml`, each as a PNG.

{}
## One view by several methods

The images show the occlusion of `data/pedestal.toml`, at a radius of 15 % of its diagonal and with default settings.
The RMSE is over the pixels that the scene covers, against `traced` with 1,024 rays per pixel.

{}
## The effect of a blur on `screen_space`

The table gives the RMSE against `traced` with 256 rays per pixel. A Gaussian blur removes the noise of the samples,
but spreads occlusion across edges; the bilateral blur stops at edges.

{})",
                                                  passes_table(), comparison(data, images), blurs(data)));
}

}
}

int main(int argc, char** argv) {
    return alcove::docs::run_page(argc, argv, alcove::docs::write_page);
}
