/// Every reference estimator against its published formula, on the reference scene and on open planes.
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

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/estimator.h"
#include "reference_scene.h"
#include "shapes.h"
#include "transcriptions.h"
#include "voxelized.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <type_traits>

namespace alcove {
namespace {

using test::Axes;
using test::Distance;

/// An estimator at its reference radius, and its formula.
struct Formula {
    std::string name;
    /// Evaluates the estimator at `times` the reference radius.
    std::function<std::vector<float>(std::span<const Surfel>, const AnyField&, float times)> bake;
    std::function<double(const Distance&, const Vec3d&, const Vec3d&)> transcription;
    std::optional<double> open = 1.0; ///< value on an open plane; empty if it depends on the plane
};

/// Evaluates one channel of an estimator that is set to its reference radius.
template <class E>
auto baked_by(E estimator, Channel channel = Channel::ao) {
    return [=](std::span<const Surfel> surfels, const AnyField& field, float times) {
        E scaled = estimator;
        scaled.radius *= times;
        return std::move(evaluate(surfels, field, scaled, channel)[channel]);
    };
}

/// A transcription with its constants bound.
template <class... Constants>
auto of(double (*transcription)(const Distance&, const Vec3d&, const Vec3d&, Constants...),
        std::type_identity_t<Constants>... constants) {
    return [=](const Distance& d, const Vec3d& p, const Vec3d& n) { return transcription(d, p, n, constants...); };
}

std::vector<Formula> formulas() {
    return {
        {"classic", baked_by(Classic{.radius = 0.13f}), of(test::classic)},
        {"convexity", baked_by(Classic{.radius = 0.13f}, Channel::convexity), of(test::convexity), 0.5},
        {"exponential", baked_by(Exponential{.radius = 1.0f}), of(test::exponential, 1.0)},
        {"exponential_factor", baked_by(Exponential{.radius = 1.0f, .factor = 0.6f}), of(test::exponential, 0.6), 0.6},
        {"decay", baked_by(Decay{.radius = 5 * 0.2f}), of(test::decay, 0.2)},
        {"decay_linear", baked_by(Decay{.radius = 5 * 0.2f, .linear = true}), of(test::decay_linear, 0.2)},
        {"multiplicative", baked_by(Multiplicative{.radius = 0.6f}), of(test::multiplicative)},
        {"multiscale", baked_by(Multiscale{.radius = 6.4f}), of(test::multiscale)},
        {"multiscale_short", baked_by(Multiscale{.radius = 6.4f}, Channel::ao_short), of(test::multiscale_short)},
        {"multiscale_long", baked_by(Multiscale{.radius = 6.4f}, Channel::ao_long), of(test::multiscale_long)},
        {"jittered", baked_by(Jittered{.radius = 4.0f}), of(test::jittered)},
        {"jittered_falloff", baked_by(Jittered{.radius = 1.0f, .falloff_form = true}), of(test::jittered_falloff, 1.0)},
        {"jittered_twice_falloff", baked_by(Jittered{.radius = 1.0f, .falloff_form = true, .falloff = 2.0f}),
         of(test::jittered_falloff, 2.0)},
        {"hemisphere_random",
         baked_by(HemisphereRandom{.radius = 4.01f}),
         of(test::hemisphere_random, Axes::world, 0.0),
         {}},
        {"hemisphere_random_seed",
         baked_by(HemisphereRandom{.radius = 4.01f, .seed = 7}),
         of(test::hemisphere_random, Axes::world, 7.0),
         {}},
        {"hemisphere_random_surfel",
         baked_by(HemisphereRandom{.radius = 4.01f, .surfel_frame = true}),
         of(test::hemisphere_random, Axes::surfel, 0.0),
         {}},
        {"hemisphere", baked_by(Hemisphere{.radius = 1.0f}), of(test::hemisphere, Axes::world, 32), {}},
        {"hemisphere_16",
         baked_by(Hemisphere{.radius = 1.0f, .samples = 16}),
         of(test::hemisphere, Axes::world, 16),
         {}},
        {"hemisphere_surfel",
         baked_by(Hemisphere{.radius = 1.0f, .surfel_frame = true}),
         of(test::hemisphere, Axes::surfel, 32),
         {}},
        {"fibonacci", baked_by(Fibonacci{.radius = 0.11f}), of(test::fibonacci, Axes::world), {}},
        {"fibonacci_surfel",
         baked_by(Fibonacci{.radius = 0.11f, .surfel_frame = true}),
         of(test::fibonacci, Axes::surfel),
         {}},
    };
}

class Documents : public testing::TestWithParam<Formula> {};

TEST_P(Documents, TheEstimatorIsTheFormulaOnTheirScene) {
    const test::ReferenceScene scene;
    const Distance d = [&](const Vec3d& x) { return scene.distance(x); };
    const std::vector<Surfel> surfels = scene.surfels(1000);
    const std::vector<float> values = GetParam().bake(surfels, scene.field, 1.0f);
    std::vector<double> expected;
    for (const Surfel& s : surfels)
        expected.push_back(GetParam().transcription(d, s.position, s.normal));
    for (std::size_t i = 0; i < surfels.size(); ++i)
        EXPECT_NEAR(values[i], expected[i], 1e-5);
    const auto [min, max] = std::minmax_element(expected.begin(), expected.end());
    EXPECT_GT(*max - *min, 0.2) << "the points must reach the creases for the test to be meaningful";
}

TEST_P(Documents, NeitherDependsOnTheScale) {
    const test::ReferenceScene scene;
    const std::vector<Surfel> surfels = scene.surfels(1000);
    const std::vector<float> unit = GetParam().bake(surfels, scene.field, 1.0f);
    for (const float scale : {1e-3f, 1e3f}) {
        std::vector<Surfel> scaled = surfels;
        for (Surfel& s : scaled)
            s.position *= scale;
        const Transformed<decltype(scene.field)> field{scene.field, glm::mat3(1.0f), scale};
        const std::vector<float> values = GetParam().bake(scaled, field, scale);
        for (std::size_t i = 0; i < values.size(); ++i)
            EXPECT_NEAR(values[i], unit[i], 1e-4);
    }
}

/// Unit vectors in all directions, including the axes.
std::vector<Vec3> orientations() {
    std::vector<Vec3> all{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    for (int i = 0; i < 500; ++i) {
        const Vec2 uv = fibonacci_point(i, 500, 0.3f, 0.6f);
        const Vec3 n = uniform_hemisphere(uv.x, uv.y);
        all.push_back(n);
        all.push_back(-n);
    }
    return all;
}

TEST_P(Documents, OnAnOpenPlaneItIsWhatTheFormulaSays) {
    for (const Vec3& n : orientations()) {
        const std::vector<Surfel> surfels{{{0, 0, 0}, n}};
        const float value = GetParam().bake(surfels, Plane{n, 0.0f}, 1.0f).front();
        const Distance d = [&](const Vec3d& x) { return glm::dot(x, Vec3d(n)); };
        EXPECT_NEAR(value, GetParam().open.value_or(GetParam().transcription(d, {0, 0, 0}, n)), 1e-5);
    }
}

/// The ranges printed with the reference formulas are correct for most planes, but not for all.
TEST(OpenPlane, TheHemisphereMethodsAreAsThePrintedRangesSay) {
    struct Range {
        double from, to; ///< as printed
        double min, max; ///< over all planes
    };
    const auto expect = [](const auto& estimator, const Range& range) {
        double sum = 0.0;
        int inside = 0, count = 0;
        for (const Vec3& n : orientations()) {
            const double ao = evaluate_ao(std::vector<Surfel>{{{0, 0, 0}, n}}, Plane{n, 0.0f}, estimator).front();
            EXPECT_GE(ao, range.min);
            EXPECT_LE(ao, range.max);
            sum += ao;
            inside += ao >= range.from && ao <= range.to;
            ++count;
        }
        EXPECT_GE(sum / count, range.from);
        EXPECT_LE(sum / count, range.to);
        EXPECT_GE(inside, 0.8 * count);
    };
    expect(Hemisphere{}, {0.91, 0.94, 0.90, 0.95});
    expect(Fibonacci{}, {0.62, 0.72, 0.62, 0.735});
    for (std::uint32_t seed = 0; seed < 10; ++seed)
        expect(HemisphereRandom{.seed = seed}, {0.75, 0.99, 0.60, 1.0});
}

TEST(OpenPlane, IsAllButWhiteAsAVoxelizedPlate) {
    const test::Voxelized plate(test::box_mesh({0.5, 0.5, 0.02}, 1), 0.1f);
    std::vector<Surfel> surfels;
    for (int x = -20; x <= 20; ++x)
        for (int y = -20; y <= 20; ++y)
            for (const double side : {1.0, -1.0})
                surfels.push_back({plate.frame.to_unit({0.0151 * x, 0.0147 * y, 0.02 * side}), {0, 0, side}});
    for (const char* name : {"classic", "exponential", "decay", "multiplicative", "multiscale", "jittered", "traced"}) {
        const ChannelValues values =
            evaluate(surfels, AnyField(plate.field), find_method(name), {.radius = 0.1f}, Channel::ao);
        EXPECT_GE(*std::ranges::min_element(values[Channel::ao]), 0.995f) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Documents, testing::ValuesIn(formulas()),
                         [](const auto& formula) { return formula.param.name; });

}
}
