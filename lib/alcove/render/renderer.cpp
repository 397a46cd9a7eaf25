#include "alcove/render/renderer.h"

#include "alcove/base/parallel.h"
#include "alcove/occlusion/detail/contacts.h"
#include "alcove/render/detail/hit_values.h"
#include "alcove/render/detail/image_method.h"
#include "alcove/render/detail/snap.h"

#include <algorithm>
#include <limits>

namespace alcove {
namespace {

constexpr std::size_t samples_at_once = std::size_t{1} << 18;

/// Splits the image into rectangles of at most samples_at_once samples, but at least one pixel.
std::vector<PixelRegion> regions(ImageSize size, int samples) {
    const auto pixels = std::max<std::size_t>(1, samples_at_once / static_cast<std::size_t>(samples));
    const int columns = static_cast<int>(std::min(pixels, static_cast<std::size_t>(size.width)));
    int rows =
        static_cast<int>(std::min(pixels / static_cast<std::size_t>(columns), static_cast<std::size_t>(size.height)));
    if (rows > CameraRays::tile_side)
        rows -= rows % CameraRays::tile_side;
    std::vector<PixelRegion> all;
    for (int y = 0; y < size.height; y += rows)
        for (int x = 0; x < size.width; x += columns)
            all.push_back({x, y, std::min(columns, size.width - x), std::min(rows, size.height - y)});
    return all;
}

/// Repeats the value of each pixel of a region, once for each of its samples.
std::vector<float> spread(const std::vector<float>& pixels, int width, const PixelRegion& region, int samples) {
    std::vector<float> values;
    values.reserve(region.pixels() * static_cast<std::size_t>(samples));
    for (int y = region.y; y < region.y + region.height; ++y)
        for (int x = region.x; x < region.x + region.width; ++x)
            values.insert(
                values.end(), static_cast<std::size_t>(samples),
                pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]);
    return values;
}

/// Averages the samples of each pixel of a region.
class Resolver {
  public:
    Resolver(const Renderable& renderable, const Vec3d& eye, const RenderOptions& options, Image& image)
        : renderable_(renderable), eye_(eye), options_(options), image_(image) {}

    void operator()(const PixelRegion& region, const Hits& hits, const HitValues& values) const {
        parallel_for(static_cast<std::size_t>(region.height), 4, [&](std::size_t begin, std::size_t end) {
            const auto width = static_cast<std::size_t>(region.width);
            for (std::size_t row = begin; row < end; ++row) {
                const std::size_t first =
                    (static_cast<std::size_t>(region.y) + row) * static_cast<std::size_t>(image_.width) +
                    static_cast<std::size_t>(region.x);
                for (std::size_t x = 0; x < width; ++x)
                    resolve(hits, values, row * width + x, first + x);
            }
        });
    }

  private:
    /// Uses the colour of the mesh as ao, as reflectance, or not at all, as the part specifies.
    static void apply(const Vec3& color, const Part& part, Place& place) {
        if (part.painted)
            place.painted = (color.x + color.y + color.z) / 3.0f;
        if (part.colored)
            place.color = color;
    }

