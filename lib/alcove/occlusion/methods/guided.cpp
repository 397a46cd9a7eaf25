#include "alcove/occlusion/methods/guided.h"

#include "alcove/occlusion/detail/joint_bilateral.h"

#include <mutex>

namespace alcove {
namespace {

constexpr std::size_t grain = 1024;

}

ChannelValues bake_channels(std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                            const AnyField& field, const RaySurface& surface, const Guided& guided,
                            ChannelSet wanted, const Progress& progress) {
    wanted = wanted & Guided::gives;
    const bool with_bent = wanted.has(Channel::bent_normal);
    JointBilateral shared(surfels, order, guided, with_bent);
    std::mutex progress_mutex;
    std::size_t finished = 0;
    const auto tell = [&](std::size_t done) {
        if (!progress)
            return;
        const std::lock_guard lock(progress_mutex);
        finished += done;
        progress(static_cast<double>(finished) / static_cast<double>(shared.size() + order.size()));
    };
    parallel_for(shared.size(), grain, [&](std::size_t begin, std::size_t end) {
        shared.probe(field, begin, end);
        shared.shoot(surface, begin, end);
        tell(end - begin);
    });
    shared.fit_model();
    ChannelValues baked;
    for (const ChannelInfo& channel : channels)
        if (wanted.has(channel.channel))
            baked[channel.channel].assign(surfels.size() * channel.components, channel.missing);
    parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t rank = begin; rank < end; ++rank) {
            const JointBilateral::Answer answer = shared.share(shared.place(rank));
            if (wanted.has(Channel::ao))
                baked[Channel::ao][order[rank]] = answer.ao;
            if (with_bent) {
                const float length = glm::length(answer.bent);
                const Vec3 direction = answer.ao > 0.0f && length > 0.0f ? answer.bent / length : Vec3(0.0f);
                float* to = baked[Channel::bent_normal].data() + std::size_t{3} * order[rank];
                to[0] = direction.x, to[1] = direction.y, to[2] = direction.z;
            }
        }
        tell(end - begin);
    });
    return baked;
}

}
