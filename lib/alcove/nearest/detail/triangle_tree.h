/// A tree of a surface's triangles for nearest-triangle searches that test eight triangles at a time.
#pragma once

#include "alcove/nearest/detail/fragments.h"

#include <cstdint>
#include <vector>

namespace alcove {

/// Eight triangles near one another, each in its own frame: u is along side ab, v in the plane toward c, n normal
/// to it; corner a is the origin, b = (b, 0) and c = (c0, c1). Positions are relative to a voxel, `origin`. Frames
/// are orthonormal even for slivers, so rounding moves the corners of a sliver by no more than the rounding error.
/// Unused slots repeat the first triangle.
struct alignas(64) TriangleLeaf {
    static constexpr int size = 8;

    float u[3][size], v[3][size], n[3][size];
    float a[3][size]; ///< coordinates along u, v and n
    float b[size], c[2][size];
    float per_ac[2][size], per_bc[2][size]; ///< side vector divided by its squared length
    std::uint32_t triangle[size];
    Index3 origin;
    std::uint32_t count; ///< used slots
};

/// A cylinder that contains a subtree: it extends at most `thickness` from the centre along the axis and `radius`
/// across. Flat parts of a surface get flat bounds.
struct alignas(16) Bounds {
    Vec3 centre, axis;
    Vec3 point; ///< a point of the surface near the centre
    float thickness, radius;
    std::uint32_t child; ///< a TriangleLeaf below TriangleTree::leaves, else the first of eight nodes
};

/// Each node contains eight consecutive nodes or fragments along the Morton curve, so the tree is built bottom-up
/// in one pass per level. Const use is thread-safe.
struct TriangleTree {
    HugeVector<TriangleLeaf> triangles;
    /// Levels from the leaves to the root, each padded to a multiple of eight with distant nodes of negative radius.
    HugeVector<Bounds> nodes;
    std::uint32_t leaves = 0; ///< nodes before this one bound a TriangleLeaf

    /// \pre there is at least one fragment
    explicit TriangleTree(const FragmentLeaves& fragments);

    static constexpr std::uint32_t children = 8;
    /// The first of the eight nodes of the top level.
    std::uint32_t top() const { return static_cast<std::uint32_t>(nodes.size()) - children; }
};

}
