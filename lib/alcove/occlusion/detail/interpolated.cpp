#include "alcove/occlusion/detail/interpolated.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/parallel.h"
#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/detail/local_fit.h"
#include "alcove/occlusion/detail/subset.h"
#include "alcove/occlusion/detail/surfel_cells.h"
#include "alcove/occlusion/estimator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace alcove {
namespace {

constexpr std::size_t block = 64; // surfels along the curve that share their sources
constexpr std::size_t grain = 4096;

/// The surfels where the method was evaluated.
struct Sources {
    HugeVector<Surfel> surfels;
    HugeVector<SurfelValues> values;
    HugeVector<std::uint32_t> ranks; // ascending
    HugeVector<float> spacings;      // see median_spacing()

    void add_spacings() {
        spacings.resize(surfels.size());
        parallel_for(surfels.size(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                spacings[i] = median_spacing(surfels, i);
        });
    }

    /// The reach of the fits for the ranks [begin, end): about twice the mean distance between neighbouring sources in
    /// space, so that about twelve sources lie within it. The reach is rounded to steps, so that it seldom changes
    /// between neighbouring blocks: a change may be visible.
    float reach(std::size_t begin, std::size_t end) const {
        constexpr std::size_t beside = 2;
        constexpr float spacings_per_reach = 1.0f; // spacings along the curve are larger than those in space
        constexpr float steps = 2.0f;              // per octave
        const auto at = [&](std::size_t rank) {
            return static_cast<std::size_t>(std::lower_bound(ranks.begin(), ranks.end(), rank) - ranks.begin());
        };
        const std::size_t first = at(begin), last = std::min(at(end) + beside, spacings.size());
        std::array<float, block + 2 * beside> near{};
        const std::size_t from = first - std::min(first, beside), count = std::min(last - from, near.size());
        std::copy_n(spacings.begin() + static_cast<std::ptrdiff_t>(from), count, near.begin());
        const auto middle = near.begin() + static_cast<std::ptrdiff_t>(count / 2);
        std::nth_element(near.begin(), middle, near.begin() + static_cast<std::ptrdiff_t>(count));
        const float reach = spacings_per_reach * *middle;
        return reach > 0.0f ? std::exp2(std::ceil(steps * std::log2(reach)) / steps) : 0.0f;
    }
};

class Interpolator {
  public:
    Interpolator(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const MethodRun& run,
                 const Occluders& occluders, const Interpolation& interpolation, const PrepareSurfels& prepare,
                 const Progress& progress)
        : run_(run), occluders_(occluders), interpolation_(interpolation), prepare_(prepare), progress_(progress),
          surfels_(surfels), used_(run.wanted.has(Channel::bent_normal) ? 4 : 1), ranks_(order.size()) {
        places_.reserve(order.size());
        reserve_huge(indices_, order.size());
        states_.reserve(order.size());
        constexpr std::size_t ahead = 32;
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (i + ahead < order.size())
                __builtin_prefetch(&surfels[order[i + ahead]]);
            const Surfel& surfel = surfels[order[i]];
            if (indices_.empty() || !is_same(surfel, surfels[indices_.back()])) {
                places_.push_back({surfel.position, surfel.normal});
                indices_.push_back(order[i]);
                states_.push_back(surfel.covered ? State::to_evaluate : State::unknown);
            }
            ranks_[i] = static_cast<std::uint32_t>(indices_.size() - 1);
        }
        values_.resize(used_ * count());
    }

    /// Evaluates or interpolates all surfels. \return false if more than `max_share` of them would have to be evaluated
    bool run() {
        for (std::size_t stride = interpolation_.stride;; stride /= 4) {
            std::vector<std::uint32_t> next;
            for (std::uint32_t i = 0; i < count(); ++i)
                if (states_[i] == State::to_evaluate || (states_[i] == State::unknown && is_chosen(i, stride)))
                    next.push_back(i);
            if (static_cast<double>(evaluated_ + next.size()) > interpolation_.max_share * static_cast<double>(count()))
                return false;
            evaluate_at(next);
            if (stride == 1)
                break;
            interpolate();
        }
        return true;
    }

    /// The share of the surfels that were evaluated.
    double share() const {
        return static_cast<double>(evaluated_) / static_cast<double>(std::max<std::size_t>(count(), 1));
    }

    /// The values of the surfel at a rank in `order`.
    const float* values(std::size_t rank) const { return &values_[used_ * ranks_[rank]]; }

  private:
    enum class State : std::uint8_t { unknown, to_evaluate, evaluated, interpolated };
    /// The position and normal of a surfel. There are millions of surfels, so nothing else is copied.
    struct Place {
        Vec3 position, normal;
    };

    std::size_t count() const { return indices_.size(); }

    /// Chooses one of every `stride` surfels at random. A fixed choice would be biased where surfels alternate
    /// regularly along the curve, as on the two sides of a sheet or on a grid.
    static bool is_chosen(std::uint32_t rank, std::size_t stride) {
        return rank % stride == hash(static_cast<std::uint32_t>(rank / stride)) % stride;
    }

