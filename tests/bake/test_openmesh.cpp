#include "alcove/bake/openmesh.h"

#include "shapes.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <gtest/gtest.h>

namespace alcove {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<>;
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<>;
using DoubleMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

static_assert(OpenMeshType<TriMesh> && OpenMeshType<PolyMesh> && OpenMeshType<DoubleMesh>);
static_assert(!OpenMeshType<OpenMesh::PolyConnectivity> && !OpenMeshType<Mesh>);

/// A box that floats over a plate. The faces are quads, and float represents all coordinates exactly.
Mesh box_over_plate() {
    Mesh mesh;
    test::add_part(mesh, test::box_mesh({1.0, 0.125, 1.0}, 4), 1.0, {0, 0, 0});
    test::add_part(mesh, test::box_mesh({0.25, 0.25, 0.25}, 2), 1.0, {0, 0.5, 0});
    return mesh;
}

Mesh triangles_of(const Mesh& mesh) {
    Mesh result;
    result.positions = mesh.positions;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        result.add_face(Triangle{face[0], face[1], face[2]});
        result.add_face(Triangle{face[0], face[2], face[3]});
    }
    return result;
}

template <OpenMeshType T>
T to_openmesh(const Mesh& mesh) {
    T result;
    using Point = typename T::Point;
    using Scalar = typename Point::value_type;
    for (const Vec3d& p : mesh.positions)
        result.add_vertex(Point(static_cast<Scalar>(p.x), static_cast<Scalar>(p.y), static_cast<Scalar>(p.z)));
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::vector<OpenMesh::VertexHandle> corners;
        for (const std::uint32_t v : mesh.face(f))
            corners.emplace_back(static_cast<int>(v));
        result.add_face(corners);
    }
    return result;
}

template <class T>
bool has_property(T& mesh, const char* name) {
    return OpenMesh::hasProperty<OpenMesh::VertexHandle, float>(mesh, name);
}

/// A fast method without a pilot, since these tests only compare values.
BakeOptions quick() {
    return {.radius = "20%", .method = "exact", .parameters = {{"rays", 32}}, .pilot = false};
}

template <OpenMeshType T>
void expect_baked_like(const Mesh& mesh) {
    T other = to_openmesh<T>(mesh);
    const Mesh converted = to_mesh(other);
    EXPECT_EQ(converted.positions, mesh.positions);
    EXPECT_EQ(converted.corners, mesh.corners);
    EXPECT_EQ(converted.face_begin, mesh.face_begin);
    EXPECT_TRUE(converted.normals.empty());
    const Baked expected = bake(mesh, quick()), baked = bake(other, quick());
    EXPECT_EQ(baked.ao(), expected.ao());
    EXPECT_LT(*std::min_element(expected.ao().begin(), expected.ao().end()), 0.9f);
    const auto ao = OpenMesh::getProperty<OpenMesh::VertexHandle, float>(other, "ao");
    for (const auto v : other.vertices())
        EXPECT_EQ(ao[v], expected.ao()[static_cast<std::size_t>(v.idx())]);
    EXPECT_FALSE(other.property(ao.getRawProperty()).persistent());
}

TEST(BakeOpenMesh, GivesTheValuesOfTheSameMesh) {
    expect_baked_like<PolyMesh>(box_over_plate());
    expect_baked_like<DoubleMesh>(box_over_plate());
    expect_baked_like<TriMesh>(triangles_of(box_over_plate()));
    Mesh fine = box_over_plate(); // coordinates that float cannot represent
    for (Vec3d& p : fine.positions)
        p = p / 3.0 + Vec3d(1000.0);
    expect_baked_like<DoubleMesh>(fine);
}

TEST(BakeOpenMesh, StoresEachRequestedChannelUnderItsName) {
    auto mesh = to_openmesh<PolyMesh>(box_over_plate());
    OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, float>(mesh, "mine");
    BakeOptions options = quick();
    options.attributes = Channel::ao | Channel::bent_normal | Channel::thickness;
    const Baked baked = bake(mesh, options);
    for (const char* name : {"ao", "thickness", "mine"})
        EXPECT_TRUE(has_property(mesh, name)) << name;
    for (const char* name : {"convexity", "ao_short", "ao_long", "bent_normal"})
        EXPECT_FALSE(has_property(mesh, name)) << name;
    const auto bent = OpenMesh::getProperty<OpenMesh::VertexHandle, OpenMesh::Vec3f>(mesh, "bent_normal");
    const auto thickness = OpenMesh::getProperty<OpenMesh::VertexHandle, float>(mesh, "thickness");
    for (const auto v : mesh.vertices()) {
        const auto i = static_cast<std::size_t>(v.idx());
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(bent[v][c], baked[Channel::bent_normal][3 * i + c]);
        EXPECT_EQ(thickness[v], baked[Channel::thickness][i]);
    }
}

