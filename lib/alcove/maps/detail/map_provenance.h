/// How maps were made, as text for their files.
#pragma once

#include "alcove/maps/maps.h"
#include "alcove/render/detail/png_file.h"

#include <string>
#include <vector>

namespace alcove {

/// The name and version of the program: "alcove 0.2.0".
std::string map_software();
/// How the maps were made: "ambient occlusion by traced, radius 0.5". Empty if no method made the maps.
std::string how_made(const BakedMaps& maps);
/// map_software() and how_made(), as texts for a PNG.
std::vector<PngText> png_texts(const BakedMaps& maps);

}
