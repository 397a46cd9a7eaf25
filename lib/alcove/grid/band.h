/// A narrow band being built: for every voxel near the surface its nearest triangle and signed distance.
/// Internal to grid/: includes OpenVDB.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/grid/surface.h"
#include "alcove/grid/vdb.h"

#include <cstddef>

namespace alcove {

/// Further than this, in voxels, nothing behind a face of a sheet is negative: no corner of a cell that a face
/// passes through is further from it than √3.
inline constexpr float sheet_thickness = 1.75f;

struct BandWidth {
    float outer = 0.0f; ///< voxels
    float inner = 0.0f; ///< voxels; the same as outer for sheets
};

/// Grown outward from voxels next to the surface, a layer a round: a voxel's nearest triangle is looked for
/// among those of its 26 neighbours and evaluated exactly. What a round reads is never what it writes, so the
/// result does not depend on the number of threads.
class Band {
  public:
    /// `nearest` holds the index of a near triangle at its active voxels, at least all those within half a
    /// voxel of the surface. A voxel of this band is `stride` of the surface's units wide.
    Band(const Surface& surface, int stride, openvdb::Int32Tree::Ptr nearest, BandWidth width);

    /// Grows the band further.
    void widen(BandWidth width) { grow(width); }

    /// The band of twice the voxel: seeded from this one, then grown to the same width in its own voxels.
    Band coarser(BandWidth width) const;

    /// The level set of this band: values times `value_scale`, inside filled for solids.
    openvdb::FloatGrid::Ptr level_set(Sign sign, BandWidth width, double value_scale) const;

  private:
    void evaluate(const openvdb::MaskTree& targets, BandWidth width, openvdb::MaskTree& accepted);
    void grow(BandWidth width);
    /// Whether the voxel behind a face is a corner of a cell that the face passes through.
    bool crossed(const openvdb::tree::ValueAccessor<const openvdb::FloatTree>& distance,
                 const openvdb::Coord& behind) const;

    const Surface* surface_;
    int stride_;
    openvdb::Int32Tree::Ptr nearest_;
    openvdb::FloatTree::Ptr distance_; // in voxels; the topology of nearest_
};

/// The share of sign changes between neighbouring voxels that no surface lies between, for a surface between
/// two voxels is no further than a voxel from both together: 0 for a solid, large where the surface is open,
/// nested, inside out or overlaps itself. Reads every active voxel and its neighbours, filled inside
/// included.
double contradictions(const openvdb::FloatGrid& solid);

}
