#include "alcove/maps/detail/uv_faces.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/corner_normals.h"
#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/triangulate.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace alcove {
namespace {

constexpr float rounding = 1e-5f; // of UVs
constexpr int udim_rows = 10;

bool is_usable(const UvTriangle& uvs) {
    return std::all_of(uvs.begin(), uvs.end(), [](const Vec2& uv) {
        return std::fabs(uv.x) <= furthest_uv && std::fabs(uv.y) <= furthest_uv; // false for NaN
    });
}

double area_of(const UvTriangle& uvs) {
    const glm::dvec2 a(uvs[0]), b(uvs[1]), c(uvs[2]);
    return std::fabs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
}

struct UvBox {
    Vec2 low, high;

    explicit UvBox(const UvTriangle& uvs)
        : low(glm::min(glm::min(uvs[0], uvs[1]), uvs[2])), high(glm::max(glm::max(uvs[0], uvs[1]), uvs[2])) {}
};

}

UvFaces::UvFaces(const Mesh& mesh, const UvFacesOptions& options) : mesh_(mesh) {
    const bool has_uvs = !mesh.vertex_uvs.empty() || !mesh.corner_uvs.empty();
    std::vector<Vec2> other_set;
    if (options.uv_set > 0) {
        const std::size_t sets = mesh.source ? mesh.source->uv_sets() : has_uvs ? 1 : 0;
        if (static_cast<std::size_t>(options.uv_set) >= sets)
            throw InputError(fmt::format("{}--uv-set {}: {}, counted from 0", mesh.name.empty() ? "" : mesh.name + ": ",
                                         options.uv_set, counted(sets, "set of UVs exists", "sets of UVs exist")));
        other_set = mesh.source->uv_set(static_cast<std::size_t>(options.uv_set));
    } else if (!has_uvs)
        throw InputError((mesh.name.empty() ? "" : mesh.name + ": ") +
                         "has no texture coordinates (UVs), which a texture map needs: unwrap it first, or bake to "
                         "vertices (-o OUT.ply), with --tessellate auto where faces are large");
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const std::vector<Triangle> corners = corners_of_triangles(mesh);
    const std::vector<std::uint32_t> faces = faces_of_triangles(mesh);
    const std::vector<std::array<Vec3, 3>> normals = corner_normals(mesh, triangles, options.normals);
    const std::vector<Vec2>& of_vertices = options.uv_set > 0 ? other_set : mesh.vertex_uvs;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!options.wanted.empty() && !options.wanted[faces[t]])
            continue;
        UvTriangle uvs;
        for (std::size_t k = 0; k < 3; ++k)
            uvs[k] = of_vertices.empty() ? mesh.corner_uvs[corners[t][k]] : of_vertices[triangles[t][k]];
        const bool is_unusable = !is_usable(uvs);
        if (is_unusable || !(area_of(uvs) > 0.0)) {
            const auto p = [&](std::size_t k) { return mesh.positions[triangles[t][k]]; };
            without_texels_ += glm::cross(p(1) - p(0), p(2) - p(0)) != Vec3d(0.0);
        }
        if (is_unusable) {
            ++unusable_;
        } else if (!(area_of(uvs) > 0.0)) {
            ++flat_;
        } else {
            uvs_.push_back(uvs);
            faces_.push_back(faces[t]);
            vertices_.push_back(triangles[t]);
            normals_.push_back(normals[t]);
        }
    }
}

SurfacePoint UvFaces::point(std::uint32_t triangle, const Vec3d& weights) const {
    SurfacePoint point{.face = faces_[triangle]};
    for (std::size_t k = 0; k < 3; ++k) {
        point.position += weights[static_cast<int>(k)] * mesh_.positions[vertices_[triangle][k]];
        point.normal += static_cast<float>(weights[static_cast<int>(k)]) * normals_[triangle][k];
    }
    return point;
}

void UvFaces::add_charts() {
    if (charts_.empty())
        charts_ = charts_of(vertices_, uvs_, normals_);
}

void UvFaces::add_directions() {
    vertex_normals_ = angle_weighted_normals(mesh_, triangulate(mesh_).triangles);
}

