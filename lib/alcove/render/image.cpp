#include "alcove/render/image.h"

namespace alcove {

Image::Image(int w, int h, PassSet wanted) : width(w), height(h), passes(wanted) {
    const std::size_t count = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    const auto assign = [&](Pass pass, auto& values, const auto& value) {
        if (passes.has(pass))
            values.assign(count, value);
    };
    alpha.assign(count, 0.0f);
    assign(Pass::beauty, color, Vec3(0.0f));
    assign(Pass::ao, ao, 0.0f);
    assign(Pass::convexity, convexity, 0.0f);
    assign(Pass::shadow, shadow, 0.0f);
    assign(Pass::steps, steps, 0.0f);
    assign(Pass::depth, depth, far_depth);
    assign(Pass::normal, normal, Vec3(0.0f));
    assign(Pass::position, position, Vec3(0.0f));
    assign(Pass::object, object, 0.0f);
}

double Image::bytes_per_pixel(PassSet passes) {
    double bytes = sizeof(float);
    for (const PassInfo& info : all_passes)
        if (passes.has(info.pass)) {
            const bool vector = info.pass == Pass::beauty || info.pass == Pass::normal || info.pass == Pass::position;
            bytes += vector ? sizeof(Vec3) : sizeof(float);
        }
    return bytes;
}

}
