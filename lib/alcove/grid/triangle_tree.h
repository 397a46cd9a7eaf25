/// A surface as a tree in which nearest triangles are found, eight at a time. Internal to grid/.
#pragma once

#include "alcove/grid/pieces.h"

#include <cstdint>
#include <vector>

namespace alcove {

/// Eight triangles near one another, relative to a voxel: origin + a + s·ab + t·ac. Slots without a triangle
/// repeat the first.
struct alignas(64) TriangleGroup {
    static constexpr int size = 8;

    float a[3][size], ab[3][size], ac[3][size];
    Index3 origin;
    std::uint32_t triangle[size];
    std::uint32_t count; ///< slots with a triangle
};

/// Bounds of eight subtrees: all that is in one lies in a cylinder around its centre, at most `thickness`
/// along the axis and `radius` across. Flat parts of a surface get flat bounds. Slots without a subtree are
/// nowhere.
struct alignas(64) BoundsGroup {
    static constexpr int size = 8;

    float centre[3][size], axis[3][size];
    float point[3][size]; ///< one of the surface, near the centre
    float thickness[size], radius[size];
    std::uint32_t child[size]; ///< a triangle group below TriangleTree::leaves, a group of bounds above
};

/// Each node holds eight neighbours along the curve of its pieces, so no node is split and none is searched
/// for a place: building is one pass a level. Const use is thread-safe.
struct TriangleTree {
    std::vector<TriangleGroup> triangles;
    std::vector<BoundsGroup> bounds; ///< level after level, the root's group last
    std::uint32_t leaves = 0;        ///< groups of bounds before this one bound triangle groups

    /// \pre there is a piece
    explicit TriangleTree(const GroupedPieces& pieces);

    std::uint32_t root() const { return static_cast<std::uint32_t>(bounds.size() - 1); }
};

}
