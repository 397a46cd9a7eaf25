// Writes docs/rendering.md with its pictures, and the gallery of README.md: the scenes of data/, one view by several
// methods with the error of each, and what a blur does to occlusion of the picture itself.
//
//     alcove_rendering_page <folder of meshes> <docs folder>
#include "page.h"

#include <alcove/alcove.h>

#include <fmt/format.h>

#include <cmath>

namespace alcove::docs {
namespace {

constexpr std::array scene_names{"documents", "pedestal", "bracket"};

/// A scene of data/, built.
struct Set {
    Scene scene;
    BuiltScene built;
    Camera camera;

    Set(const std::filesystem::path& data, const std::string& name, double scale,
        PassSet passes = standard_passes)
        : scene(resized(read_scene(data / (name + ".toml")), scale)), built(build_scene(scene, passes)),
          camera(make_camera(scene.camera, built.points, scene.size)) {}

    Image draw(PassSet passes) const {
        return render(built.renderable, camera, rendering_of(scene, built, camera, passes));
    }
    /// The visibility of each pixel by a method, at the scene's own radius.
    std::vector<float> ao(std::string_view method,
                          std::vector<std::pair<std::string, double>> parameters = {}) const {
        Scene other = scene;
        other.occlusion.choose(method);
        other.occlusion.parameters = std::move(parameters);
        return render(built.renderable, camera, rendering_of(other, built, camera, Pass::ao)).ao;
    }

  private:
    static Scene resized(Scene scene, double scale) {
        scene.size = {static_cast<int>(scene.size.width * scale),
                      static_cast<int>(scene.size.height * scale)};
        return scene;
    }
};

/// Over the pixels that show the renderable alone.
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
        write_png(Set(data, name, 0.67).draw(Pass::beauty), images / fmt::format("{}.png", name),
                  Pass::beauty);
    PassSet all;
    for (const PassInfo& info : all_passes)
        all = all | info.pass;
    const Image passes = Set(data, "bracket", 0.34, all).draw(all);
    for (const PassInfo& info : all_passes)
        write_png(passes, images / fmt::format("pass_{}.png", info.name), info.pass);
}

std::string passes_table() {
    std::string table;
    for (std::size_t i = 0; i < all_passes.size(); i += 3) {
        std::string names("|"), pictures("|");
        for (std::size_t k = i; k < i + 3; ++k) {
            names += fmt::format(" `{}` |", all_passes[k].name);
            pictures += fmt::format(" ![{0}](images/gallery/pass_{0}.png) |", all_passes[k].name);
        }
        table += fmt::format("{}\n{}{}\n", names, i == 0 ? "| --- | --- | --- |\n" : "", pictures);
    }
    return table;
}

std::string comparison(const std::filesystem::path& data, const std::filesystem::path& images) {
    const Set set(data, "pedestal", 0.4);
    const std::vector<float> truth = set.ao("traced", {{"rays", 256.0}, {"seed", 1.0}}); // 4 samples a pixel
    Image shown = set.draw(Pass::ao);
    std::string table = "| method | RMSE | |\n| --- | --- | --- |\n";
    for (const auto& [method, words] :
         {std::pair("traced", "16 rays a sample, four samples a pixel: the rest is their noise."),
          std::pair(
              "classic",
              "Too dark under the plate and between the legs, where five probes straight ahead soon meet "
              "something; black around the foot of the ball but for its seam, whose normals lead them out."),
          std::pair("hemisphere", "A tenth too dark where all is open, by its own formula, and soft."),
          std::pair("fibonacci",
                    "Grey where all is open, two thirds by its own formula, and darker only in creases."),
          std::pair("screen_space",
                    "Right where what occludes is seen. Nothing is dark below the plate, whose underside "
                    "the camera does not see, and behind outlines something is that should not be."),
          std::pair(
              "march_steps",
              "No occlusion: outlines, where rays pass something closely, and the way to the ground.")}) {
        shown.ao = set.ao(method);
        const double error = rmse(shown.ao, truth, shown.alpha);
        write_png(shown, images / fmt::format("by_{}.png", method), Pass::ao);
        table += fmt::format("| `{0}` | {1:.3f} | ![{0}](images/gallery/by_{0}.png) {2} |\n", method, error,
                             words);
    }
    return table;
}

std::string blurs(const std::filesystem::path& data) {
    std::string table = "| scene | no blur | Gaussian | bilateral |\n| --- | --- | --- | --- |\n";
    for (const char* name : scene_names) {
        const Set set(data, name, 0.5);
        const std::vector<float> truth = set.ao("traced", {{"rays", 64.0}, {"seed", 1.0}});
        const std::vector<float> alpha = set.draw(Pass::ao).alpha;
        table += fmt::format("| {} |", name);
        for (const double blur : {0.0, 1.0, 2.0})
            table += fmt::format(" {:.4f} |", rmse(set.ao("screen_space", {{"blur", blur}}), truth, alpha));
        table += "\n";
    }
    return table;
}

void write_page(const std::filesystem::path&, const std::filesystem::path& docs) {
    const std::filesystem::path data = docs / ".." / "data", images = docs / "images" / "gallery";
    std::filesystem::create_directories(images);
    write_gallery(data, images);
    write_text(docs / "rendering.md", fmt::format(R"(# Pictures

Written by `tools/docs.sh rendering`; [scenes.md](scenes.md) is the reference of scene files and passes.

## Passes

`data/bracket.toml`, each pass as a PNG shows it.

{}
## One view by several methods

`data/pedestal.toml` with occlusion alone, at a radius of 15 % of its diagonal and default settings. RMSE is over the
pixels that the scene covers, against `traced` with 1,024 rays a pixel.

{}
## What a blur does to `screen_space`

RMSE against `traced` with 256 rays a pixel. A Gaussian blur takes the noise of the samples, and occlusion across edges;
the bilateral one stops at them.

{})",
                                                  passes_table(), comparison(data, images), blurs(data)));
}

}
}

int main(int argc, char** argv) {
    return alcove::docs::run_page(argc, argv, alcove::docs::write_page);
}
