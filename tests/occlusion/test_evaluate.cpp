#include "alcove/occlusion/estimator.h"

#include "alcove/base/types.h"
#include "alcove/field/primitives.h"
#include "alcove/occlusion/catalog.h"

#include <gtest/gtest.h>

#include <set>

namespace alcove {
namespace {

/// A new estimator is a single struct; this one returns the height of a surfel.
struct Height {
    float top = 1.0f;

    template <Field F>
    void operator()(const F&, const SurfelBatch& surfels, const Outputs& out) const {
        for (std::size_t i = 0; i < surfels.count; ++i)
            out[Channel::ao][i] = std::clamp(surfels.y[i] / top, 0.0f, 1.0f);
    }
};

TEST(Bake, TakesAnyEstimatorAndKeepsTheOrderOfTheSurfels) {
    std::vector<Surfel> surfels;
    for (int i = 0; i < 10000; ++i)
        surfels.push_back(
            {{static_cast<float>(i * 37 % 101), static_cast<float>(i * 53 % 997) / 997.0f, 0}, {0, 1, 0}});
    surfels[77].normal = Vec3(0.0f);
    const std::vector<float> ao = evaluate_ao(surfels, Plane{}, Height{});
    for (std::size_t i = 0; i < surfels.size(); ++i)
        EXPECT_EQ(ao[i], i == 77 ? 1.0f : surfels[i].position.y);
}

TEST(Bake, OfNothingIsNothing) {
    EXPECT_TRUE(evaluate_ao(std::vector<Surfel>{}, Plane{}, Height{}).empty());
    EXPECT_EQ(evaluate_ao(std::vector<Surfel>{{{0, 0, 0}, {0, 0, 0}}}, Plane{}, Height{}), std::vector<float>{1.0f});
}

TEST(Bake, SpatialOrderIsAPermutationOfTheSurfelsWithANormal) {
    std::vector<Surfel> surfels;
    for (int i = 0; i < 1000; ++i)
        surfels.push_back(
            {{static_cast<float>(i * 7 % 10), static_cast<float>(i / 10 * 3 % 10), static_cast<float>(i / 100)},
             i % 7 ? Vec3(0, 1, 0) : Vec3(0.0f)});
    const std::vector<std::uint32_t> order = spatial_order(surfels);
    const std::set<std::uint32_t> seen(order.begin(), order.end());
    EXPECT_EQ(seen.size(), order.size());
    EXPECT_EQ(order.size(), 1000u - 143u);
    double path = 0.0, file_path = 0.0;
    for (std::size_t i = 1; i < order.size(); ++i)
        path += glm::length(surfels[order[i]].position - surfels[order[i - 1]].position);
    for (std::size_t i = 1; i < surfels.size(); ++i)
        file_path += glm::length(surfels[i].position - surfels[i - 1].position);
    EXPECT_LT(path, file_path / 2);
}

TEST(Catalog, EveryMethodSaysWhatItIsAndBakes) {
    std::set<std::string_view> names;
    const std::vector<Surfel> surfels(100, Surfel{{0.1f, 0, 0.2f}, {0, 1, 0}});
    const std::vector<Vec3> corners{{-1, 0, -1}, {1, 0, -1}, {0, 0, 2}};
    const Occluders plane(Plane{}, RaySurface(corners, std::vector<Triangle>{{0, 1, 2}}));
    for (const Method& method : catalog()) {
        EXPECT_TRUE(names.insert(method.name).second);
        EXPECT_FALSE(method.summary.empty() || method.formula.empty() || method.source.empty() || method.cost.empty() ||
                     method.good.empty() || method.bad.empty());
        if (method.gives.has(Channel::ao))
            EXPECT_EQ(&find_method(method.name), &method);
        else
            EXPECT_THROW(find_method(method.name), InputError);
        const ChannelValues values = method.bake(surfels, spatial_order(surfels), plane, {}, method.gives, {});
        for (const ChannelInfo& channel : channels) {
            ASSERT_EQ(values[channel.channel].size(),
                      method.gives.has(channel.channel) ? surfels.size() * channel.components : 0);
            for (const float value : values[channel.channel]) {
                EXPECT_GE(value, channel.channel == Channel::bent_normal ? -1.0f : 0.0f);
                EXPECT_LE(value, 1.0f);
            }
        }
    }
}

TEST(Catalog, AnUnknownMethodIsRefusedWithTheKnownOnes) {
    try {
        find_method("clasic");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("classic"), std::string::npos);
    }
}

}
}
