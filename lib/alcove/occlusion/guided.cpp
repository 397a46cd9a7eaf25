#include "alcove/occlusion/guided.h"

#include "alcove/occlusion/neighbourhood.h"

#include <algorithm>
#include <mutex>

namespace alcove {
namespace {

constexpr std::size_t grain = 1024;

/// The value of a fit at the surfel itself, and the mean square of what it leaves.
struct Regression {
    float value, residual2;
};

/// The length of the mean of cosine-weighted directions where all are open: ∫ cos²θ dω / π.
constexpr float straight = 2.0f / 3.0f;

/// Twice the variance of the mean of one surfel's own rays, by their number as measured for shifted lattices.
/// Twice, because the residuals it is held against vary themselves; and never that of a certain answer,
/// because `open` is a fit.
float noise_of_ao(float open, int rays) {
    const float p = std::clamp(open, 0.05f, 0.95f);
    return 2.0f * p * (1.0f - p) * std::pow(static_cast<float>(rays), -1.4f);
}

/// The same of the mean open direction.
float noise_of_direction(int rays) {
    return std::pow(static_cast<float>(rays), -1.8f);
}

/// How much a surfel's own rays count beside the fit: none where their noise explains what the fit leaves.
float trust_in_own(float residual2, float noise2) {
    return residual2 > noise2 ? 1.0f - noise2 / residual2 : 0.0f;
}

/// The surfels along the Morton curve with their probes and rays; those alike stand there once.
class Shared {
  public:
    Shared(std::span<const Surfel> surfels, std::span<const std::uint32_t> order) : place_(order.size()) {
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Surfel& surfel = surfels[order[i]];
            if (surfels_.empty() || surfel.position != surfels_.back().position ||
                surfel.normal != surfels_.back().normal)
                surfels_.push_back(surfel);
            place_[i] = static_cast<std::uint32_t>(surfels_.size() - 1);
        }
        for (std::vector<float>& values : columns_)
            values.assign(std::max(surfels_.size(), Curve::window), 0.0f);
        for (std::size_t i = 0; i < surfels_.size(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                columns_[position + axis][i] = surfels_[i].position[static_cast<int>(axis)];
                columns_[normal + axis][i] = surfels_[i].normal[static_cast<int>(axis)];
            }
    }

    std::size_t size() const { return surfels_.size(); }
    std::size_t place(std::size_t rank) const { return place_[rank]; }

    void probe(const AnyField& field, float radius, std::size_t begin, std::size_t end) {
        SurfelBatch batch;
        SurfelBatch::Values distances;
        for (std::size_t at = begin; at < end; at += batch.count) {
            batch.count = 0;
            for (std::size_t i = at; i < end && batch.count < SurfelBatch::capacity; ++i)
                batch.push_back(surfels_[i]);
            for (std::size_t k = 0; k < Curve::probes; ++k) {
                const float height = radius * std::exp2(-0.75f * static_cast<float>(k));
                probe_along_normal(field, batch, height, distances.data());
                for (std::size_t i = 0; i < batch.count; ++i) {
                    const float probe = std::clamp(distances[i] / height, -1.0f, 1.0f);
                    columns_[first_probe + k][at + i] = probe;
                    columns_[guide][at + i] += probe / Curve::probes;
                }
            }
        }
    }

    void shoot(const RaySurface& surface, const Guided& guided, const CosineLattice& lattice,
               std::size_t begin, std::size_t end) {
        RayBatch batch;
        std::array<std::uint32_t, RayBatch::capacity> owner;
        const float share = 1.0f / static_cast<float>(guided.rays);
        const auto flush = [&] {
            surface.find_occluded(batch, guided.radius);
            for (std::size_t r = 0; r < batch.count; ++r)
                if (!batch.hit[r]) {
                    columns_[ao][owner[r]] += share;
                    columns_[bent][owner[r]] += share * batch.dx[r];
                    columns_[bent + 1][owner[r]] += share * batch.dy[r];
                    columns_[bent + 2][owner[r]] += share * batch.dz[r];
                }
            batch.count = 0;
        };
        for (std::size_t i = begin; i < end; ++i) {
            const Basis basis(surfels_[i].normal);
            const Vec3 origin = surfels_[i].position + Exact::offset * basis.normal;
            const CosineLattice::Shift shift(recurrence_point(i, guided.seed));
            for (int r = 0; r < guided.rays; ++r) {
                owner[batch.count] = static_cast<std::uint32_t>(i);
                batch.push_back({origin, basis.to_world(lattice.direction(r, shift))}, 0.0f);
                if (batch.count == RayBatch::capacity)
                    flush();
            }
        }
        flush();
        // Open surroundings bend nothing: what is shared is the deviation from that.
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                columns_[bent + axis][i] -= straight * columns_[ao][i] * columns_[normal + axis][i];
    }

