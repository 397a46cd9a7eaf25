#include "alcove/field/field.h"
#include "alcove/field/primitives.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove {
namespace {

/// Primitives of general position and size.
const Plane plane{glm::normalize(Vec3(1, 2, -2)), 0.3f};
const Sphere sphere{{0.2f, -0.1f, 0.3f}, 0.7f};
const Cuboid cuboid{{-0.3f, 0.2f, 0.1f}, {0.5f, 0.3f, 0.8f}};
const Torus torus{{0.1f, 0.2f, -0.2f}, 0.9f, 0.25f};
const Capsule capsule{{-0.5f, 0.1f, 0.2f}, {0.6f, 0.4f, -0.3f}, 0.3f};

template <class F>
class Primitive : public testing::Test {
  public:
    static const F& shape();
};
template <>
const Plane& Primitive<Plane>::shape() {
    return plane;
}
template <>
const Sphere& Primitive<Sphere>::shape() {
    return sphere;
}
template <>
const Cuboid& Primitive<Cuboid>::shape() {
    return cuboid;
}
template <>
const Torus& Primitive<Torus>::shape() {
    return torus;
}
template <>
const Capsule& Primitive<Capsule>::shape() {
    return capsule;
}

using Shapes = testing::Types<Plane, Sphere, Cuboid, Torus, Capsule>;
TYPED_TEST_SUITE(Primitive, Shapes);

/// At a point, a function is the distance to its own zero set if its gradient has length 1 there, and if a step against
/// the gradient, as long as the value, ends on the zero set.
TYPED_TEST(Primitive, IsTheDistanceToItsOwnZeroSet) {
    const auto& shape = TestFixture::shape();
    std::mt19937 random(7);
    std::uniform_real_distribution<float> coordinate(-2.0f, 2.0f);
    int checked = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
        const float h = 1e-3f, d = shape.map(p);
        const auto slope = [&](const Vec3& e) { return (shape.map(p + h * e) - shape.map(p - h * e)) / (2 * h); };
        const Vec3 gradient(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1}));
        if (std::fabs(glm::length(gradient) - 1.0f) > 1e-2f)
            continue; // the medial axis, equally near to two sides
        ++checked;
        EXPECT_NEAR(shape.map(p - d * glm::normalize(gradient)), 0.0f, 5e-3f);
    }
    EXPECT_GT(checked, 1900);
}

TYPED_TEST(Primitive, StaysADistanceWhenTransformed) {
    const auto& shape = TestFixture::shape();
    Transformed<TypeParam> moved{shape};
    const float c = std::cos(0.7f), s = std::sin(0.7f);
    moved.rotation = glm::mat3(c, s, 0, -s, c, 0, 0, 0, 1);
    moved.scale = 2.5f;
    moved.translation = {0.3f, -1.0f, 0.7f};
    std::mt19937 random(8);
    std::uniform_real_distribution<float> coordinate(-2.0f, 2.0f);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
        const Vec3 q = moved.rotation * (moved.scale * p) + moved.translation;
        EXPECT_NEAR(moved.map(q), moved.scale * shape.map(p), 2e-5f);
    }
}

TEST(Primitives, KnownDistances) {
    EXPECT_FLOAT_EQ((Plane{{0, 1, 0}, 2.0f}.map({5, 3, 1})), 1.0f);
    EXPECT_FLOAT_EQ((Sphere{{1, 0, 0}, 2.0f}.map({1, 5, 0})), 3.0f);
    EXPECT_FLOAT_EQ((Cuboid{{0, 0, 0}, {1, 1, 1}}.map({4, 5, 0})), 5.0f);
    EXPECT_FLOAT_EQ((Cuboid{{0, 0, 0}, {1, 2, 3}}.map({0.5f, 0, 0})), -0.5f);
    EXPECT_FLOAT_EQ((Torus{{0, 0, 0}, 2.0f, 0.5f}.map({2, 1, 0})), 0.5f);
    EXPECT_FLOAT_EQ((Torus{{0, 0, 0}, 2.0f, 0.5f}.map({0, 0, 2})), -0.5f);
    EXPECT_FLOAT_EQ((Capsule{{0, 0, 0}, {0, 2, 0}, 0.5f}.map({3, 1, 0})), 2.5f);
    EXPECT_FLOAT_EQ((Capsule{{0, 0, 0}, {0, 0, 0}, 0.5f}.map({0, 0, 2})), 1.5f);
}

