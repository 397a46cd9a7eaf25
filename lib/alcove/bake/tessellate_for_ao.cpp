#include "alcove/mesh/detail/tessellate.h"

#include "alcove/bake/bake.h"
#include "alcove/bake/detail/options.h"
#include "alcove/bake/detail/surroundings.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/contacts.h"
#include "alcove/occlusion/methods/exact.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr int rays = 256; // per point; their noise is about 0.006

/// Decides at which points the ao differs too much from the ao that is interpolated between vertices.
class InterpolationError {
  public:
    InterpolationError(const Mesh& mesh, const std::vector<Triangle>& triangles, const Frame& frame,
                       const BakeOptions& options, const RaySurface& surface, float radius)
        : frame_(frame), surface_(surface), exact_{.radius = radius, .rays = rays},
          allowed_(options.error.value_or(rmse_of(options.quality))),
          ao_(ao_of(make_surfels(mesh, triangles, frame, options.normals), uses_vertex)) {}

    std::vector<bool> operator()(std::span<const PointBetween> points) {
        std::vector<Surfel> surfels;
        surfels.reserve(points.size());
        for (const PointBetween& point : points)
            surfels.push_back({frame_.to_unit(point.position), point.normal});
        const std::vector<float> ao = ao_of(std::move(surfels));
        ao_.insert(ao_.end(), ao.begin(), ao.end()); // later points may lie between these
        std::vector<bool> differs(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            double interpolated = 0.0;
            for (int end = 0; end < 3; ++end)
                if (points[i].weights[end] > 0.0)
                    interpolated += points[i].weights[end] * ao_[points[i].ends[static_cast<std::size_t>(end)]];
            differs[i] = std::fabs(interpolated - ao[i]) > allowed_;
        }
        return differs;
    }

  private:
    std::vector<float> ao_of(std::vector<Surfel> surfels, const IsOwnFace& is_own = {}) const {
        find_contacts(surfels, surface_, ray_offset(exact_.radius), is_own);
        return evaluate_ao(surfels, surface_, exact_);
    }

    const Frame& frame_;
    const RaySurface& surface_;
    Exact exact_;
    double allowed_;
    std::vector<float> ao_; // of the vertices, then of the points in call order
};

}

Mesh tessellate_for_ao(const Mesh& mesh, const BakeOptions& options) {
    const ThreadLimit limit(options.threads);
    check(options);
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    const float radius = radius_of(options, frame, voxelizing_of(options, frame));
    std::vector<std::string> warnings; // discarded, because bake() gives them too
    const Surroundings surroundings(options, mesh, frame, radius, warnings);
    const RaySurface surface = surroundings.rays_around({mesh.positions, triangles, frame});
    InterpolationError error(mesh, triangles, frame, options, surface, radius);

    // Fractions of the radius. Details below the first need no vertex of their own; details above the second must not
    // fall between tested points.
    constexpr double of_shortest = 1.0 / 16.0, of_spacing = 0.5;
    constexpr std::size_t max_faces = 1'000'000, max_growth = 4;
    const double reach = std::min(double(radius), 0.25) * frame.diagonal;
    return tessellate(mesh, std::ref(error),
                      {.shortest = of_shortest * reach,
                       .spacing = of_spacing * reach,
                       .most_faces = std::max(max_faces, max_growth * mesh.face_count())});
}

}
