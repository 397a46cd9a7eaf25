#include "alcove/occlusion/detail/last_layer_fit.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove {
namespace {

constexpr std::size_t hidden = RingNetwork::hidden;

struct Examples {
    RingNetwork::Hidden h;
    std::vector<float> ao;
};

/// Random hidden values of a batch, and the ao that a last layer gives them.
Examples examples_of(const RingNetwork::LastLayer& layer, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Examples examples;
    for (auto& values : examples.h)
        for (float& value : values)
            value = unit(random);
    for (std::size_t k = 0; k < SurfelBatch::capacity; ++k) {
        float ao = 1.0f;
        for (std::size_t i = 0; i < hidden; ++i)
            ao += layer[i] * examples.h[i][k];
        examples.ao.push_back(ao);
    }
    return examples;
}

RingNetwork::LastLayer random_layer(std::mt19937& random) {
    std::uniform_real_distribution<float> darkening(-0.03f, 0.0f);
    RingNetwork::LastLayer layer;
    for (float& weight : layer)
        weight = darkening(random);
    return layer;
}

TEST(LastLayerFit, FindsTheLayerThatManyExamplesComeFrom) {
    std::mt19937 random(1);
    const RingNetwork::LastLayer trained = random_layer(random), true_layer = random_layer(random);
    LastLayerFit fit(trained);
    for (int i = 0; i < 200; ++i) {
        const Examples examples = examples_of(true_layer, random);
        fit.add(examples.h, examples.ao);
    }
    const RingNetwork::LastLayer found = fit.layer();
    for (std::size_t i = 0; i < hidden; ++i)
        EXPECT_NEAR(found[i], true_layer[i], 1e-3f);
}

TEST(LastLayerFit, StaysNearTheTrainedLayerWhereExamplesAreFew) {
    std::mt19937 random(2);
    const RingNetwork::LastLayer trained = random_layer(random);
    EXPECT_EQ(LastLayerFit(trained).layer(), trained);
    LastLayerFit fit(trained);
    const Examples examples = examples_of(random_layer(random), random);
    fit.add(examples.h, std::span(examples.ao).first(2));
    const RingNetwork::LastLayer found = fit.layer();
    for (std::size_t i = 0; i < hidden; ++i)
        EXPECT_NEAR(found[i], trained[i], 0.05f);
}

TEST(LastLayerFit, ChangesNothingWhereTheClampIsRight) {
    RingNetwork::LastLayer trained;
    trained.fill(0.1f); // every prediction exceeds 1
    std::mt19937 random(3);
    Examples examples = examples_of(trained, random);
    std::fill(examples.ao.begin(), examples.ao.end(), 1.0f);
    LastLayerFit fit(trained);
    fit.add(examples.h, examples.ao);
    for (const float weight : fit.layer())
        EXPECT_NEAR(weight, 0.1f, 1e-6f);
}

}
}
