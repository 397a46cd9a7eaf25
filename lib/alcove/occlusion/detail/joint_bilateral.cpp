#include "alcove/occlusion/detail/joint_bilateral.h"

#include "alcove/base/detail/memory.h"
#include "alcove/field/detail/trace.h"
#include "alcove/occlusion/detail/ridge_regression.h"
#include "alcove/occlusion/detail/subset.h"
#include "alcove/occlusion/methods/calibrated_networks.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

using Probes = ThirtyEightProbes; // more probes would cost more time than another ray
static_assert(Curve::probes == Probes::normal.size() + Probes::rings.size());

/// The length of the mean of cosine-weighted directions if all are open: ∫ cos²θ dω / π.
constexpr float open_length = 2.0f / 3.0f;

/// The variance of a single ray, from the predicted visibility. Never 0, because a prediction is not certain.
float variance_of(float open) {
    const float p = std::clamp(open, 0.05f, 0.95f);
    return p * (1.0f - p);
}

/// The weight of a surfel's own rays relative to the filtered value (James and Stein 1961): 0 if noise explains the
/// variance among the neighbours. The threshold is twice the noise, because the variance is itself an estimate.
float own_weight(float variance, float noise) {
    return variance > 2.0f * noise ? 1.0f - 2.0f * noise / variance : 0.0f;
}

}

JointBilateral::JointBilateral(std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                               const Guided& guided, bool with_bent)
    : guided_(guided), lattice_(guided.rays), with_bent_(with_bent),
      spacings_(20.0f * std::pow(static_cast<float>(guided.rays), -0.6f)),
      noise_(std::pow(static_cast<float>(guided.rays), -1.4f)),
      noise_of_bent_(0.5f * std::pow(static_cast<float>(guided.rays), -1.8f)), index_(order.size()) {
    reserve_huge(surfels_, order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Surfel& surfel = surfels[order[i]];
        if (surfels_.empty() || !is_same(surfel, surfels_.back()))
            surfels_.push_back(surfel);
        index_[i] = static_cast<std::uint32_t>(surfels_.size() - 1);
    }
    padded_ = std::max(surfels_.size(), Curve::window);
    const std::size_t used = with_bent ? columns : bent;
    reserve_huge(values_, (used + features) * padded_);
    values_.resize((used + features) * padded_);
    for (std::size_t column = 0; column < used; ++column)
        columns_[column] = values_.data() + column * padded_;
    for (std::size_t feature = 0; feature < features; ++feature)
        features_[feature] = values_.data() + (used + feature) * padded_;
    for (std::size_t i = 0; i < surfels_.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            columns_[position + axis][i] = surfels_[i].position[static_cast<int>(axis)];
            columns_[normal + axis][i] = surfels_[i].normal[static_cast<int>(axis)];
        }
}

void JointBilateral::probe(const AnyField& field, std::size_t begin, std::size_t end) {
    // Probes farther than one diagonal from the mesh carry no information.
    const float radius = std::min(guided_.radius, 1.0f);
    const float lift = start_height(field, radius);
    SurfelBatch batch;
    CalibratedInputs<Probes> inputs{};
    const RingNetwork::Condition condition = calibrated_condition(field, radius);
    for (std::size_t at = begin; at < end; at += batch.count) {
        batch.count = 0;
        for (std::size_t i = at; i < end && batch.count < SurfelBatch::capacity; ++i)
            batch.push_back(surfels_[i], lift);
        calibrated_inputs<Probes>(field, batch, radius, inputs);
        RingNetwork::Hidden hidden;
        calibrated_network<Probes>().hidden_layer(inputs, condition, hidden);
        for (std::size_t k = 0; k < hidden.size(); ++k)
            std::copy_n(hidden[k].begin(), batch.count, features_[Curve::probes + k] + at);
        for (std::size_t i = 0; i < Probes::normal.size(); ++i)
            std::copy_n(inputs[i].begin(), batch.count, features_[i] + at);
        for (std::size_t ring = 0; ring < Probes::rings.size(); ++ring) {
            float* const mean = features_[Probes::normal.size() + ring] + at;
            std::fill_n(mean, batch.count, 0.0f);
            for (std::size_t a = 0; a < Probes::azimuths; ++a)
                for (std::size_t k = 0; k < batch.count; ++k)
                    mean[k] += inputs[Probes::normal.size() + a * Probes::rings.size() + ring][k] / Probes::azimuths;
        }
    }
}

