#include "alcove/scene/detail/triangles.h"

#include "alcove/base/types.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/directions.h"
#include "alcove/scene/detail/corner_normals.h"

#include <array>
#include <cmath>

namespace alcove {
namespace {

constexpr float voxel = 1.0f / 256.0f;

/// Linear light of an sRGB byte, in [0, 1] (srgb1999).
float decoded(std::uint8_t byte) {
    const float s = static_cast<float>(byte) / 255.0f;
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

float brightness(const Color& color) {
    return (decoded(color[0]) + decoded(color[1]) + decoded(color[2])) / 3.0f;
}

class Collector {
  public:
    explicit Collector(const Frame& frame) : frame_(frame) {}

    /// Sets the object of everything added from now on.
    void begin(ObjectId object) { object_ = object; }

    void add_mesh(const LoadedShape& loaded, const MeshShape& shape) {
        if (shape.painted && loaded.mesh.vertex_colors.empty())
            throw InputError(loaded.object->name + ": is painted, but the mesh has no vertex colours");
        is_painted_ = is_painted_ || shape.painted;
        const auto first = static_cast<std::uint32_t>(positions_.size());
        const auto add_vertex = [&](std::uint32_t vertex, const Vec3& normal) {
            const Vec3d& p = loaded.mesh.positions[vertex];
            add_position(is_finite(p) ? frame_.to_unit(loaded.pose(p)) : Vec3(0.0f),
                         Vec3(loaded.pose.rotation * Vec3d(normal)),
                         shape.painted ? brightness(loaded.mesh.vertex_colors[vertex]) : 1.0f);
        };
        if (!shape.own_normals) {
            for (std::uint32_t vertex = 0; vertex < loaded.mesh.positions.size(); ++vertex)
                add_vertex(vertex, Vec3(0.0f));
            add_triangles(loaded.triangles, first);
            return;
        }
        // Normals differ between corners, so each corner gets its own vertex.
        const auto normals = corner_normals(loaded.mesh, loaded.triangles);
        for (std::size_t f = 0; f < loaded.triangles.size(); ++f) {
            for (std::size_t corner = 0; corner < 3; ++corner)
                add_vertex(loaded.triangles[f][corner], normals[f][corner]);
            const auto at = static_cast<std::uint32_t>(3 * f);
            triangles_.push_back({first + at, first + at + 1, first + at + 2});
        }
    }

    /// Adds the zero surface of a field, on voxels relative to the size of the shape.
    void add_field(const LoadedShape& loaded, const AnyField& field) {
        if (two_sided(field))
            throw InputError(loaded.object->name +
                             ": is an open surface without a mesh, so it has no triangles for rays");
        const Frame own = frame_of(loaded.box);
        const auto in_own = placed(field, frame_, own);
        const auto sample = [&](std::span<const Vec3> points, float* distances) {
            for (std::size_t i = 0; i < points.size(); ++i)
                distances[i] = in_own.map(points[i]);
        };
        try {
            const Mesh mesh = mesh_zero_surface(sample, voxel);
            const auto first = static_cast<std::uint32_t>(positions_.size());
            for (const Vec3d& p : mesh.positions)
                add_position(frame_.to_unit(own.to_scene(Vec3(p))), Vec3(0.0f), 1.0f);
            add_triangles(triangulate(mesh).triangles, first);
        } catch (const InputError& error) {
            throw InputError(loaded.object->name + ": " + error.what());
        }
    }

    void add_ground(const Plane& plane) {
        const Basis basis(plane.normal);
        const auto first = static_cast<std::uint32_t>(positions_.size());
        constexpr float horizon = 100.0f; // as in longest_ray()
        for (const Vec2 corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
            add_position(plane.offset * basis.normal +
                             horizon * (corner.x * basis.tangent + corner.y * basis.bitangent),
                         Vec3(0.0f), 1.0f);
        add_triangles(std::array{Triangle{0, 1, 2}, Triangle{0, 2, 3}}, first);
    }

    std::shared_ptr<const RenderableMesh> collected() {
        if (triangles_.empty())
            return nullptr;
        if (!is_painted_)
            painted_.clear();
        return std::make_shared<const RenderableMesh>(RenderableMesh{
            RaySurface(positions_, triangles_), std::move(objects_), std::move(normals_), std::move(painted_)});
    }

  private:
    void add_position(const Vec3& p, const Vec3& normal, float painted) {
        positions_.push_back(p);
        normals_.push_back(normal);
        painted_.push_back(painted);
        objects_.push_back(object_);
    }
    void add_triangles(std::span<const Triangle> triangles, std::uint32_t first) {
        for (const Triangle& t : triangles)
            triangles_.push_back({first + t[0], first + t[1], first + t[2]});
    }

    const Frame& frame_;
    std::vector<Vec3> positions_, normals_;
    std::vector<float> painted_;
    std::vector<Triangle> triangles_;
    std::vector<ObjectId> objects_;
    ObjectId object_ = no_object;
    bool is_painted_ = false;
};

}

std::shared_ptr<const RenderableMesh> triangles_of(const std::vector<LoadedShape>& shapes,
                                                   const std::vector<Part>& parts, const std::vector<Ground>& grounds,
                                                   const Frame& frame, bool all) {
    Collector collector(frame);
    std::size_t part = 0;
    for (const LoadedShape& loaded : shapes) {
        if (std::holds_alternative<PlaneShape>(loaded.object->shape))
            continue;
        const AnyField& field = parts[part++].field;
        collector.begin(static_cast<ObjectId>(part));
        const auto* mesh = std::get_if<MeshShape>(&loaded.object->shape);
        if (mesh && (all || mesh->own_normals || mesh->painted))
            collector.add_mesh(loaded, *mesh);
        else if (all)
            collector.add_field(loaded, field);
    }
    collector.begin(no_object);
    if (all)
        for (const Ground& ground : grounds)
            collector.add_ground(ground.plane);
    return collector.collected();
}

}
