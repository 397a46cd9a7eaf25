/// The scan that the benchmarks use.
#pragma once

#include "alcove/mesh/files.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "subdivided.h"

#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <numeric>

namespace alcove {

struct Scan {
    explicit Scan(Mesh shape)
        : mesh(std::move(shape)), triangles(triangulate(mesh).triangles), frame(frame_of(mesh.box())),
          surfels(make_surfels(mesh, triangles, frame)) {}

    Mesh mesh;
    std::vector<Triangle> triangles;
    Frame frame;
    std::vector<Surfel> surfels; ///< in file order
};

/// The scan, subdivided `level` times: 26,002, 104,002 and 416,002 vertices.
inline const Scan& scan(std::int64_t level = 1) {
    static std::array<std::unique_ptr<const Scan>, 3> scans;
    auto& entry = scans[static_cast<std::size_t>(level)];
    if (!entry)
        entry = std::make_unique<const Scan>(level == 0 ? read_mesh(ALCOVE_REAL_MESHES "/armadillo.off")
                                                        : subdivided(scan(level - 1).mesh));
    return *entry;
}

/// The positions of the vertices in unit space.
inline std::vector<Vec3> unit_positions(const Scan& scan) {
    std::vector<Vec3> positions;
    positions.reserve(scan.mesh.positions.size());
    for (const Vec3d& p : scan.mesh.positions)
        positions.push_back(scan.frame.to_unit(p));
    return positions;
}

/// Reports vertices per second and the mean value, which is nearly the same for all methods that compute the same
/// quantity.
inline void count_vertices(benchmark::State& state, const std::vector<float>& ao) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(ao.size()));
    state.counters["mean_ao"] = std::accumulate(ao.begin(), ao.end(), 0.0) / static_cast<double>(ao.size());
}

}
