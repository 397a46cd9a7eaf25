#include "alcove/measure/detail/heat_map.h"

#include "alcove/render/detail/painted.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove {
namespace {

constexpr ImageSize size{320, 240};

/// Base64 encoding (Josefsson 2006).
std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
        const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        for (unsigned k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

/// The colour of t in [0, 1], in linear light.
Vec3 heat(float t) {
    static constexpr std::array stops{Vec3(0.85f), Vec3(0.95f, 0.55f, 0.10f), Vec3(0.55f, 0.03f, 0.02f),
                                      Vec3(0.02f, 0.0f, 0.01f)};
    const float at = std::clamp(t, 0.0f, 1.0f) * (stops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    return glm::mix(stops[i], stops[i + 1], at - static_cast<float>(i));
}

}

std::string heat_map(const Mesh& mesh, std::span<const Triangle> triangles, std::span<const float> errors) {
    std::vector<Vec3d> seen;
    for (const Triangle& triangle : triangles)
        for (const std::uint32_t corner : triangle)
            seen.push_back(mesh.positions[corner]);
    std::vector<float> sizes(errors.size());
    std::transform(errors.begin(), errors.end(), sizes.begin(), [](float e) { return std::fabs(e); });
    const Camera camera = make_camera({}, seen, size);
    Image image = paint(mesh.positions, triangles, sizes, camera);
    for (std::size_t i = 0; i < image.pixels(); ++i)
        if (image.alpha[i] > 0.0f) {
            // Shades faces that turn away, to keep the shape readable.
            const float facing = std::fabs(glm::dot(image.normal[i], Vec3(camera.forward())));
            image.color[i] =
                image.alpha[i] * (0.5f + 0.5f * facing) * heat(image.ao[i] / image.alpha[i] / largest_drawn_error);
        }
    return "data:image/png;base64," + base64(encode_png(image, Pass::beauty));
}

}
