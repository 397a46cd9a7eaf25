#include "alcove/occlusion/methods/guided.h"

#include "alcove/occlusion/detail/joint_bilateral.h"

#include <mutex>

namespace alcove {
namespace {

constexpr std::size_t grain = 1024;

}

ChannelValues evaluate(std::span<const Surfel> surfels, std::span<const std::uint32_t> order, const AnyField& field,
                       const RaySurface& surface, const Guided& guided, ChannelSet wanted, const Progress& progress) {
    wanted = wanted & Guided::gives;
    const bool with_bent = wanted.has(Channel::bent_normal);
    JointBilateral bilateral(surfels, order, guided, with_bent);
    std::mutex progress_mutex;
    std::size_t finished = 0;
    const auto report = [&](std::size_t done) {
        if (!progress)
            return;
        const std::lock_guard lock(progress_mutex);
        finished += done;
        progress(static_cast<double>(finished) / static_cast<double>(bilateral.size() + order.size()));
    };
    parallel_for(bilateral.size(), grain, [&](std::size_t begin, std::size_t end) {
        bilateral.probe(field, begin, end);
        bilateral.shoot(surface, begin, end);
        report(end - begin);
    });
    bilateral.fit_model();
    ChannelValues baked;
    for (const ChannelInfo& channel : channels)
        if (wanted.has(channel.channel))
            baked[channel.channel].assign(surfels.size() * channel.components, channel.missing);
    parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t rank = begin; rank < end; ++rank) {
            const JointBilateral::Filtered filtered = bilateral.filter(bilateral.index_of(rank));
            if (wanted.has(Channel::ao))
                baked[Channel::ao][order[rank]] = filtered.ao;
            if (with_bent) {
                const float length = glm::length(filtered.bent);
                const Vec3 direction = filtered.ao > 0.0f && length > 0.0f ? filtered.bent / length : Vec3(0.0f);
                float* to = baked[Channel::bent_normal].data() + std::size_t{3} * order[rank];
                to[0] = direction.x, to[1] = direction.y, to[2] = direction.z;
            }
        }
        report(end - begin);
    });
    return baked;
}

}