TEST(BakeOpenMesh, StoresTheOtherChannels) {
    auto mesh = to_openmesh<PolyMesh>(box_over_plate());
    const Baked baked = bake(mesh, {.radius = "20%",
                                    .method = "multiscale",
                                    .attributes = Channel::ao_short | Channel::ao_long | Channel::convexity,
                                    .pilot = false});
    for (const Channel channel : {Channel::ao_short, Channel::ao_long, Channel::convexity}) {
        const char* const name = info(channel).name.data();
        ASSERT_TRUE(has_property(mesh, name)) << name;
        const auto values = OpenMesh::getProperty<OpenMesh::VertexHandle, float>(mesh, name);
        for (const auto v : mesh.vertices())
            EXPECT_EQ(values[v], baked[channel][static_cast<std::size_t>(v.idx())]);
    }
}

TEST(BakeOpenMesh, ReplacesTheValuesOfAnExistingProperty) {
    auto mesh = to_openmesh<PolyMesh>(box_over_plate());
    auto ao = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, float>(mesh, "ao");
    mesh.property(ao.getRawProperty()).set_persistent(true);
    ao.set_range(mesh.vertices(), 7.0f);
    const std::size_t before = mesh.n_vprops();
    bake(mesh, quick());
    EXPECT_EQ(mesh.n_vprops(), before);
    EXPECT_TRUE(mesh.property(ao.getRawProperty()).persistent());
    for (const auto v : mesh.vertices())
        EXPECT_LE(ao[v], 1.0f);
}

TEST(BakeOpenMesh, LeavesOutWhatIsDeleted) {
    const Mesh whole = box_over_plate();
    auto mesh = to_openmesh<DoubleMesh>(whole);
    for (const int f : {0, 1, 97})
        mesh.delete_face(OpenMesh::FaceHandle(f), false);
    mesh.delete_vertex(OpenMesh::VertexHandle(20), false);
    auto ao = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, float>(mesh, "ao");
    ao[OpenMesh::VertexHandle(20)] = 7.0f;

    auto collected = mesh;
    bake(mesh, quick());
    EXPECT_EQ(ao[OpenMesh::VertexHandle(20)], 7.0f);
    EXPECT_EQ(mesh.n_vertices(), whole.vertex_count());
    const Mesh converted = to_mesh(mesh);
    EXPECT_EQ(converted.vertex_count(), whole.vertex_count() - 1);
    EXPECT_LT(converted.face_count(), whole.face_count() - 3);
    const Baked expected = bake(converted, quick());
    std::size_t i = 0;
    for (const auto v : mesh.vertices())
        EXPECT_EQ(ao[v], expected.ao()[i++]);

    // Collecting garbage reorders the elements: nearly the same values at other indices.
    collected.garbage_collection();
    const Mesh rest = to_mesh(collected);
    EXPECT_EQ(rest.vertex_count(), converted.vertex_count());
    EXPECT_EQ(rest.face_count(), converted.face_count());
    EXPECT_EQ(bake(collected, quick()).ao(), bake(rest, quick()).ao());
}

TEST(BakeOpenMesh, TakesTheNormalsOfTheMesh) {
    auto mesh = to_openmesh<PolyMesh>(box_over_plate());
    mesh.request_vertex_normals();
    for (const auto v : mesh.vertices())
        mesh.set_normal(v, PolyMesh::Normal(0, 2, 0));
    EXPECT_EQ(to_mesh(mesh).normals, std::vector<Vec3>(mesh.n_vertices(), Vec3(0, 1, 0)));

    Mesh up = box_over_plate();
    up.normals.assign(up.vertex_count(), Vec3(0, 1, 0));
    EXPECT_EQ(bake(mesh, quick()).ao(), bake(up, quick()).ao());
    BakeOptions by_angle = quick();
    by_angle.normals = NormalSource::angle;
    EXPECT_EQ(bake(mesh, by_angle).ao(), bake(box_over_plate(), quick()).ao());
    for (const auto v : mesh.vertices())
        mesh.set_normal(v, PolyMesh::Normal(0, 0, 0)); // requested and never set
    EXPECT_EQ(bake(mesh, quick()).ao(), bake(box_over_plate(), quick()).ao());
}

}
}
