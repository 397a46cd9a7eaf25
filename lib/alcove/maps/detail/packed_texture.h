/// Packs ao into the metallic-roughness image of a glTF material.
#pragma once

#include "alcove/maps/detail/resample.h"
#include "alcove/mesh/formats/gltf/gltf_images.h"
#include "alcove/render/detail/png_file.h"

#include <span>
#include <string>

namespace alcove {

/// The size of an image, without decoding it. \throw like decode_image()
MapSize size_of(const GltfImage& image);

/// Checks the memory that packing into an image of size `to` takes. \throw LimitError if it is more than
/// memory_limit().
void check_packing(const GltfImage& image, MapSize to);

/// A PNG of size `to` whose red channel is the ao of a map, and whose other channels are those of the image.
/// \throw like decode_image()
std::string pack_occlusion(std::span<const float> ao, MapSize map, const GltfImage& image, MapSize to,
                           std::span<const PngText> texts);

}
