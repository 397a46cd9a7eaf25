#include "alcove/maps/maps.h"

#include <fmt/format.h>

namespace alcove {
namespace {

/// Calls `visit` with each attribute.
template <class Visit>
void for_each_attribute(const Visit& visit) {
    for (int i = 0; i <= static_cast<int>(MapAttribute::object); ++i)
        visit(static_cast<MapAttribute>(i));
}

}

MapAttributeInfo info(MapAttribute attribute) {
    switch (attribute) {
    case MapAttribute::normal:
        return {"normal", 3, 0.0f, true};
    case MapAttribute::height:
        return {"height", 1, 0.0f, false};
    case MapAttribute::position:
        return {"position", 3, 0.0f, false};
    case MapAttribute::object:
        return {"object", 1, 0.0f, false};
    default:
        const ChannelInfo& channel = info(static_cast<Channel>(attribute));
        return {channel.name, channel.components, channel.missing, attribute == MapAttribute::bent_normal};
    }
}

MapAttribute map_attribute(std::string_view name) {
    std::optional<MapAttribute> found;
    std::string known;
    for_each_attribute([&](MapAttribute attribute) {
        const std::string_view known_name = info(attribute).name;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", known_name);
        if (known_name == name)
            found = attribute;
    });
    if (!found)
        throw InputError(fmt::format("takes {}, separated by commas, not '{}'", known, name));
    return *found;
}

EnumSet<MapAttribute> attributes_of(ChannelSet baked) {
    EnumSet<MapAttribute> attributes;
    for (const ChannelInfo& channel : channels)
        if (baked.has(channel.channel))
            attributes = attributes | attribute_of(channel.channel);
    return attributes;
}

ChannelSet channels_of(EnumSet<MapAttribute> attributes) {
    ChannelSet baked;
    for (const ChannelInfo& channel : channels)
        if (attributes.has(attribute_of(channel.channel)))
            baked = baked | channel.channel;
    return baked;
}

}