    void evaluate_at(const std::vector<std::uint32_t>& chosen) {
        const std::vector<std::uint32_t> indices = pick(indices_, chosen);
        std::vector<Surfel> some = pick(surfels_, indices);
        if (prepare_)
            prepare_(indices, some);
        std::vector<std::uint32_t> order(some.size());
        std::iota(order.begin(), order.end(), 0u);
        Progress progress;
        if (progress_)
            progress = [&](double done) {
                progress_((static_cast<double>(evaluated_) + done * static_cast<double>(some.size())) /
                          static_cast<double>(count()));
            };
        const ChannelValues values = run_.method->bake(some, order, occluders_, run_.settings, run_.wanted, progress);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            float* const to = &values_[used_ * chosen[i]];
            to[0] = values[Channel::ao][i];
            if (used_ > 1)
                std::copy_n(&values[Channel::bent_normal][3 * i], 3, to + 1);
            states_[chosen[i]] = State::evaluated;
        }
        evaluated_ += chosen.size();
    }

    /// Interpolates at the unknown surfels around which the sources agree.
    void interpolate() {
        Sources sources;
        for (std::uint32_t i = 0; i < count(); ++i)
            if (states_[i] == State::evaluated) {
                sources.surfels.push_back({places_[i].position, places_[i].normal});
                SurfelValues& values = sources.values.emplace_back();
                values.fill(0.0f);
                std::copy_n(&values_[used_ * i], used_, values.begin());
                sources.ranks.push_back(i);
            }
        if (sources.surfels.size() < 2)
            return;
        sources.add_spacings();
        const double sum = std::accumulate(sources.spacings.begin(), sources.spacings.end(), 0.0);
        const SurfelCells cells(sources.surfels, static_cast<float>(sum / static_cast<double>(sources.surfels.size())));
        if (cells.is_sparse())
            return;
        parallel_for((count() + block - 1) / block, grain / block, [&](std::size_t begin, std::size_t end) {
            SurfelCells::Found found;
            FitSources near;
            for (std::size_t b = begin; b < end; ++b)
                interpolate_block(b * block, std::min((b + 1) * block, count()), sources, cells, found, near);
        });
    }

    void interpolate_block(std::size_t begin, std::size_t end, const Sources& sources, const SurfelCells& cells,
                           SurfelCells::Found& found, FitSources& near) {
        constexpr double most_cells = 512.0; // with more cells, evaluation is faster than interpolation
        std::optional<Bounds> bounds;
        for (std::size_t i = begin; i < end; ++i)
            if (states_[i] == State::unknown) {
                if (!bounds)
                    bounds = Bounds{places_[i].position, places_[i].position};
                bounds->add(places_[i].position);
            }
        if (!bounds)
            return;
        const float reach = sources.reach(begin, end);
        if (!(reach > 0.0f))
            return;
        bounds->low -= Vec3(reach);
        bounds->high += Vec3(reach);
        const SurfelCells::Cells inside = cells.cells_in(*bounds);
        if (inside.count() > most_cells) { // the curve jumps within the block
            if (end - begin == 1)
                return;
            const std::size_t middle = begin + (end - begin) / 2;
            interpolate_block(begin, middle, sources, cells, found, near);
            interpolate_block(middle, end, sources, cells, found, near);
            return;
        }
        cells.find(inside, *bounds, found);
        near.clear();
        for (const std::uint32_t point : found.points()) {
            const std::uint32_t source = cells.points().surfel[point];
            near.push_back(sources.surfels[source], sources.values[source]);
        }
        const FitSources::Arrays arrays = near.arrays();
        for (std::size_t i = begin; i < end; ++i)
            if (states_[i] == State::unknown)
                interpolate_at(i, arrays, reach);
    }

    void interpolate_at(std::size_t i, const FitSources::Arrays& near, float reach) {
        constexpr float least_weight = 0.5f; // a single source close to the surfel weighs more
        const LocalFit fit = local_fit(near, {places_[i].position, places_[i].normal}, reach, used_);
        if (!(fit.weight >= least_weight) || !(fit.deviation <= interpolation_.tolerance)) // also NaN
            return;
        states_[i] = State::interpolated;
        float* const to = &values_[used_ * i];
        to[0] = std::clamp(fit.values[0], 0.0f, 1.0f);
        if (used_ == 1)
            return;
        const Vec3 bent(fit.values[1], fit.values[2], fit.values[3]);
        const float length = glm::length(bent);
        for (int axis = 0; axis < 3; ++axis)
            to[1 + axis] = to[0] > 0.0f && length > 0.0f ? bent[axis] / length : 0.0f;
    }

    const MethodRun& run_;
    const Occluders& occluders_;
    const Interpolation& interpolation_;
    const PrepareSurfels& prepare_;
    const Progress& progress_;
    std::span<const Surfel> surfels_;
    std::size_t used_;                   // values per surfel
    HugeVector<std::uint32_t> ranks_;    // index into the arrays below, by rank in `order`
    HugeVector<Place> places_;           // along the curve; successive equal surfels are merged
    std::vector<std::uint32_t> indices_; // index of the first surfel of each place
    HugeVector<float> values_;
    HugeVector<State> states_;
    std::size_t evaluated_ = 0;
};

}

std::optional<InterpolatedValues> evaluate_interpolated(std::span<const Surfel> surfels,
                                                        std::span<const std::uint32_t> order,
                                                        const Occluders& occluders, const MethodRun& run,
                                                        const Interpolation& interpolation,
                                                        const PrepareSurfels& prepare, const Progress& progress) {
    Interpolator interpolator(surfels, order, run, occluders, interpolation, prepare, progress);
    InterpolatedValues result;
    if (!interpolator.run())
        return {};
    result.share = interpolator.share();
    for (const ChannelInfo& channel : channels)
        if (run.wanted.has(channel.channel)) {
            std::vector<float>& values = result.values[channel.channel];
            values.assign(surfels.size() * channel.components, channel.missing);
            const std::ptrdiff_t first = channel.channel == Channel::ao ? 0 : 1;
            parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    std::copy_n(interpolator.values(i) + first, channel.components,
                                &values[order[i] * channel.components]);
            });
        }
    return result;
}

}
