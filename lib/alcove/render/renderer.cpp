#include "alcove/render/renderer.h"

#include "alcove/parallel.h"
#include "alcove/render/camera_rays.h"

#include <algorithm>

namespace alcove {
namespace {

constexpr std::size_t samples_in_strip = std::size_t{1} << 20;

/// Averages the samples of the pixels from `first_pixel` on. The eye is in unit space.
void resolve(const Subject& subject, const Vec3d& eye, const Hits& hits, const std::vector<float>& ao,
             const RenderOptions& options, std::size_t first_pixel, std::size_t pixels, Image& image) {
    const auto samples = static_cast<std::size_t>(options.samples);
    parallel_for(pixels, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
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
            const std::size_t i = first_pixel + pixel;
            const float share = 1.0f / static_cast<float>(options.samples);
            image.color[i] = share * color;
            image.alpha[i] = share * covered;
            image.ao[i] = share * open;
            image.depth[i] = depth;
            image.normal[i] = normal;
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
    const auto samples = static_cast<std::size_t>(options.samples);
    const std::size_t strip = std::max<std::size_t>(1, samples_in_strip / samples);
    Hits hits;
    for (std::size_t first = 0; first < image.pixels(); first += strip) {
        const std::size_t pixels = std::min(strip, image.pixels() - first);
        hits.resize(pixels * samples);
        parallel_for(pixels * samples, 16 * RayBatch::capacity, [&](std::size_t begin, std::size_t end) {
            rays.trace(first * samples + begin, first * samples + end, begin, hits);
        });
        const auto done = [&](double part) {
            if (progress)
                progress((static_cast<double>(first) + part * static_cast<double>(pixels)) /
                         static_cast<double>(image.pixels()));
        };
        std::vector<float> ao(hits.surfels.size(), 1.0f);
        if (options.method)
            ao = std::move(bake_channels(hits.surfels, surroundings, *options.method, options.settings,
                                         Channel::ao, done)[Channel::ao]);
        resolve(subject, eye, hits, ao, options, first, pixels, image);
        done(1.0);
    }
    return image;
}

}
