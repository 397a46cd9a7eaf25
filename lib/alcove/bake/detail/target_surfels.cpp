#include "alcove/bake/detail/target_surfels.h"

#include "alcove/base/detail/stopwatch.h"
#include "alcove/occlusion/detail/contacts.h"
#include "alcove/occlusion/detail/subset.h"

#include <algorithm>

namespace alcove {
namespace {

std::size_t count_contacts(std::span<const Surfel> surfels) {
    return static_cast<std::size_t>(
        std::count_if(surfels.begin(), surfels.end(), [](const Surfel& s) { return s.away != Vec3(0.0f); }));
}

}

void TargetSurfels::find_contacts() {
    if (has_all_contacts_)
        return;
    const RaySurface& rays = occluders_.rays();
    Stopwatch watch;
    alcove::find_contacts(target_.surfels, rays, ray_offset(target_.radius), target_.is_own_face);
    contacts_ = count_contacts(target_.surfels);
    has_all_contacts_ = true;
    seconds_.grid += watch.lap();
}

void TargetSurfels::find_contacts(std::span<const std::uint32_t> indices, std::span<Surfel> copies) {
    if (has_all_contacts_)
        return;
    alcove::find_contacts(
        copies, occluders_.rays(), ray_offset(target_.radius),
        [&](std::size_t i, const Triangle& triangle) { return target_.is_own_face(indices[i], triangle); });
}

int TargetSurfels::cheap_rays() const {
    constexpr std::size_t of_all = 1 << 15, most = 4096; // these take some thousandths of a second
    return static_cast<int>(std::min(of_all / std::max<std::size_t>(target_.surfels.size(), 1), most));
}

const std::vector<std::uint32_t>& TargetSurfels::order() {
    if (order_.empty())
        order_ = spatial_order(target_.surfels);
    return order_;
}

std::vector<std::uint32_t> TargetSurfels::runs(std::size_t count, std::size_t length) {
    const std::vector<std::uint32_t>& order = this->order();
    length = std::min(length, order.size() / count);
    std::vector<std::uint32_t> runs;
    for (std::size_t run = 0; run < count; ++run) {
        const auto begin = order.begin() + static_cast<std::ptrdiff_t>(run * order.size() / count);
        runs.insert(runs.end(), begin, begin + static_cast<std::ptrdiff_t>(length));
    }
    return runs;
}

const Pilot& TargetSurfels::pilot(const PilotOptions& options) {
    if (!pilot_) {
        const RaySurface& rays = occluders_.rays();
        Stopwatch watch;
        PilotOptions share = options;
        share.surfels = std::min(share.surfels, target_.pilot_share.surfels);
        // With few surfels, noise does not cancel out. The reference must therefore be less noisy than the bake.
        constexpr int per_ray_of_bake = 4;
        share.rays = std::max(share.rays, per_ray_of_bake * cheap_rays());
        if (!has_all_contacts_)
            find_contacts_of_sample(evenly(order(), share.surfels));
        pilot_.emplace(target_.surfels, order(), rays, target_.radius, share);
        seconds_.pilot += watch.lap();
    }
    return *pilot_;
}

/// Finds the contacts of the surfels that the pilot samples, and from them estimates how many surfels have contacts.
void TargetSurfels::find_contacts_of_sample(const std::vector<std::uint32_t>& indices) {
    std::vector<Surfel> some = pick(target_.surfels, indices);
    find_contacts(indices, some);
    for (std::size_t i = 0; i < indices.size(); ++i)
        target_.surfels[indices[i]] = some[i];
    contacts_ = count_contacts(some) * target_.surfels.size() / std::max<std::size_t>(some.size(), 1);
}

}
