/// Images side by side.
#pragma once

#include "alcove/render/image.h"

#include <algorithm>
#include <vector>

namespace alcove::docs {

/// Joins the ao of images of equal height, from left to right.
inline Image row_of(const std::vector<Image>& tiles) {
    int width = 0;
    for (const Image& tile : tiles)
        width += tile.width;
    Image row(width, tiles.front().height);
    for (int y = 0; y < row.height; ++y) {
        auto to = static_cast<std::ptrdiff_t>(y) * width;
        for (const Image& tile : tiles) {
            const auto from = static_cast<std::ptrdiff_t>(y) * tile.width;
            std::copy_n(tile.alpha.begin() + from, tile.width, row.alpha.begin() + to);
            std::copy_n(tile.ao.begin() + from, tile.width, row.ao.begin() + to);
            to += tile.width;
        }
    }
    return row;
}

}
