/// Computes the narrow band around a surface, brick by brick.
#pragma once

#include "alcove/grid/detail/pseudonormals.h"
#include "alcove/grid/detail/winding.h"
#include "alcove/grid/grid_stack.h"
#include "alcove/nearest/nearest.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// How far behind a face of a sheet distances are negative, in voxels. Well above 1, so that a face on a plane of
/// the grid has a full layer of negative corners behind it, whatever sign rounding gives the corners on the plane;
/// otherwise rays could step through. Corners of crossed cells can be up to √3 voxels behind the face, but those
/// beyond this thickness have almost no weight in the interpolation at the face.
inline constexpr float sheet_thickness = 1.5f;

struct BandWidth {
    float outer = 0.0f; ///< voxels
    float inner = 0.0f; ///< voxels; equal to `outer` for sheets
};

/// A brick that the band may touch, and the tree nodes that may be nearest to its voxels.
struct BandBlock {
    Index3 low; ///< a multiple of brick_size
    Nodes nodes;
};

/// Signed distances in voxels, z fastest; plus or minus the band width outside the band.
struct BandBrick {
    float values[brick_volume];
    std::uint64_t active[brick_size] = {}; ///< one word per x-slice, one bit per voxel in the band
    std::size_t count = 0;                 ///< number of voxels in the band
    /// The nearest triangle; set where the distance was not known before and is in the band.
    std::array<std::uint32_t, brick_volume> triangle;
};

/// Distances are exact and bricks are independent of each other, so bricks can be computed in parallel and levels of
/// any stride use the same tree.
class Band {
  public:
    /// A solid: distances are negative where the winding number is 1 or more.
    Band(const TriangleTree& tree, const WindingColumns& columns, BandWidth width)
        : tree_(&tree), columns_(&columns), width_(width) {}
    /// A sheet: distances up to `width` on both sides, negative up to sheet_thickness behind a face.
    Band(const TriangleTree& tree, const Pseudonormals& normals, float width)
        : tree_(&tree), normals_(&normals), width_{width, width} {}

    BandWidth width() const { return width_; }
    Sign sign() const { return columns_ ? Sign::solid : Sign::sheet; }

    /// The nodes of the whole tree, for bricks that blocks() does not return.
    Nodes all_nodes() const;
    /// The bricks of a level whose voxels are `stride` apart in the tree's units, in no particular order.
    std::vector<BandBlock> blocks(int stride) const;

    /// `known` are distances already computed, in voxels, z fastest; infinite where unknown. Thread-safe.
    BandBrick brick(const BandBlock& block, int stride, std::span<const float, brick_volume> known) const;

  private:
    const TriangleTree* tree_;
    const WindingColumns* columns_ = nullptr;
    const Pseudonormals* normals_ = nullptr;
    BandWidth width_;
};

}