void JointBilateral::shoot(const RaySurface& surface, std::size_t begin, std::size_t end) {
    RayBatch batch;
    std::array<std::uint32_t, RayBatch::capacity> owner;
    const float part = 1.0f / static_cast<float>(guided_.rays);
    const auto flush = [&] {
        surface.find_occluded(batch, guided_.radius);
        for (std::size_t r = 0; r < batch.count; ++r)
            if (!batch.hit[r]) {
                columns_[ao][owner[r]] += part;
                if (!with_bent_)
                    continue;
                columns_[bent][owner[r]] += part * batch.dx[r];
                columns_[bent + 1][owner[r]] += part * batch.dy[r];
                columns_[bent + 2][owner[r]] += part * batch.dz[r];
            }
        batch.count = 0;
    };
    for (std::size_t i = begin; i < end; ++i) {
        if (surfels_[i].covered)
            continue;
        const Basis basis(surfels_[i].normal);
        const Vec3 origin = surfels_[i].ray_origin(ray_offset(guided_.radius));
        const CosineLattice::Shift shift(recurrence_point(i, guided_.seed));
        for (int r = 0; r < guided_.rays; ++r) {
            owner[batch.count] = static_cast<std::uint32_t>(i);
            batch.push_back({origin, basis.to_world(lattice_.direction(r, shift))}, 0.0f);
            if (batch.count == RayBatch::capacity)
                flush();
        }
    }
    flush();
    // Filter only the deviation of the mean direction from the normal, the mean direction of an unoccluded surfel.
    for (std::size_t i = begin; with_bent_ && i < end; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            columns_[bent + axis][i] -= open_length * columns_[ao][i] * columns_[normal + axis][i];
}

void JointBilateral::fit_model() {
    const RidgeRegression model = fit_linear_model(features_, {columns_[ao], size()}, size());
    model.predict(features_, 0, size(), columns_[predicted]);
    double sum = 0.0, sum2 = 0.0, unexplained = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
        const float open = std::clamp(columns_[predicted][i], 0.0f, 1.0f), error = columns_[ao][i] - open;
        columns_[predicted][i] = open;
        columns_[residual][i] = error;
        sum += open, sum2 += double(open) * open;
        unexplained += double(error) * error - 1.3 * noise_ * variance_of(open);
    }
    // On scans, the standard deviation of the model's error is 0.2 to 0.4 times that of the true ao, and the
    // predictions vary about as much as the true ao. Hence the factor 0.16 = 0.4². The variance is set higher if the
    // residuals exceed the noise of the rays, whose variance is at most 1.3 times that given by noise_.
    const auto count = static_cast<double>(size());
    const double variance = sum2 / count - (sum / count) * (sum / count);
    model_variance_ = static_cast<float>(std::max({0.16 * variance, unexplained / count, 4e-4}));
}

JointBilateral::Filtered JointBilateral::filter(std::size_t i) const {
    if (surfels_[i].covered)
        return {0.0f, Vec3(0.0f)};
    const std::size_t first = std::min(i - std::min(i, Curve::window / 2), padded_ - Curve::window);
    std::array<float, Curve::window> weights;
    weigh(curve(), i, first, reach(i), weights.data());
    const float model = columns_[predicted][i];
    const Moments m = moments(weights.data(), columns_[predicted] + first, model, columns_[residual] + first);
    const float noise = noise_ * variance_of(model);
    const float mean = m.v / (m.w + noise / model_variance_);
    const float variance = m.vv / m.w - 2.0f * mean * m.v / m.w + mean * mean;
    const float smooth = model + mean, own = own_weight(variance, noise);
    Filtered filtered{std::clamp(smooth + own * (columns_[ao][i] - smooth), 0.0f, 1.0f), Vec3(0.0f)};
    if (with_bent_)
        filtered.bent = filter_bent(i, first, weights.data()) + open_length * filtered.ao * surfels_[i].normal;
    return filtered;
}

/// Fits each component as a + b·(predicted_i − predicted) over the neighbours. The more variance the fit leaves
/// unexplained, the more the surfel's own rays count.
Vec3 JointBilateral::filter_bent(std::size_t i, std::size_t first, const float* weights) const {
    float unexplained = 0.0f;
    Vec3 fitted(0.0f), own(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const float* values = columns_[bent + static_cast<std::size_t>(axis)];
        const Moments m = moments(weights, columns_[predicted] + first, columns_[predicted][i], values + first);
        const float g = m.g / m.w, v = m.v / m.w;
        // The 1e-4 keeps rounding differences between nearly equal predictions from producing a slope.
        const float spread = m.gg / m.w - g * g + 1e-4f, covariance = m.vg / m.w - g * v;
        const float slope = covariance / spread;
        fitted[axis] = v - slope * g;
        own[axis] = values[i];
        unexplained += std::max(m.vv / m.w - v * v - slope * covariance, 0.0f);
    }
    return fitted + own_weight(unexplained, noise_of_bent_) * (own - fitted);
}

Curve JointBilateral::curve() const {
    Curve curve{};
    curve.x = columns_[position], curve.y = columns_[position + 1], curve.z = columns_[position + 2];
    curve.nx = columns_[normal], curve.ny = columns_[normal + 1], curve.nz = columns_[normal + 2];
    for (std::size_t k = 0; k < Curve::probes; ++k)
        curve.probe[k] = features_[k];
    return curve;
}

float JointBilateral::reach(std::size_t i) const {
    return surfels_.size() > 1 ? std::max(spacings_ * median_spacing(surfels_, i), 1e-6f) : 1.0f;
}

}
