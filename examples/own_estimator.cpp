// Adds an estimator: a struct whose members are the parameters and whose call operator is the method. Here it runs on
// an analytic field, a sphere that rests on the ground.
#include <alcove/field/primitives.h>
#include <alcove/occlusion/estimator.h>

#include <algorithm>
#include <cstdio>
#include <vector>

/// One probe along the normal: the distance there, relative to its value over an open plane.
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
        ground.push_back({.position = {0.9f + 0.2f * static_cast<float>(i), 0.0f, 0.0f}, .normal = {0.0f, 1.0f, 0.0f}});

    const std::vector<float> ao = alcove::evaluate_ao(ground, field, SingleProbe{.height = 0.5f});
    for (std::size_t i = 0; i < ao.size(); ++i)
        std::printf("%.1f from the point of contact: ao %.3f\n", ground[i].position.x, ao[i]);
}
