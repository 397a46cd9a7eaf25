// A new estimator is one struct: its members are the parameters, its call operator is the method. This one is
// put to a field made of exact shapes, a ball that touches the ground.
#include <alcove/alcove.h>

#include <algorithm>
#include <cstdio>
#include <vector>

/// A single probe along the normal: how far the nearest surface is there, for how far it is over a plane.
struct SingleProbe {
    float height = 0.5f;

    template <alcove::Field F>
    void operator()(const F& field, const alcove::SurfelBatch& surfels, const alcove::Outputs& out) const {
        float* ao = out[alcove::Channel::ao];
        alcove::probe_along_normal(field, surfels, height, ao);
        for (std::size_t i = 0; i < surfels.count; ++i)
            ao[i] = std::clamp(ao[i] / height, 0.0f, 1.0f);
    }
};

int main() {
    const alcove::Union field(alcove::Plane{}, alcove::Sphere{.center = {0.0f, 1.0f, 0.0f}, .radius = 1.0f});

    std::vector<alcove::Surfel> ground;
    for (int i = 0; i < 4; ++i)
        ground.push_back(
            {.position = {0.9f + 0.2f * static_cast<float>(i), 0.0f, 0.0f}, .normal = {0.0f, 1.0f, 0.0f}});

    const std::vector<float> ao = alcove::bake(ground, field, SingleProbe{.height = 0.5f});
    for (std::size_t i = 0; i < ao.size(); ++i)
        std::printf("%.1f from where the ball touches: ao %.3f\n", ground[i].position.x, ao[i]);
}
