// Writes docs/methods.md: every method of the catalog on three scenes, compared with exact rays.
//
//     alcove_methods_page <folder of meshes> <docs folder>
#include "page.h"
#include "row.h"
#include "words.h"

#include "alcove/bake/detail/error_figures.h"
#include "alcove/render/camera.h"
#include "alcove/render/detail/painted.h"
#include "alcove/render/renderer.h"

#include <alcove/alcove.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <filesystem>
#include <iostream>

namespace alcove::docs {
namespace {

constexpr ImageSize tile{320, 240};

/// What one method computes for a scene: an image, and the values that its error is measured on.
struct Result {
    Image image;
    std::vector<float> values;
};

class Scene {
  public:
    virtual ~Scene() = default;
    virtual Result result(const Method& method, const Settings& settings) const = 0;
    virtual const Method& reference() const = 0;
    virtual int reference_rays() const = 0;
    /// The radius that a method is shown at, in unit space.
    virtual float radius(const Method& method) const = 0;

    const Result& truth(float radius) {
        const auto [known, is_new] = truths_.try_emplace(radius);
        if (is_new)
            known->second = result(reference(), {.radius = radius, .parameters = {{"rays", reference_rays()}}});
        return known->second;
    }

  private:
    std::map<float, Result> truths_;
};

/// The scene of "SDF Ambient Occlusion — Detailed Reference" (sdfao2026), in reference units.
class ReferenceScene : public Scene {
  public:
    Result result(const Method& method, const Settings& settings) const override {
        Result result{render(renderable_, camera_, {.samples = 1, .method = &method, .settings = settings}), {}};
        for (std::size_t i = 0; i < result.image.pixels(); ++i)
            if (result.image.alpha[i] == 1.0f)
                result.values.push_back(result.image.ao[i]);
        return result;
    }
    /// The scene has no mesh to trace; sphere tracing an analytic field is as accurate.
    const Method& reference() const override { return find_method("traced"); }
    int reference_rays() const override { return 256; }
    float radius(const Method& method) const override {
        return method.reference_radius > 0.0f ? method.reference_radius : 1.0f;
    }

  private:
    static Box box() {
        Box box;
        box.add({-20.0, -0.5, -5.0});
        box.add({20.0, 2.2, 30.0});
        return box;
    }

    Renderable renderable_{Union(Plane{}, Sphere{{0, 1, 0}, 1.0f}, Torus{{0, 0.5f, 0}, 1.5f, 0.4f}), Frame{}, box()};
    Camera camera_{{0, 3, -6}, {0, 0.7, 0}, {0, 1, 0}, 40.0, tile};
};

/// A mesh, baked at its vertices.
class Scan : public Scene {
  public:
    Scan(const std::filesystem::path& file, const CameraOptions& view)
        : mesh_(read_mesh(file)), triangles_(triangulate(mesh_).triangles), frame_(frame_of(mesh_.box())),
          surfels_(make_surfels(mesh_, triangles_, frame_)), camera_(make_camera(view, mesh_.positions, tile)),
          occluders_(LevelStack(voxelize(mesh_, triangles_, {.grid = {.radius = 0.2f}})),
                     RaySurface(unit_positions(), triangles_)) {}

    Result result(const Method& method, const Settings& settings) const override {
        std::vector<float> ao = std::move(evaluate(surfels_, occluders_, method, settings, Channel::ao)[Channel::ao]);
        Result result{paint(mesh_.positions, triangles_, ao, camera_), {}};
        for (std::size_t i = 0; i < surfels_.size(); ++i)
            if (surfels_[i].has_normal())
                result.values.push_back(ao[i]);
        return result;
    }
    const Method& reference() const override { return find_method("exact"); }
    int reference_rays() const override { return 1024; }
    float radius(const Method&) const override { return 0.2f; }

  private:
    std::vector<Vec3> unit_positions() const {
        std::vector<Vec3> positions;
        for (const Vec3d& p : mesh_.positions)
            positions.push_back(frame_.to_unit(p));
        return positions;
    }

    Mesh mesh_;
    std::vector<Triangle> triangles_;
    Frame frame_;
    std::vector<Surfel> surfels_;
    Camera camera_;
    Occluders occluders_;
};

std::string parameters_of(const Method& method) {
    std::string text;
    for (const ParameterInfo& p : method.parameters())
        text += fmt::format("{}`{}={}`{}: {}", text.empty() ? "" : "; ", p.name,
                            p.flag ? (p.standard != 0.0 ? "true" : "false") : fmt::format("{:.6g}", p.standard),
                            p.unit.empty() ? "" : fmt::format(" {}", p.unit), p.summary);
    return text.empty() ? "none" : text;
}

std::string cost_of(const Method& method) {
    std::string text(method.cost);
    constexpr std::string_view call = "map()";
    if (const std::size_t at = text.find(call); at != std::string::npos)
        text.replace(at, call.size(), "`map()`");
    return text;
}

std::string section_of(const Method& method) {
    std::string summary(method.summary);
    summary[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(summary[0])));
    return fmt::format("## {0}\n\n{1}.\n\n    {2}\n\nSource: {3}. Cost: {4}. Parameters: {5}."
                       "\n\n![{0}](images/methods/{0}.png)\n\nGood: {6}. Bad: {7}.\n\n{8}\n\n",
                       method.name, summary, method.formula, method.source, cost_of(method), parameters_of(method),
                       method.good, method.bad, image_remarks.at(method.name));
}

void write_page(const std::filesystem::path& meshes, const std::filesystem::path& docs) {
    const std::filesystem::path images = docs / "images" / "methods";
    std::filesystem::create_directories(images);
    ReferenceScene reference;
    Scan dragon(meshes / "ChineseDragon-10kv.off", {});
    Scan armadillo(meshes / "armadillo.off", {.eye = Vec3d(110, 110, -280), .look_at = Vec3d(2, 28, 0)});
    const std::array<Scene*, 3> scenes{&reference, &dragon, &armadillo};

    write_png(row_of({reference.truth(1.0f).image, dragon.truth(0.2f).image, armadillo.truth(0.2f).image}),
              images / "reference.png", Pass::ao);
    std::string table, sections;
    for (const Method& method : catalog()) {
        if (!method.gives.has(Channel::ao))
            continue;
        std::vector<Image> tiles;
        std::string cells;
        for (Scene* scene : scenes) {
            if (method.needs_mesh && scene == &reference) {
                tiles.emplace_back(tile.width, tile.height);
                cells += " no mesh |";
                continue;
            }
            const float radius = scene->radius(method);
            Result result = scene->result(method, {.radius = radius});
            const ErrorFigures error = compare(result.values, scene->truth(radius).values);
            cells += fmt::format(" {:.3f} ({:+.3f}; {:.3f}) |", error.rmse, error.bias, error.deviation);
            tiles.push_back(std::move(result.image));
        }
        std::cerr << method.name << cells << "\n";
        write_png(row_of(tiles), images / fmt::format("{}.png", method.name), Pass::ao);
        table += fmt::format("| [{0}](#{0}) |{1} {2} |\n", method.name, cells, cost_of(method));
        sections += section_of(method);
    }
    write_text(docs / "methods.md", std::string(page_head) + std::string(table_head) + table + "\n" + sections);
}

}
}

int main(int argc, char** argv) {
    return alcove::docs::run_page(argc, argv, alcove::docs::write_page);
}
