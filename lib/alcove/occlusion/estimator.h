/// The estimator interface. An estimator is a struct whose members are its parameters and whose call operator
/// computes the channels:
///
///     struct Mine {
///         float radius = 0.1f;
///         template <Field F>
///         void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const;
///     };
///
/// The call operator writes one value in [0, 1] per surfel to `out[Channel::ao]`, and fills each other channel of the
/// static member `gives` whose pointer is not null. Every surfel of a batch has a normal. Lengths are in the unit of
/// the field. The call operator is `const` and keeps no state, so any number of threads can share one estimator. To be
/// selectable by name, the struct also needs the descriptive members that Classic has, and an entry in catalog.cpp.
///
/// *Reference units*: the constants of a published formula assume its reference radius R₀. For a radius R,
/// heights are multiplied by R/R₀ and distances by R₀/R. Scaling scene and radius together therefore changes
/// nothing, and R = R₀ reproduces the published formula.
#pragma once

#include "alcove/field/field.h"
#include "alcove/occlusion/channels.h"
#include "alcove/occlusion/occluders.h"

#include "alcove/base/parallel.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string_view>
#include <vector>

namespace alcove {

/// Up to `capacity` surfels that are close in space, as a structure of arrays: the unit of work of an estimator.
struct SurfelBatch {
    static constexpr std::size_t capacity = 64;
    using Values = std::array<float, capacity>;

    Values x, y, z;    ///< positions
    Values nx, ny, nz; ///< unit normals
    Values lx, ly, lz; ///< normals plus Surfel::away
    Values highest;    ///< Surfel::highest
    std::size_t count = 0;

    /// Moves the position by `lift` away from the faces that the surfel touches.
    void push_back(const Surfel& surfel, float lift = 0.0f) {
        set(x, y, z, surfel.position + lift * surfel.away);
        set(nx, ny, nz, surfel.normal);
        set(lx, ly, lz, surfel.normal + surfel.away);
        highest[count] = surfel.highest;
        ++count;
    }
    Vec3 position(std::size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3 normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
    Vec3 away(std::size_t i) const { return Vec3(lx[i], ly[i], lz[i]) - normal(i); }
    bool touches(std::size_t i) const { return lx[i] != nx[i] || ly[i] != ny[i] || lz[i] != nz[i]; }
    /// Where rays start, see Surfel::origin().
    Vec3 origin(std::size_t i, float height) const { return position(i) + height * Vec3(lx[i], ly[i], lz[i]); }
    /// Where rays against triangles start, see Surfel::ray_origin().
    Vec3 ray_origin(std::size_t i, float height) const { return origin(i, std::min(height, highest[i])); }

  private:
    void set(Values& to_x, Values& to_y, Values& to_z, const Vec3& v) {
        to_x[count] = v.x, to_y[count] = v.y, to_z[count] = v.z;
    }
};

/// `F` is a Field, or a RaySurface for estimators that trace rays against the mesh.
template <class E, class F>
concept Estimator = requires(const E& estimator, const F& field, const SurfelBatch& surfels, const Outputs& out) {
    estimator(field, surfels, out);
};

/// The channels of an estimator: `E::gives` if it exists, else ao alone.
template <class E>
constexpr ChannelSet channels_of() {
    if constexpr (requires { E::gives; })
        return E::gives;
    else
        return Channel::ao;
}

/// The height above the surface at which probes and rays start: ray_offset() or, in a grid, a tenth of a voxel if that
/// is larger.
template <Field F>
float start_height(const F& field, float radius) {
    return std::max(0.1f * resolution(field), ray_offset(radius));
}

/// Surfels and their reference ao, for fitting an estimator to a mesh.
struct Labels {
    std::vector<Surfel> surfels;
    std::vector<float> ao;
};

/// One point per surfel.
struct ProbeBatch {
    SurfelBatch::Values x, y, z;

    void set(std::size_t i, const Vec3& p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
};

/// distances[i] = map(probes[i]) for the first `count` probes, all within `reach` of the surface. Cost: `count`
/// map() calls.
template <Field F>
void map_probes(const F& field, const ProbeBatch& probes, std::size_t count, float reach, float* distances) {
    map_batch(field, Points{probes.x.data(), probes.y.data(), probes.z.data(), count}, reach, distances);
}

/// distances[i] = map(position + height · normal) for the whole batch. A negative height lies behind the surface. Cost:
/// one map() call per surfel.
template <Field F>
void probe_along_normal(const F& field, const SurfelBatch& surfels, float height, float* distances) {
    ProbeBatch probes;
    for (std::size_t i = 0; i < surfels.count; ++i) {
        probes.x[i] = surfels.x[i] + height * surfels.nx[i];
        probes.y[i] = surfels.y[i] + height * surfels.ny[i];
        probes.z[i] = surfels.z[i] + height * surfels.nz[i];
    }
    map_probes(field, probes, surfels.count, std::fabs(height), distances);
}

/// The indices of the surfels that have a normal, along a Morton curve (Morton 1966). Neighbours in the list are
/// neighbours in space, so a batch touches few grid bricks. Independent of the order of the surfels.
std::vector<std::uint32_t> spatial_order(std::span<const Surfel> surfels);

/// Computes every wanted channel that the estimator gives, in one pass along `order`, a spatial_order(). Surfels
/// without a normal get ChannelInfo::missing; covered ones get 0 in the channels with ChannelInfo::visibility. The
/// values depend neither on the number of threads nor on the order of the surfels. `progress` is never called
/// concurrently. Cost: one evaluation of the estimator per surfel.
template <class F, Estimator<F> E>
ChannelValues evaluate(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const F& field,
                       const E& estimator, ChannelSet wanted, const Progress& progress = {}) {
    wanted = wanted & channels_of<E>();
    ChannelValues baked;
    for (const ChannelInfo& channel : channels)
        if (wanted.has(channel.channel))
            baked[channel.channel].assign(surfels.size() * channel.components, channel.missing);
    constexpr std::size_t grain = 16 * SurfelBatch::capacity;
    float lift = 0.0f;
    if constexpr (Field<F> && requires { estimator.radius; })
        lift = start_height(field, estimator.radius);
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
            check_cancelled();
            batch.count = 0;
            for (std::size_t i = at; i < end && batch.count < SurfelBatch::capacity; ++i)
                batch.push_back(surfels[order[i]], lift);
            estimator(field, batch, out);
            for (const ChannelInfo& channel : channels)
                if (wanted.has(channel.channel))
                    for (std::size_t k = 0; k < batch.count; ++k) {
                        float* to = baked[channel.channel].data() + order[at + k] * channel.components;
                        if (channel.visibility && surfels[order[at + k]].covered)
                            std::fill_n(to, channel.components, 0.0f);
                        else
                            std::copy_n(out[channel.channel] + k * channel.components, channel.components, to);
                    }
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
ChannelValues evaluate(std::span<const Surfel> surfels, const F& field, const E& estimator, ChannelSet wanted,
                       const Progress& progress = {}) {
    return evaluate(surfels, spatial_order(surfels), field, estimator, wanted, progress);
}

/// Computes only the ao channel: one value per surfel, 1 for surfels without a normal.
template <class F, Estimator<F> E>
std::vector<float> evaluate_ao(std::span<const Surfel> surfels, const F& field, const E& estimator,
                               const Progress& progress = {}) {
    return std::move(evaluate(surfels, field, estimator, Channel::ao, progress)[Channel::ao]);
}

}
