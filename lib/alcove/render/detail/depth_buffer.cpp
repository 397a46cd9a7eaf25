#include "alcove/render/detail/depth_buffer.h"

#include "alcove/render/renderer.h"

namespace alcove {

DepthBuffer look(const Renderable& renderable, const Camera& camera) {
    Image image = render(renderable, camera, {.samples = 1, .passes = Pass::depth | Pass::normal});
    return {camera, std::move(image.depth), std::move(image.normal)};
}

}