TEST(Combine, BatchedFormsEqualScalarOnes) {
    const Union field(sphere, Transformed<Torus>{torus, glm::mat3(1.0f), 0.5f, {0.4f, 0.0f, 0.1f}}, plane);
    const AnyField any(field);
    static_assert(BatchedField<decltype(field)> && BatchedField<AnyField>);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> coordinate(-2.0f, 2.0f);
    std::vector<float> x(1000), y(1000), z(1000), batched(1000), erased(1000);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = coordinate(random), y[i] = coordinate(random), z[i] = coordinate(random);
    const Points points{x.data(), y.data(), z.data(), x.size()};
    map_batch(field, points, any_reach, batched.data());
    map_batch(any, points, any_reach, erased.data());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec3 p = points[i];
        const float expected =
            std::min({sphere.map(p), 0.5f * torus.map((p - Vec3(0.4f, 0.0f, 0.1f)) / 0.5f), plane.map(p)});
        EXPECT_FLOAT_EQ(batched[i], expected);
        EXPECT_EQ(batched[i], erased[i]);
        EXPECT_EQ(any.map(p), field.map(p));
    }
}

/// A sheet: only a thin layer behind it is negative.
struct Sheet {
    Plane plane;
    float map(const Vec3& p) const {
        const float d = plane.map(p);
        return d < -0.01f ? -d : d;
    }
    float resolution() const { return 0.02f; }
    float extent() const { return 3.0f; }
    bool two_sided() const { return true; }
};

TEST(Combine, AUnionKnownAtRunTimeEqualsTheOneKnownBefore) {
    const Union fixed(sphere, torus, plane);
    const UnionOf<AnyField> list({sphere, torus, plane});
    std::mt19937 random(10);
    std::uniform_real_distribution<float> coordinate(-2.0f, 2.0f);
    std::vector<float> x(600), y(600), z(600), a(600), b(600);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = coordinate(random), y[i] = coordinate(random), z[i] = coordinate(random);
    const Points points{x.data(), y.data(), z.data(), x.size()};
    map_batch(fixed, points, any_reach, a.data());
    map_batch(list, points, any_reach, b.data());
    EXPECT_EQ(a, b);
    EXPECT_EQ(list.map({0.5f, 0.1f, 1.0f}), fixed.map({0.5f, 0.1f, 1.0f}));
    EXPECT_EQ(UnionOf<Sphere>({}).map({1, 2, 3}), any_reach);
}

TEST(Combine, ASheetJoinsASolidWithoutHidingInIt) {
    const Sheet sheet{{{0, 1, 0}, 0.0f}};
    const Sphere solid{{0, 0, 0}, 1.0f};
    const UnionOf<AnyField> field({solid, sheet});
    EXPECT_TRUE(field.two_sided());
    EXPECT_EQ(field.resolution(), 0.02f);
    for (const float x : {0.0f, 0.5f, 1.5f, 3.0f})
        for (const float y : {-2.0f, -0.5f, -0.005f, 0.005f, 0.5f, 2.0f}) {
            const Vec3 p(x, y, 0.1f);
            const float s = solid.map(p);
            // The solid is 0 everywhere inside, so that a ray that starts in it ends there.
            if (s <= 0.0f)
                EXPECT_EQ(field.map(p), 0.0f);
            else
                EXPECT_EQ(field.map(p), s < std::fabs(sheet.map(p)) ? s : sheet.map(p));
            float batched = 0.0f;
            field.map({&p.x, &p.y, &p.z, 1}, any_reach, &batched);
            EXPECT_EQ(batched, field.map(p));
        }
}

TEST(Combine, TheExtentIsThatOfTheFurthestPart) {
    const Sheet sheet{};
    const Transformed<Sheet> moved{sheet, glm::mat3(1.0f), 2.0f, {0, 4, 0}};
    EXPECT_FLOAT_EQ(extent(moved), 10.0f);
    EXPECT_FLOAT_EQ(extent(AnyField(UnionOf<AnyField>({sheet, moved}))), 10.0f);
    EXPECT_EQ(extent(Union(sheet, plane)), any_reach);
}

TEST(Combine, APlacedFieldMeansTheSamePlacesOfTheScene) {
    const Frame from{{10, -3, 2}, 4.0}, to{{8, 0, 0}, 0.5};
    const auto field = placed(sphere, from, to);
    for (const Vec3d& p : {Vec3d(10, -3, 2), Vec3d(13, 1, 2.5), Vec3d(8.5, -2, 1)})
        EXPECT_NEAR(field.map(to.to_unit(p)) * to.diagonal, sphere.map(from.to_unit(p)) * from.diagonal, 1e-5);
}

}
}
