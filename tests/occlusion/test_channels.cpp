/// Tests the cost of channels, and that requesting more channels changes no values.
#include "alcove/base/types.h"
#include "alcove/field/primitives.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/methods/reference/classic.h"
#include "alcove/occlusion/methods/reference/decay.h"
#include "alcove/occlusion/methods/reference/exponential.h"
#include "alcove/occlusion/methods/reference/fibonacci.h"
#include "alcove/occlusion/methods/reference/hemisphere.h"
#include "alcove/occlusion/methods/reference/hemisphere_random.h"
#include "alcove/occlusion/methods/reference/jittered.h"
#include "alcove/occlusion/methods/reference/multiplicative.h"
#include "alcove/occlusion/methods/reference/multiscale.h"
#include "alcove/occlusion/methods/traced.h"
#include "reference_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>

namespace alcove {
namespace {

/// A field that counts map() calls.
template <Field F>
struct Counted {
    F field;
    std::shared_ptr<std::atomic<std::size_t>> calls = std::make_shared<std::atomic<std::size_t>>(0);

    float map(const Vec3& p) const {
        ++*calls;
        return field.map(p);
    }
    void map(const Points& points, float reach, float* distances) const {
        *calls += points.count;
        map_batch(field, points, reach, distances);
    }
};

/// The number of map() calls of a bake.
template <class E>
std::size_t calls(const E& estimator, ChannelSet wanted) {
    const test::ReferenceScene scene;
    const Counted field{scene.field};
    evaluate(scene.surfels(1000), field, estimator, wanted);
    return *field.calls;
}

TEST(Channels, ComeOutOfOnePass) {
    const Classic classic{.radius = 0.13f};
    EXPECT_EQ(calls(classic, Channel::ao), 5000u);
    EXPECT_LE(calls(classic, Channel::ao | Channel::convexity), 10000u);
    EXPECT_LE(calls(classic, Channel::ao | Channel::convexity | Channel::bent_normal), 14000u);
    const Traced traced{.radius = 0.5f, .rays = 16};
    EXPECT_EQ(calls(traced, Channel::ao | Channel::bent_normal), calls(traced, Channel::ao));
}

/// A field, and a triangle in the ground for methods that need triangles.
Occluders with_ground(AnyField field) {
    const std::vector<Vec3> corners{{-9, 0, -9}, {9, 0, -9}, {0, 0, 9}};
    return {std::move(field), RaySurface(corners, std::vector<Triangle>{{0, 1, 2}})};
}

const ChannelSet everything = [] {
    ChannelSet set;
    for (const ChannelInfo& channel : channels)
        set = set | channel.channel;
    return set;
}();

TEST(Channels, OfAllKindsLeaveTheAoAsItIs) {
    const test::ReferenceScene scene;
    const std::vector<Surfel> surfels = scene.surfels(200);
    const Occluders occluders = with_ground(scene.field);
    for (const Method& method : catalog()) {
        if (!method.gives.has(Channel::ao))
            continue;
        const ChannelSet halves = Channel::ao_short | Channel::ao_long;
        const ChannelSet all = everything.without(halves.without(method.gives));
        const ChannelValues one = evaluate(surfels, occluders, method, {.radius = 0.5f}, Channel::ao);
        const ChannelValues many = evaluate(surfels, occluders, method, {.radius = 0.5f}, all);
        EXPECT_EQ(one[Channel::ao], many[Channel::ao]) << method.name;
        for (const ChannelInfo& channel : channels) {
            EXPECT_EQ(one[channel.channel].size(), channel.channel == Channel::ao ? 200u : 0u);
            EXPECT_EQ(many[channel.channel].size(), all.has(channel.channel) ? 200u * channel.components : 0u);
        }
    }
}

TEST(Channels, AreGivenByTheChosenMethodElseByTheFirst) {
    const Method &classic = find_method("classic"), &traced = find_method("traced"), &decay = find_method("decay"),
                 &multiscale = find_method("multiscale");
    const auto names = [](const Method& chosen, ChannelSet wanted) {
        std::vector<std::string_view> found;
        for (const Method* method : methods_for(chosen, wanted))
            found.push_back(method->name);
        return found;
    };
    using Names = std::vector<std::string_view>;
    EXPECT_EQ(names(classic, Channel::ao | Channel::convexity), Names{"classic"});
    EXPECT_EQ(names(traced, Channel::ao | Channel::bent_normal), Names{"traced"});
    EXPECT_EQ(names(decay, Channel::ao | Channel::convexity | Channel::bent_normal), (Names{"decay", "classic"}));
    EXPECT_EQ(names(decay, Channel::thickness), Names{"thickness"});
    EXPECT_EQ(names(multiscale, Channel::ao | Channel::ao_short | Channel::ao_long), Names{"multiscale"});
    EXPECT_TRUE(names(classic, {}).empty());
    for (const Channel half : {Channel::ao_short, Channel::ao_long})
        try {
            methods_for(classic, half);
            FAIL();
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("multiscale"), std::string::npos);
        }
}

void expect_wrong(const std::string& method, const std::string& name, double value, const std::string& part) {
    const std::vector<const Method*> methods{&find_method(method)};
    try {
        check_settings(methods, {.parameters = {{name, value}}});
        FAIL() << method << " took " << name << " = " << value;
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(Settings, AreCheckedByNameAndRange) {
    expect_wrong("classic", "rays", 5, "samples, strength, falloff");
    expect_wrong("classic", "radius", 0.1, "no parameter 'radius'");
    expect_wrong("classic", "samples", 1, "from 2 to");
    expect_wrong("classic", "samples", 2.5, "whole number");
    expect_wrong("classic", "strength", -1, "from 0 to 100");
    expect_wrong("classic", "strength", std::nan(""), "from 0 to 100");
    expect_wrong("classic", "strength", INFINITY, "from 0 to 100");
    expect_wrong("traced", "cosine_weighted", 0.5, "whole number");
    expect_wrong("traced", "seed", 4294967296.0, "seed of traced");
    // If several methods run, a parameter may belong to any of them; it goes to the first that has it.
    const std::vector<const Method*> two{&find_method("decay"), &find_method("traced")};
    EXPECT_NO_THROW(check_settings(two, {.parameters = {{"rays", 5}, {"linear", 1}}}));
    EXPECT_THROW(check_settings(two, {.parameters = {{"strength", 1}}}), InputError);
    EXPECT_THROW(evaluate({}, with_ground(Plane{}), find_method("classic"), {.parameters = {{"rays", 5}}}, Channel::ao),
                 InputError);
}

TEST(Settings, ReachTheFirstMethodThatHasThemAlone) {
    const test::ReferenceScene scene;
    const std::vector<Surfel> surfels = scene.surfels(300);
    const Occluders occluders = with_ground(scene.field);
    const ChannelSet wanted = Channel::ao | Channel::convexity;
    const auto baked = [&](std::vector<std::pair<std::string, double>> parameters) {
        return evaluate(surfels, occluders, find_method("calibrated"),
                        {.radius = 0.5f, .parameters = std::move(parameters)}, wanted);
    };
    const ChannelValues standard = baked({}), sampled = baked({{"samples", 13}}), weaker = baked({{"strength", 0.5}});
    EXPECT_NE(sampled[Channel::ao], standard[Channel::ao]);
    EXPECT_EQ(sampled[Channel::convexity], standard[Channel::convexity]);
    EXPECT_EQ(weaker[Channel::ao], standard[Channel::ao]);
    EXPECT_NE(weaker[Channel::convexity], standard[Channel::convexity]);
}

TEST(Settings, EveryParameterStartsInRangeAndIsSetByItsName) {
    const test::ReferenceScene scene;
    const std::vector<Surfel> surfels = scene.surfels(300);
    const std::vector<std::uint32_t> order = spatial_order(surfels);
    const Occluders occluders = with_ground(scene.field);
    for (const Method& method : catalog()) {
        const auto baked = [&](std::vector<std::pair<std::string, double>> parameters) {
            const Settings settings{.radius = 0.5f, .parameters = std::move(parameters)};
            check_settings(std::vector{&method}, settings);
            return method.bake(surfels, order, occluders, settings, method.gives, {});
        };
        const ChannelValues standard = baked({});
        for (const ParameterInfo& p : method.parameters()) {
            SCOPED_TRACE(fmt::format("{} of {}", p.name, method.name));
            EXPECT_FALSE(p.name.empty() || p.summary.empty());
            EXPECT_LE(p.min, p.standard);
            EXPECT_GE(p.max, p.standard);
            const std::string name(p.name);
            EXPECT_EQ(baked({{name, p.standard}}).values, standard.values);
            // Limits counts to keep the test fast.
            const double max = p.integer && name != "seed" ? std::min(p.max, 64.0) : p.max;
            bool matters = false;
            for (const double value : {p.min, max}) {
                const ChannelValues values = baked({{name, value}});
                matters |= values.values != standard.values;
                for (const ChannelInfo& channel : channels)
                    for (const float found : values[channel.channel])
                        EXPECT_TRUE(found >= (channel.components == 3 ? -1.0f : 0.0f) && found <= 1.0f) << found;
            }
            EXPECT_TRUE(matters || p.name == "falloff");
        }
    }
}

template <class... E>
void expect_round_trip() {
    const auto of = [](auto standard) {
        for (const auto& p : decltype(standard)::parameters())
            for (const double value : {p.min, p.max, p.get(standard)}) {
                auto estimator = standard;
                p.set(estimator, value);
                EXPECT_EQ(p.get(estimator), p.integer ? value : double(float(value))) << p.name;
            }
    };
    (of(E{}), ...);
}

TEST(Settings, WhatIsSetIsGot) {
    expect_round_trip<Classic, Exponential, Decay, Multiplicative, Multiscale, Jittered, Hemisphere, HemisphereRandom,
                      Fibonacci, Traced>();
}

}
}