    /// The fitted ao and sum of open directions of one surfel.
    struct Fit {
        float ao;
        Vec3 bent;
    };
    Fit fit(std::size_t i, int rays, bool with_bent) const {
        const std::size_t all = columns_[ao].size();
        const std::size_t first = std::min(i - std::min(i, Curve::window / 2), all - Curve::window);
        std::array<float, Curve::window> weights;
        weigh(curve(), i, first, reach(i, rays), weights.data());
        const float origin = columns_[guide][i];
        const auto regress = [&](std::size_t column) {
            const float* values = columns_[column].data() + first;
            const Moments m = moments(weights.data(), columns_[guide].data() + first, origin, values);
            const float g = m.g / m.w, v = m.v / m.w;
            // The guides of a flat neighbourhood say nothing: what they vary by rounding is no slope.
            const float variance = m.gg / m.w - g * g + 1e-4f, covariance = m.vg / m.w - g * v;
            const float slope = covariance / variance;
            return Regression{v - slope * g, std::max(m.vv / m.w - v * v - slope * covariance, 0.0f)};
        };
        const auto blend = [&](std::size_t column, float fitted, float own) {
            return fitted + own * (columns_[column][i] - fitted);
        };
        const Regression open = regress(ao);
        const float fitted = std::clamp(open.value, 0.0f, 1.0f);
        const float own = trust_in_own(open.residual2, noise_of_ao(fitted, rays));
        Fit fit{std::clamp(blend(ao, fitted, own), 0.0f, 1.0f), Vec3(0.0f)};
        if (with_bent) {
            const Regression x = regress(bent), y = regress(bent + 1), z = regress(bent + 2);
            const float own_bent =
                trust_in_own(x.residual2 + y.residual2 + z.residual2, noise_of_direction(rays));
            fit.bent = Vec3(blend(bent, x.value, own_bent), blend(bent + 1, y.value, own_bent),
                            blend(bent + 2, z.value, own_bent)) +
                       straight * fit.ao * surfels_[i].normal;
        }
        return fit;
    }

  private:
    enum Column : std::size_t {
        position,
        normal = 3,
        first_probe = 6,
        guide = 14,
        ao,
        bent,
        columns = bent + 3
    };

    Curve curve() const {
        Curve curve{};
        curve.x = columns_[position].data(), curve.y = columns_[position + 1].data(),
        curve.z = columns_[position + 2].data();
        curve.nx = columns_[normal].data(), curve.ny = columns_[normal + 1].data(),
        curve.nz = columns_[normal + 2].data();
        for (std::size_t k = 0; k < Curve::probes; ++k)
            curve.probe[k] = columns_[first_probe + k].data();
        curve.guide = columns_[guide].data();
        return curve;
    }

    /// How far neighbours have a say: the more rays, the nearer are enough. Measured on scans.
    float reach(std::size_t i, int rays) const {
        std::array<float, 8> distances;
        std::size_t count = 0;
        for (std::size_t k = i - std::min<std::size_t>(i, 4); k < std::min(i + 5, surfels_.size()); ++k)
            if (k != i)
                distances[count++] = glm::length(surfels_[k].position - surfels_[i].position);
        if (count == 0)
            return 1.0f;
        const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(count / 2);
        std::nth_element(distances.begin(), middle, distances.begin() + static_cast<std::ptrdiff_t>(count));
        const float spacings = 20.0f * std::pow(static_cast<float>(rays), -0.4f);
        return std::max(spacings * *middle, 1e-6f);
    }

    std::vector<Surfel> surfels_;
    std::vector<std::uint32_t> place_; ///< of each rank, in surfels_
    std::array<std::vector<float>, columns> columns_;
};

}

ChannelValues bake_channels(std::span<const Surfel> surfels, const AnyField& field, const RaySurface& surface,
                            const Guided& guided, ChannelSet wanted, const Progress& progress) {
    wanted = wanted & Guided::gives;
    const std::vector<std::uint32_t> order = spatial_order(surfels);
    Shared shared(surfels, order);
    std::mutex progress_mutex;
    std::size_t finished = 0;
    const auto tell = [&](std::size_t done) {
        if (!progress)
            return;
        const std::lock_guard lock(progress_mutex);
        finished += done;
        progress(static_cast<double>(finished) / static_cast<double>(shared.size() + order.size()));
    };
    const CosineLattice lattice(guided.rays);
    parallel_for(shared.size(), grain, [&](std::size_t begin, std::size_t end) {
        shared.probe(field, std::min(guided.radius, 1.0f), begin, end);
        shared.shoot(surface, guided, lattice, begin, end);
        tell(end - begin);
    });
    ChannelValues baked;
    for (const ChannelInfo& channel : channels)
        if (wanted.has(channel.channel))
            baked[channel.channel].assign(surfels.size() * channel.components, channel.missing);
    const bool with_bent = wanted.has(Channel::bent_normal);
    parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t rank = begin; rank < end; ++rank) {
            const Shared::Fit fit = shared.fit(shared.place(rank), guided.rays, with_bent);
            if (wanted.has(Channel::ao))
                baked[Channel::ao][order[rank]] = fit.ao;
            if (with_bent) {
                const float length = glm::length(fit.bent);
                const Vec3 direction = fit.ao > 0.0f && length > 0.0f ? fit.bent / length : Vec3(0.0f);
                float* to = baked[Channel::bent_normal].data() + std::size_t{3} * order[rank];
                to[0] = direction.x, to[1] = direction.y, to[2] = direction.z;
            }
        }
        tell(end - begin);
    });
    return baked;
}

}
