/// What a bake can give: its channels, and where an estimator writes them.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace alcove {

enum class Channel : std::uint8_t {
    ao,          ///< visibility in [0, 1]: 1 open, 0 buried
    ao_short,    ///< visibility at short range alone, in [0, 1]
    ao_long,     ///< visibility at long range, in [0, 1]
    convexity,   ///< in [0, 1]: 0.5 flat, above a convex edge, below a concave corner
    bent_normal, ///< mean unoccluded direction, unit length; (0, 0, 0) where nothing is open
    thickness, ///< distance along the reversed normal to the far side, at most the radius; unit of the field
};

struct ChannelInfo {
    Channel channel;
    std::string_view name;
    std::size_t components; ///< floats a surfel
    float missing;          ///< of a surfel without a normal
    bool inside;            ///< whether the field is asked behind the surface, as deep as the radius
};

inline constexpr std::array<ChannelInfo, 6> channels{{
    {Channel::ao, "ao", 1, 1.0f, false},
    {Channel::ao_short, "ao_short", 1, 1.0f, false},
    {Channel::ao_long, "ao_long", 1, 1.0f, false},
    {Channel::convexity, "convexity", 1, 0.5f, true},
    {Channel::bent_normal, "bent_normal", 3, 0.0f, false},
    {Channel::thickness, "thickness", 1, 0.0f, true},
}};

constexpr const ChannelInfo& info(Channel channel) {
    return channels[static_cast<std::size_t>(channel)];
}

/// Something for each channel.
template <class T>
struct PerChannel {
    std::array<T, channels.size()> values{};

    constexpr T& operator[](Channel channel) { return values[static_cast<std::size_t>(channel)]; }
    constexpr const T& operator[](Channel channel) const { return values[static_cast<std::size_t>(channel)]; }
};

/// The channels somebody asks for, or an estimator gives.
using ChannelSet = EnumSet<Channel>;

constexpr ChannelSet operator|(Channel a, Channel b) {
    return ChannelSet(a) | b;
}

/// Where an estimator writes the channels of a batch, one surfel after the other; null for those that nobody
/// asked for.
using Outputs = PerChannel<float*>;

}
