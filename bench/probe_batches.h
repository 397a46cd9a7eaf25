/// Visits probes above surfels in the order that estimators use: batch by batch, height by height.
#pragma once

#include "alcove/occlusion/estimator.h"

#include <vector>

namespace alcove {

/// Calls `sample(points, distances)` for the points at 0, 1, ... `probes` - 1 steps above each batch of surfels, then
/// `use(distances, count)` with the results.
template <class Sample, class Use>
void probe_batches(const std::vector<Surfel>& surfels, int probes, float step, const Sample& sample, const Use& use) {
    SurfelBatch batch;
    SurfelBatch::Values x, y, z, distances;
    for (std::size_t begin = 0; begin < surfels.size(); begin += batch.count) {
        batch.count = 0;
        for (std::size_t i = begin; i < surfels.size() && batch.count < SurfelBatch::capacity; ++i)
            batch.push_back(surfels[i]);
        for (int i = 0; i < probes; ++i) {
            const float height = step * static_cast<float>(i);
            for (std::size_t k = 0; k < batch.count; ++k) {
                x[k] = batch.x[k] + height * batch.nx[k];
                y[k] = batch.y[k] + height * batch.ny[k];
                z[k] = batch.z[k] + height * batch.nz[k];
            }
            sample(Points{x.data(), y.data(), z.data(), batch.count}, distances.data());
            use(distances, batch.count);
        }
    }
}

}