void UvFaces::set_cage(const Mesh& cage) {
    if (cage.vertex_count() != mesh_.vertex_count())
        throw InputError(
            fmt::format("{}the cage has {}, but the mesh has {}: make the cage from a copy of the mesh, by "
                        "moving its vertices",
                        cage.name.empty() ? "" : cage.name + ": ", counted(cage.vertex_count(), "vertex", "vertices"),
                        grouped(mesh_.vertex_count())));
    if (cage.positions == mesh_.positions)
        throw InputError((cage.name.empty() ? "" : cage.name + ": ") +
                         "the cage coincides with the mesh: move its vertices outward");
    cage_ = &cage;
}

ProjectedFrom UvFaces::projected_from(std::uint32_t triangle, const Vec3d& weights, double front) const {
    ProjectedFrom from;
    Vec3d direction(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
        const double weight = weights[static_cast<int>(k)];
        const std::uint32_t vertex = vertices_[triangle][k];
        from.position += weight * mesh_.positions[vertex];
        direction +=
            weight * (cage_ ? cage_->positions[vertex] - mesh_.positions[vertex] : Vec3d(vertex_normals_[vertex]));
    }
    from.direction = unit_or_zero(direction);
    from.front = cage_ ? glm::length(direction) : front;
    return from;
}

void UvFaces::add_tangents() {
    std::vector<std::array<TangentCorner, 3>> triangles(uvs_.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            triangles[t][k] = {mesh_.positions[vertices_[t][k]], normals_[t][k], uvs_[t][k]};
    tangents_ = tangent_frames(triangles);
}

Vec3 UvFaces::to_tangent(std::uint32_t triangle, const Vec3d& weights, const Vec3& direction) const {
    glm::mat3 axes(0.0f);
    const TangentTriangle& frame = tangents_[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 normal = normals_[triangle][k], tangent = frame.tangents[k];
        axes += static_cast<float>(weights[static_cast<int>(k)]) *
                glm::mat3(tangent, frame.sign * glm::cross(normal, tangent), normal);
    }
    const Vec3 local = glm::inverse(axes) * direction;
    const float length = glm::length(local);
    return length > 0.0f && std::isfinite(length) ? local / length : Vec3(0.0f);
}

std::vector<int> UvFaces::tiles(bool udim) const {
    if (!udim)
        return {first_udim};
    std::set<int> numbers;
    for (const UvTriangle& uvs : uvs_) {
        const UvBox box(uvs);
        // A triangle that ends at the border of a tile does not reach the next.
        const auto first = glm::ivec2(glm::floor(glm::max(box.low + rounding, 0.0f))),
                   last = glm::ivec2(glm::ceil(box.high - rounding)) - 1;
        for (int v = first.y; v <= std::min(last.y, udim_rows - 1); ++v)
            for (int u = first.x; u <= std::min(last.x, udims_per_row - 1); ++u)
                numbers.insert(first_udim + u + udims_per_row * v);
    }
    return {numbers.begin(), numbers.end()};
}

std::vector<std::string> UvFaces::warnings(bool udim) const {
    const Vec2 most = udim ? Vec2(udims_per_row, udim_rows) : Vec2(1.0f);
    std::size_t outside = 0;
    for (const UvTriangle& uvs : uvs_) {
        const UvBox box(uvs);
        outside += box.low.x < -rounding || box.low.y < -rounding || box.high.x > most.x + rounding ||
                   box.high.y > most.y + rounding;
    }
    std::vector<std::string> warnings;
    if (outside > 0)
        warnings.push_back(fmt::format("{} partly or wholly outside the texture, and those parts are not baked{}",
                                       counted(outside, "triangle lies", "triangles lie"),
                                       udim ? "" : ": put <UDIM> into the output's name to bake several tiles"));
    if (unusable_ > 0)
        warnings.push_back(counted(unusable_, "triangle has", "triangles have") +
                           " texture coordinates that are not finite or are far outside the texture; not baked");
    if (flat_ > 0)
        warnings.push_back(counted(flat_, "triangle has", "triangles have") + " no area in UV space; not baked");
    return warnings;
}

}
