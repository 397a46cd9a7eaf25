#include "alcove/maps/detail/map_provenance.h"

#include "alcove/bake/detail/provenance.h"

#include <fmt/format.h>

namespace alcove {

std::string map_software() {
    return fmt::format("{}{}", provenance, ALCOVE_VERSION);
}

std::string how_made(const BakedMaps& maps) {
    if (maps.baked.method.empty())
        return "";
    return fmt::format("ambient occlusion by {}, radius {:.6g}", maps.baked.method, maps.baked.radius);
}

std::vector<PngText> png_texts(const BakedMaps& maps) {
    std::vector<PngText> texts{{"Software", map_software()}};
    if (const std::string how = how_made(maps); !how.empty())
        texts.push_back({"Comment", how});
    return texts;
}

}
