#include "alcove/occlusion/channels.h"

#include <fmt/format.h>

namespace alcove {

std::string names_of(ChannelSet attributes) {
    std::string names;
    for (const ChannelInfo& channel : channels)
        if (attributes.has(channel.channel))
            names += fmt::format("{}{}", names.empty() ? "" : ", ", channel.name);
    return names;
}

}
