/// The narrow band around a surface, brick after brick. Internal to grid/.
#pragma once

#include "alcove/grid/detail/pseudonormals.h"
#include "alcove/grid/detail/winding.h"
#include "alcove/grid/grid_stack.h"
#include "alcove/nearest/nearest.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// How far behind a face of a sheet its distances are negative, voxels. Well over 1: a face on a plane of the
/// grid then has a whole layer of negative corners behind it, whatever sign rounding gives those on it, and
/// rays cannot step through. Corners of crossed cells can be √3 behind, but those further than this weigh next
/// to nothing where the face is.
inline constexpr float sheet_thickness = 1.5f;

struct BandWidth {
    float outer = 0.0f; ///< voxels
    float inner = 0.0f; ///< voxels; the same as outer for sheets
};

/// A brick that the band may touch and what may be nearest to its voxels.
struct BandBlock {
    Index3 low; ///< a multiple of brick_size
    Nodes nodes;
};

/// Signed distances in voxels, z fastest; ±the width where a voxel is not of the band.
struct BandBrick {
    float values[brick_volume];
    std::uint64_t active[brick_size] = {}; ///< a word an x-slice, a bit a voxel of the band
    std::size_t count = 0;                 ///< voxels of the band
};

/// Distances are exact and no brick depends on another, so all of them can be made at once and levels of any
/// stride from the same tree.
class Band {
  public:
    /// A solid: negative where the winding number is 1 or more.
    Band(const TriangleTree& tree, const WindingColumns& columns, BandWidth width)
        : tree_(&tree), columns_(&columns), width_(width) {}
    /// A sheet: distances up to the width on both sides, negative behind a face up to sheet_thickness.
    Band(const TriangleTree& tree, const Pseudonormals& normals, float width)
        : tree_(&tree), normals_(&normals), width_{width, width} {}

    BandWidth width() const { return width_; }
    Sign sign() const { return columns_ ? Sign::solid : Sign::sheet; }

    /// The bricks of a level whose voxels are `stride` apart in the tree's units, in an order of their own.
    std::vector<BandBlock> blocks(int stride) const;

    /// `known` are distances, voxels, z fastest, that need not be looked for again: none where they are infinite.
    /// Thread-safe.
    BandBrick brick(const BandBlock& block, int stride, std::span<const float, brick_volume> known) const;

  private:
    const TriangleTree* tree_;
    const WindingColumns* columns_ = nullptr;
    const Pseudonormals* normals_ = nullptr;
    BandWidth width_;
};

}
