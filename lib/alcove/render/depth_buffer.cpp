#include "alcove/render/depth_buffer.h"

#include "alcove/render/renderer.h"

namespace alcove {

DepthBuffer look(const Subject& subject, const Camera& camera) {
    Image image = render(subject, camera, {.samples = 1, .passes = Pass::depth | Pass::normal});
    return {camera, std::move(image.depth), std::move(image.normal)};
}

}
