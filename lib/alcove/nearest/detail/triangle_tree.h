/// A surface as a tree in which nearest triangles are found, eight at a time. Internal to grid/.
#pragma once

#include "alcove/nearest/detail/fragments.h"

#include <cstdint>
#include <vector>

namespace alcove {

/// Eight triangles near one another, each in a frame of its own: u along its side ab, v in the plane toward c and n
/// across, corner a the origin, b = (b, 0) and c = (c0, c1). Positions are relative to a voxel, the origin. Frames are
/// orthonormal whatever the triangle, so what rounding does to a sliver moves its corners by no more than that.
/// Slots without a triangle repeat the first.
struct alignas(64) TriangleLeaf {
    static constexpr int size = 8;

    float u[3][size], v[3][size], n[3][size];
    float a[3][size]; ///< along u, v and n
    float b[size], c[2][size];
    float per_ac[2][size], per_bc[2][size]; ///< side by squared length
    std::uint32_t triangle[size];
    Index3 origin;
    std::uint32_t count; ///< slots with a triangle
};

/// All that is in a subtree lies in a cylinder around the centre, at most `thickness` along the axis and `radius`
/// across. Flat parts of a surface get flat bounds.
struct alignas(16) Bounds {
    Vec3 centre, axis;
    Vec3 point; ///< of the surface, near the centre
    float thickness, radius;
    std::uint32_t child; ///< a triangle group below TriangleTree::leaves, the first of eight nodes above
};

/// Each node holds eight neighbours along the curve of its fragments, so no node is split and none is searched
/// for a place: building is one pass a level. Const use is thread-safe.
struct TriangleTree {
    HugeVector<TriangleLeaf> triangles;
    /// Level after level in eights, the root's last. Nodes that fill up an eight are nowhere, of a radius below 0.
    HugeVector<Bounds> nodes;
    std::uint32_t leaves = 0; ///< nodes before this one bound triangle groups

    /// \pre there is a fragment
    explicit TriangleTree(const FragmentLeaves& fragments);

    static constexpr std::uint32_t children = 8;
    std::uint32_t top() const {
        return static_cast<std::uint32_t>(nodes.size()) - children;
    } ///< first of eight
};

}
