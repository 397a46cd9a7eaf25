/// Surfels × field (or ray surface) × estimator -> values.
#pragma once

#include "alcove/base/parallel.h"
#include "alcove/occlusion/estimator.h"

#include <functional>
#include <mutex>
#include <span>
#include <vector>

namespace alcove {

/// Told how much of the work is done, in [0, 1]; never from two threads at once.
using Progress = std::function<void(double done)>;

/// The indices of the surfels that have a normal, along a Morton curve: neighbours in the list are neighbours
/// in space, so a batch reads few bricks. G. M. Morton, "A computer oriented geodetic data base" (1966).
std::vector<std::uint32_t> spatial_order(std::span<const Surfel> surfels);

/// The values of each channel that was asked for, as many floats a surfel as it has components; none for the
/// others.
using ChannelValues = PerChannel<std::vector<float>>;

/// Every wanted channel that the estimator gives, in one pass over the surfels along their spatial_order(); what
/// is missing of a surfel without a normal is in `channels`. The values do not depend on the number of threads nor
/// on the order of the surfels. Cost: that of the estimator, a surfel.
template <class F, Estimator<F> E>
ChannelValues bake_channels(std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                            const F& field, const E& estimator, ChannelSet wanted,
                            const Progress& progress = {}) {
    wanted = wanted & channels_of<E>();
    ChannelValues baked;
    for (const ChannelInfo& channel : channels)
        if (wanted.has(channel.channel))
            baked[channel.channel].assign(surfels.size() * channel.components, channel.missing);
    constexpr std::size_t grain = 16 * SurfelBatch::capacity;
    std::mutex progress_mutex;
    std::size_t finished = 0;
    parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
        SurfelBatch batch;
        PerChannel<std::array<float, 3 * SurfelBatch::capacity>> values;
        Outputs out;
        for (const ChannelInfo& channel : channels)
            if (wanted.has(channel.channel) || channel.channel == Channel::ao)
                out[channel.channel] = values[channel.channel].data();
        for (std::size_t at = begin; at < end; at += batch.count) {
            batch.count = 0;
            for (std::size_t i = at; i < end && batch.count < SurfelBatch::capacity; ++i)
                batch.push_back(surfels[order[i]]);
            estimator(field, batch, out);
            for (const ChannelInfo& channel : channels)
                if (wanted.has(channel.channel))
                    for (std::size_t k = 0; k < batch.count; ++k)
                        std::copy_n(out[channel.channel] + k * channel.components, channel.components,
                                    baked[channel.channel].data() + order[at + k] * channel.components);
        }
        if (progress) {
            const std::lock_guard lock(progress_mutex);
            finished += end - begin;
            progress(static_cast<double>(finished) / static_cast<double>(order.size()));
        }
    });
    return baked;
}

template <class F, Estimator<F> E>
ChannelValues bake_channels(std::span<const Surfel> surfels, const F& field, const E& estimator,
                            ChannelSet wanted, const Progress& progress = {}) {
    return bake_channels(surfels, spatial_order(surfels), field, estimator, wanted, progress);
}

/// The ao alone: a value a surfel, 1 where there is no normal.
template <class F, Estimator<F> E>
std::vector<float> bake(std::span<const Surfel> surfels, const F& field, const E& estimator,
                        const Progress& progress = {}) {
    return std::move(bake_channels(surfels, field, estimator, Channel::ao, progress)[Channel::ao]);
}

}