    void resolve(const Hits& hits, const HitValues& values, std::size_t pixel, std::size_t i) const {
        const auto samples = static_cast<std::size_t>(options_.samples);
        const auto value = [](const std::vector<float>& all, std::size_t s, float missing) {
            return all.empty() ? missing : all[s];
        };
        Vec3 color(0.0f);
        float alpha = 0.0f, ao = 0.0f, convexity = 0.0f, shadow = 0.0f, steps = 0.0f;
        float depth = std::numeric_limits<float>::infinity();
        std::size_t nearest = 0;
        for (std::size_t s = pixel * samples; s < (pixel + 1) * samples; ++s) {
            steps += value(hits.steps, s, 0.0f);
            const Surfel& surfel = hits.surfels[s];
            if (!surfel.has_normal())
                continue;
            const ObjectId object = hits.objects[s];
            const Ground* ground = ground_of(renderable_, object);
            const float coverage = ground ? ground->coverage(surfel.position) : 1.0f;
            Place place{.normal = surfel.normal,
                        .to_eye = glm::normalize(Vec3(eye_ - Vec3d(surfel.position))),
                        .ao = value(values.ao, s, 1.0f),
                        .shadow = options_.casts_shadow ? value(values.shadow, s, 1.0f) : 1.0f,
                        .convexity = value(values.convexity, s, 0.5f)};
            if (!hits.colors.empty() && !ground)
                apply(hits.colors[s], renderable_.parts[object - 1u], place);
            alpha += coverage;
            ao += coverage * place.ao;
            convexity += coverage * place.convexity;
            shadow += coverage * value(values.shadow, s, 1.0f);
            if (image_.passes.has(Pass::beauty))
                color += coverage * shade(options_.lighting, material_of(renderable_, object), place);
            if (hits.depths[s] < depth) {
                depth = hits.depths[s];
                nearest = s;
            }
        }
        const float share = 1.0f / static_cast<float>(options_.samples);
        const auto set = [&](Pass pass, auto& pixels, const auto& mean) {
            if (image_.passes.has(pass))
                pixels[i] = mean;
        };
        image_.alpha[i] = share * alpha;
        set(Pass::beauty, image_.color, share * color);
        set(Pass::ao, image_.ao, share * ao);
        set(Pass::convexity, image_.convexity, share * convexity);
        set(Pass::shadow, image_.shadow, share * shadow);
        set(Pass::steps, image_.steps, share * steps);
        if (!(depth < std::numeric_limits<float>::infinity()))
            return;
        const Surfel& surfel = hits.surfels[nearest];
        set(Pass::depth, image_.depth, depth);
        set(Pass::normal, image_.normal, surfel.normal);
        set(Pass::position, image_.position, Vec3(renderable_.frame.to_scene(surfel.position)));
        set(Pass::object, image_.object, static_cast<float>(hits.objects[nearest]));
    }

    const Renderable& renderable_;
    const Vec3d& eye_; // unit space
    const RenderOptions& options_;
    Image& image_;
};

}

Lighting studio_lighting(const Camera& camera, const Vec3d& up) {
    Lighting lighting;
    lighting.up = Vec3(glm::normalize(up));
    lighting.toward_key = Vec3(glm::normalize(-0.6 * camera.right() + 0.7 * camera.up() - 0.6 * camera.forward()));
    return lighting;
}

Image render(const Renderable& renderable, const Camera& camera, const RenderOptions& options,
             const Progress& progress) {
    Image image(camera.size().width, camera.size().height, options.passes);
    const CameraRays rays(renderable, camera, options.samples);
    const bool needs_mesh = options.method && options.method->needs_mesh;
    const Occluders surroundings = needs_mesh && renderable.mesh
                                       ? Occluders(renderable.surroundings(), renderable.mesh->surface)
                                       : Occluders(renderable.surroundings());
    const Vec3d eye = (camera.eye() - renderable.frame.center) / renderable.frame.diagonal;
    const Resolver resolve(renderable, eye, options, image);
    std::vector<float> ao_of_pixels;
    if (options.image_method && need_ao(options.passes))
        ao_of_pixels = options.image_method->occlusion(renderable, camera, options.settings);
    std::size_t finished = 0;
    Hits hits;
    for (const PixelRegion& region : regions(camera.size(), options.samples)) {
        hits.resize(region.pixels() * static_cast<std::size_t>(options.samples), options.passes.has(Pass::steps));
        parallel_for(region.tiles(CameraRays::tile_side), 32,
                     [&](std::size_t begin, std::size_t end) { rays.trace(region, begin, end, hits); });
        if (renderable.mesh) {
            hits.colors.resize(renderable.mesh->colors.empty() ? 0 : hits.surfels.size());
            hits.faces.assign(hits.surfels.size(), {});
            parallel_for(hits.surfels.size(), 16 * RayBatch::capacity,
                         [&](std::size_t begin, std::size_t end) { snap(renderable, rays, begin, end, hits); });
            if (options.method && need_ao(options.passes))
                find_contacts(hits.surfels, renderable.mesh->surface, ray_offset(options.settings.radius),
                              [&](std::size_t i, const Triangle& face) { return face == hits.faces[i]; });
        }
        const auto done = [&](double part) {
            if (progress)
                progress((static_cast<double>(finished) + part * static_cast<double>(region.pixels())) /
                         static_cast<double>(image.pixels()));
        };
        HitValues values = values_of(hits, renderable, surroundings, eye, options, done);
        if (!ao_of_pixels.empty())
            values.ao = spread(ao_of_pixels, image.width, region, options.samples);
        resolve(region, hits, values);
        done(1.0);
        finished += region.pixels();
    }
    return image;
}

}
