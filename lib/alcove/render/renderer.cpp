#include "alcove/render/renderer.h"

#include "alcove/parallel.h"
#include "alcove/render/camera_rays.h"

#include <algorithm>

namespace alcove {
namespace {

constexpr std::size_t samples_at_once = std::size_t{1} << 20;

/// Rectangles that cover the image, of as many samples as are worked on at once, or of a single pixel.
std::vector<PixelRegion> regions(ImageSize size, int samples) {
    const auto pixels = std::max<std::size_t>(1, samples_at_once / static_cast<std::size_t>(samples));
    const int columns = static_cast<int>(std::min(pixels, static_cast<std::size_t>(size.width)));
    int rows = static_cast<int>(
        std::min(pixels / static_cast<std::size_t>(columns), static_cast<std::size_t>(size.height)));
    if (rows > CameraRays::tile_side)
        rows -= rows % CameraRays::tile_side;
    std::vector<PixelRegion> all;
    for (int y = 0; y < size.height; y += rows)
        for (int x = 0; x < size.width; x += columns)
            all.push_back({x, y, std::min(columns, size.width - x), std::min(rows, size.height - y)});
    return all;
}

/// Averages the samples of the pixels of a region. The eye is in unit space.
void resolve(const Subject& subject, const Vec3d& eye, const Hits& hits, const std::vector<float>& ao,
             const RenderOptions& options, const PixelRegion& region, Image& image) {
    const auto samples = static_cast<std::size_t>(options.samples);
    const auto resolve_pixel = [&](std::size_t pixel, std::size_t i) {
        Vec3 color(0.0f), normal(0.0f);
        float open = 0.0f, depth = far_depth, covered = 0.0f;
        for (std::size_t s = pixel * samples; s < (pixel + 1) * samples; ++s) {
            const Surfel& surfel = hits.surfels[s];
            if (!surfel.has_normal())
                continue;
            const ObjectId object = hits.objects[s];
            const Ground* ground = ground_of(subject, object);
            const float coverage = ground ? ground->coverage(surfel.position) : 1.0f;
            const Vec3 to_eye(glm::normalize(eye - Vec3d(surfel.position)));
            covered += coverage;
            color += coverage * shade(options.lighting, material_of(subject, object),
                                      {.normal = surfel.normal, .to_eye = to_eye, .ao = ao[s]});
            open += coverage * ao[s];
            if (hits.depths[s] < depth) {
                depth = hits.depths[s];
                normal = surfel.normal;
            }
        }
        const float share = 1.0f / static_cast<float>(options.samples);
        image.color[i] = share * color;
        image.alpha[i] = share * covered;
        image.ao[i] = share * open;
        image.depth[i] = depth;
        image.normal[i] = normal;
    };
    parallel_for(static_cast<std::size_t>(region.height), 4, [&](std::size_t begin, std::size_t end) {
        const auto width = static_cast<std::size_t>(region.width);
        for (std::size_t row = begin; row < end; ++row) {
            const std::size_t first =
                (static_cast<std::size_t>(region.y) + row) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(region.x);
            for (std::size_t x = 0; x < width; ++x)
                resolve_pixel(row * width + x, first + x);
        }
    });
}

}

Lighting studio_lighting(const Camera& camera, const Vec3d& up) {
    Lighting lighting;
    lighting.up = Vec3(glm::normalize(up));
    lighting.toward_key =
        Vec3(glm::normalize(-0.6 * camera.right() + 0.7 * camera.up() - 0.6 * camera.forward()));
    return lighting;
}

Image render(const Subject& subject, const Camera& camera, const RenderOptions& options,
             const Progress& progress) {
    Image image(camera.size().width, camera.size().height);
    const CameraRays rays(subject, camera, options.samples);
    const AnyField surroundings = subject.surroundings();
    const Vec3d eye = (camera.eye() - subject.frame.center) / subject.frame.diagonal;
    std::size_t finished = 0;
    Hits hits;
    for (const PixelRegion& region : regions(camera.size(), options.samples)) {
        hits.resize(region.pixels() * static_cast<std::size_t>(options.samples));
        parallel_for(region.tiles(CameraRays::tile_side), 32,
                     [&](std::size_t begin, std::size_t end) { rays.trace(region, begin, end, hits); });
        const auto done = [&](double part) {
            if (progress)
                progress((static_cast<double>(finished) + part * static_cast<double>(region.pixels())) /
                         static_cast<double>(image.pixels()));
        };
        std::vector<float> ao(hits.surfels.size(), 1.0f);
        if (options.method)
            ao = std::move(bake_channels(hits.surfels, surroundings, *options.method, options.settings,
                                         Channel::ao, done)[Channel::ao]);
        resolve(subject, eye, hits, ao, options, region, image);
        done(1.0);
        finished += region.pixels();
    }
    return image;
}

}
