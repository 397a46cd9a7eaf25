/// The output channels of a bake and their storage.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

enum class Channel : std::uint8_t {
    ao,          ///< visibility in [0, 1]: 1 open, 0 fully occluded
    ao_short,    ///< short-range visibility only, in [0, 1]
    ao_long,     ///< visibility over the full range, in [0, 1]
    convexity,   ///< in [0, 1]: 0.5 on flat surfaces, higher on convex edges, lower in concave corners
    bent_normal, ///< cosine-weighted mean of the unoccluded directions, unit length; (0, 0, 0) if none is open
    thickness,   ///< distance along the reversed normal to the far side, at most longest_ray(); field unit
};

struct ChannelInfo {
    Channel channel;
    std::string_view name;
    std::size_t components; ///< floats per surfel
    float missing;          ///< value for surfels without a normal
    bool inside;            ///< whether it needs the field behind the surface, to the depth of the radius
    bool visibility;        ///< whether it is a visibility: 0 at surfels that other faces cover
};

inline constexpr std::array<ChannelInfo, 6> channels{{
    {Channel::ao, "ao", 1, 1.0f, false, true},
    {Channel::ao_short, "ao_short", 1, 1.0f, false, true},
    {Channel::ao_long, "ao_long", 1, 1.0f, false, true},
    {Channel::convexity, "convexity", 1, 0.5f, true, false},
    {Channel::bent_normal, "bent_normal", 3, 0.0f, false, true},
    {Channel::thickness, "thickness", 1, 0.0f, true, false},
}};

constexpr const ChannelInfo& info(Channel channel) {
    return channels[static_cast<std::size_t>(channel)];
}

/// One value per channel.
template <class T>
struct PerChannel {
    std::array<T, channels.size()> values{};

    constexpr T& operator[](Channel channel) { return values[static_cast<std::size_t>(channel)]; }
    constexpr const T& operator[](Channel channel) const { return values[static_cast<std::size_t>(channel)]; }
};

/// The values of each channel: for each surfel, as many floats as the channel has components. Empty for channels that
/// were not requested.
using ChannelValues = PerChannel<std::vector<float>>;

/// A set of channels: those requested, or those an estimator provides.
using ChannelSet = EnumSet<Channel>;

constexpr ChannelSet operator|(Channel a, Channel b) {
    return ChannelSet(a) | b;
}

/// Where an estimator writes the values of each channel for one batch, surfel after surfel. Null for channels that were
/// not requested, except that ao is never null.
using Outputs = PerChannel<float*>;

/// The names of the channels in the set, in the order of `channels`: "ao, convexity".
std::string names_of(ChannelSet attributes);

}
