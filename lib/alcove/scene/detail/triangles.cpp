#include "alcove/scene/detail/triangles.h"

#include "alcove/base/types.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/detail/corner_normals.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/directions.h"
#include "alcove/render/detail/texture.h"

#include <array>
#include <limits>

namespace alcove {
namespace {

constexpr float voxel = 1.0f / 256.0f;

/// The colours of the triangle corners of a mesh: from its vertices or its faces, or none.
class CornerColors {
  public:
    CornerColors(const LoadedMesh& file, const MeshShape& shape, const SceneObject& object) {
        if (shape.painted && file.mesh.vertex_colors.empty())
            throw InputError(object.name + ": is painted, but the mesh has no vertex colours");
        if (shape.painted) {
            for (const Color& color : file.mesh.vertex_colors)
                painted_.push_back(linear_light(color));
            of_vertices_ = &painted_;
        } else if (shape.own_colors.value_or(false) && file.colors->any()) {
            const OwnColors& own = *file.colors;
            of_vertices_ = own.of_vertices.empty() ? nullptr : &own.of_vertices;
            of_faces_ = own.of_faces.empty() ? nullptr : &own.of_faces;
            if (of_faces_)
                faces_ = faces_of_triangles(file.mesh);
        }
    }

    bool any() const { return of_vertices_ || of_faces_; }
    bool of_faces() const { return of_faces_ != nullptr; }
    Vec3 operator()(std::size_t triangle, std::uint32_t vertex) const {
        return of_vertices_ ? (*of_vertices_)[vertex] : of_faces_ ? (*of_faces_)[faces_[triangle]] : Vec3(1.0f);
    }

  private:
    std::vector<Vec3> painted_;
    const std::vector<Vec3>*of_vertices_ = nullptr, *of_faces_ = nullptr;
    std::vector<std::uint32_t> faces_; // of each triangle
};

class Collector {
  public:
    explicit Collector(const Frame& frame) : frame_(frame) {}

    /// Sets the object to which everything added later belongs.
    void begin(ObjectId object) { object_ = object; }

    void add_mesh(const LoadedShape& loaded, const MeshShape& shape) {
        const Mesh& mesh = loaded.mesh->mesh;
        const std::vector<Triangle>& triangles = loaded.mesh->triangles;
        const CornerColors colors(*loaded.mesh, shape, *loaded.object);
        has_colors_ = has_colors_ || colors.any() || !shape.texture.empty();
        const std::vector<Triangle> corners =
            shape.texture.empty() ? std::vector<Triangle>() : add_texture(mesh, shape);
        const auto first = static_cast<std::uint32_t>(positions_.size());
        const auto add_vertex = [&](std::uint32_t vertex, const Vec3& normal, const Vec3& color) {
            const Vec3d& p = mesh.positions[vertex];
            add_position(is_finite(p) ? frame_.to_unit(loaded.pose(p)) : Vec3(0.0f),
                         Vec3(loaded.pose.rotation * Vec3d(normal)), color);
        };
        if (!shape.own_normals && !colors.of_faces() && corners.empty()) {
            for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
                add_vertex(vertex, Vec3(0.0f), colors(0, vertex));
            add_triangles(triangles, first);
            return;
        }
        // Normals and colours differ between corners, so each corner gets its own vertex.
        std::vector<std::array<Vec3, 3>> normals(triangles.size(), {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)});
        if (shape.own_normals)
            normals = corner_normals(mesh, triangles);
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                add_vertex(triangles[f][corner], normals[f][corner], colors(f, triangles[f][corner]));
                if (!corners.empty())
                    uvs_.back() = mesh.corner_uvs.empty() ? mesh.vertex_uvs[triangles[f][corner]]
                                                          : mesh.corner_uvs[corners[f][corner]];
            }
            const auto at = static_cast<std::uint32_t>(3 * f);
            triangles_.push_back({first + at, first + at + 1, first + at + 2});
        }
    }

    /// Adds the zero isosurface of a field. The voxel is relative to the size of the shape.
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
                add_position(frame_.to_unit(own.to_scene(Vec3(p))), Vec3(0.0f), Vec3(1.0f));
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
                         Vec3(0.0f), Vec3(1.0f));
        add_triangles(std::array{Triangle{0, 1, 2}, Triangle{0, 2, 3}}, first);
    }

    std::shared_ptr<const RenderableMesh> collected() {
        if (triangles_.empty())
            return nullptr;
        if (!has_colors_)
            colors_.clear();
        if (!texture_)
            uvs_.clear();
        return std::make_shared<const RenderableMesh>(
            RenderableMesh{RaySurface(positions_, triangles_), std::move(objects_), std::move(normals_),
                           std::move(colors_), std::move(uvs_), std::move(texture_)});
    }

  private:
    /// \return the corners of the triangles, see corners_of_triangles()
    std::vector<Triangle> add_texture(const Mesh& mesh, const MeshShape& shape) {
        if (mesh.vertex_uvs.empty() && mesh.corner_uvs.empty())
            throw InputError(shape.file.string() + ": has no texture coordinates (UVs) for the texture " +
                             shape.texture.string());
        if (texture_ && texture_file_ != shape.texture)
            throw InputError(shape.texture.string() + ": a scene shows one texture: bake the objects into one map");
        if (!texture_)
            texture_ = std::make_shared<const Texture>(read_texture(shape.texture));
        texture_file_ = shape.texture;
        return corners_of_triangles(mesh);
    }

    void add_position(const Vec3& p, const Vec3& normal, const Vec3& color) {
        positions_.push_back(p);
        normals_.push_back(normal);
        colors_.push_back(color);
        uvs_.emplace_back(std::numeric_limits<float>::quiet_NaN());
        objects_.push_back(object_);
    }
    void add_triangles(std::span<const Triangle> triangles, std::uint32_t first) {
        for (const Triangle& t : triangles)
            triangles_.push_back({first + t[0], first + t[1], first + t[2]});
    }

    const Frame& frame_;
    std::vector<Vec3> positions_, normals_, colors_;
    std::vector<Vec2> uvs_;
    std::shared_ptr<const Texture> texture_;
    std::filesystem::path texture_file_;
    std::vector<Triangle> triangles_;
    std::vector<ObjectId> objects_;
    ObjectId object_ = no_object;
    bool has_colors_ = false;
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
        if (mesh &&
            (all || mesh->own_normals || !mesh->texture.empty() || mesh->painted || mesh->own_colors.value_or(false)))
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
