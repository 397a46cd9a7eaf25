#include "alcove/vdb/detail/join.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/vdb/detail/foreign.h"

#include <fmt/format.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;
using Matrix = openvdb::math::Mat4d; // for row vectors

Matrix matrix_of(const openvdb::math::Transform& transform) {
    return transform.baseMap()->getAffineMap()->getMat4();
}

double smallest_edge(const FloatGrid& grid) {
    const openvdb::Vec3d edges = grid.voxelSize();
    return std::min({edges.x(), edges.y(), edges.z()});
}

/// Converts between the voxel coordinates of a lattice and those of a grid.
class Among {
  public:
    Among(const FloatGrid& grid, const openvdb::math::Transform& lattice)
        : to_grid_(matrix_of(lattice) * matrix_of(grid.transform()).inverse()) {
        constexpr double tolerance = 1e-5;
        on_voxels_ = std::fabs(std::fabs(to_grid_.det()) - 1.0) < tolerance;
        Matrix whole = to_grid_;
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 3; ++column) {
                whole(row, column) = std::round(to_grid_(row, column));
                on_voxels_ = on_voxels_ && std::fabs(whole(row, column) - to_grid_(row, column)) < tolerance;
            }
        if (on_voxels_)
            to_grid_ = whole;
        from_grid_ = to_grid_.inverse();
    }
    /// Whether each voxel of the lattice coincides with a voxel of the grid.
    bool on_voxels() const { return on_voxels_; }
    openvdb::Vec3d to_grid(const openvdb::Vec3d& at) const { return to_grid_.transform(at); }
    /// The box of lattice voxels that encloses a box of the grid.
    openvdb::CoordBBox from_grid(const openvdb::CoordBBox& box) const {
        openvdb::BBoxd bounds;
        for (int corner = 0; corner < 8; ++corner)
            bounds.expand(from_grid_.transform(openvdb::Vec3d((corner & 1 ? box.max() : box.min()).x(),
                                                              (corner & 2 ? box.max() : box.min()).y(),
                                                              (corner & 4 ? box.max() : box.min()).z())));
        return {Coord::floor(bounds.min()), Coord::ceil(bounds.max())};
    }

  private:
    Matrix to_grid_, from_grid_;
    bool on_voxels_;
};

float sampled(const FloatGrid::ConstAccessor& reader, const openvdb::Vec3d& at) {
    float value = 0.0f;
    openvdb::tools::BoxSampler::sample(reader, at, value);
    return value;
}

/// The widths of a band on both sides of the surface, scene units.
struct Widths {
    float outer, inner;

    bool contain(float value) const { return value < outer && value > -inner; }
};

/// Creates the leaves of `tree` that may have distances within the band.
void create_leaves(const FloatGrid& grid, const Among& among, const Widths& band, float voxel, FloatTree& tree) {
    const float farthest =
        std::max(band.outer, band.inner) + 0.87f * float(Leaf::DIM) * voxel; // distance of the centre of such a leaf
    const auto reader = grid.getConstAccessor();
    FloatGrid::Accessor writer(tree);
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        openvdb::CoordBBox around = leaf->getNodeBoundingBox();
        around.expand(1); // because values are interpolated up to the next voxel
        const openvdb::CoordBBox box = among.from_grid(around);
        const Coord low = box.min() & ~(int(Leaf::DIM) - 1);
        for (int x = low.x(); x <= box.max().x(); x += Leaf::DIM)
            for (int y = low.y(); y <= box.max().y(); y += Leaf::DIM)
                for (int z = low.z(); z <= box.max().z(); z += Leaf::DIM)
                    if (const openvdb::Vec3d middle(x + 3.5, y + 3.5, z + 3.5);
                        std::fabs(sampled(reader, among.to_grid(middle))) <= farthest)
                        writer.touchLeaf({x, y, z});
    }
}

FloatGrid::Ptr interpolated(const FloatGrid& grid, const openvdb::math::Transform::Ptr& lattice, const Widths& band) {
    const Among among(grid, *lattice);
    auto tree = std::make_shared<FloatTree>(band.outer);
    create_leaves(grid, among, band, static_cast<float>(lattice->voxelSize().x()), *tree);
    std::vector<Leaf*> leaves;
    tree->getNodes(leaves);
    parallel_for(leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
        const auto reader = grid.getConstAccessor();
        for (std::size_t l = begin; l < end; ++l)
            for (openvdb::Index v = 0; v < Leaf::SIZE; ++v) {
                const Coord at = leaves[l]->offsetToGlobalCoord(v);
                const float value = among.on_voxels() ? reader.getValue(Coord::round(among.to_grid(at.asVec3d())))
                                                      : sampled(reader, among.to_grid(at.asVec3d()));
                leaves[l]->setValueOnly(v, std::clamp(value, -band.inner, band.outer));
                leaves[l]->setActiveState(v, band.contain(value));
            }
    });
    openvdb::tools::pruneInactive(*tree);
    openvdb::tools::signedFloodFillWithValues(*tree, band.outer, -band.inner);
    auto result = FloatGrid::create(tree);
    result->setTransform(lattice);
    return result;
}

FloatGrid::Ptr voxelized(const FloatGrid::Ptr& grid, const openvdb::math::Transform::Ptr& lattice,
                         double memory_limit) {
    const Mesh surface = mesh_zero_surface(VdbGrid{grid});
    if (!closedness(surface).closed())
        throw InputError(fmt::format("grid '{}' cannot be voxelized again, because its surface is open: resample it to "
                                     "cubic voxels, with a band at least 3 voxels wide",
                                     grid->getName()));
    const openvdb::Vec3d origin = lattice->indexToWorld(openvdb::Vec3d(0.0));
    VoxelizeOptions options;
    options.sign = SignChoice::solid;
    options.grid.lattice = {lattice->voxelSize().x(), {origin.x(), origin.y(), origin.z()}};
    options.grid.radius = static_cast<float>(options.grid.lattice->voxel / frame_of(surface.box()).diagonal);
    options.grid.inner_band = options.grid.outer_band;
    options.grid.memory_limit = memory_limit;
    const GridStack stack = [&] {
        try {
            return voxelize(surface, triangulate(surface).triangles, options);
        } catch (const LimitError&) {
            throw LimitError(
                fmt::format("grid '{}' needs more than the limit of {} GB to be voxelized again with cubic "
                            "voxels of {:.4g}: resample it to larger cubic voxels",
                            grid->getName(), rounded(memory_limit / 1e9, 2), options.grid.lattice->voxel));
        }
    }();
    auto result = stack.levels.front().grid->grid;
    scale_values(*result, stack.value_unit);
    result->setTransform(lattice);
    return result;
}

/// How a grid is transferred to the lattice.
struct Move {
    FloatGrid::Ptr grid;
    bool voxelize; ///< voxelize its surface again instead of interpolating its values
    Widths band;   ///< in which distances are correct afterwards
};

Move plan_move(const FloatGrid::Ptr& grid, const openvdb::math::Transform& lattice) {
    const auto voxel = static_cast<float>(lattice.voxelSize().x()), own = static_cast<float>(grid->voxelSize().x());
    Widths band{grid->background(), inner_band_of({grid})};
    // Values are interpolated from voxels up to √3 voxels away; the last voxel of a band is never relied on.
    const bool copied = Among(*grid, lattice).on_voxels();
    const float lost = copied ? 0.0f : 0.75f * own;
    band = {band.outer - lost, band.inner - lost};
    const bool thin = band.outer < 2.0f * own || band.inner < own;
    if (!has_cubes({grid}) || (thin && !copied)) {
        const float width = GridOptions{}.outer_band * voxel;
        return {grid, true, {width, width}};
    }
    return {grid, false, band};
}

/// Makes the voxels outside the band inactive, with the constant value of their side.
void trim(FloatGrid& grid, const Widths& band) {
    std::vector<Leaf*> leaves;
    grid.tree().getNodes(leaves);
    parallel_for(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t l = begin; l < end; ++l)
            for (openvdb::Index v = 0; v < Leaf::SIZE; ++v)
                if (!band.contain(leaves[l]->getValue(v)))
                    leaves[l]->setActiveState(v, false);
    });
    grid.tree().root().setBackground(band.outer, /*updateChildNodes=*/false);
    openvdb::tools::pruneInactive(grid.tree());
    openvdb::tools::signedFloodFillWithValues(grid.tree(), band.outer, -band.inner);
}

openvdb::math::Transform::Ptr lattice_of(const VdbGrid& finest) {
    const openvdb::math::Transform& own = finest.grid->transform();
    if (is_aligned(finest))
        return own.copy();
    auto lattice = openvdb::math::Transform::createLinearTransform(smallest_edge(*finest.grid));
    lattice->postTranslate(own.indexToWorld(openvdb::Vec3d(0.0)));
    return lattice;
}

/// Estimates the memory of the interpolated grids before any of them is made. \throw LimitError beyond `limit`, in
/// bytes.
void check_memory(const std::vector<Move>& moves, const Widths& band, double voxel, double limit) {
    constexpr double bytes_per_voxel = 60.0; // including the bricks of the field
    double bytes = 0.0;
    for (const Move& move : moves)
        if (!move.voxelize)
            bytes += bytes_per_voxel * static_cast<double>(move.grid->activeVoxelCount()) *
                     std::pow(smallest_edge(*move.grid) / voxel, 3) * double(band.outer / move.grid->background());
    if (bytes > limit)
        throw LimitError(
            fmt::format("its {} on one lattice with voxels of {:.4g} need about {} GB, over the limit of {} "
                        "GB: resample to larger voxels{}",
                        moves.size() == 1 ? "grid" : "grids", voxel, rounded(bytes / 1e9, 2), rounded(limit / 1e9, 2),
                        moves.size() == 1 ? "" : ", or choose with --grid-name"));
}

}

bool has_cubes(const VdbGrid& grid) {
    const Matrix map = matrix_of(grid.grid->transform());
    const double size = smallest_edge(*grid.grid), tolerance = 1e-5 * size * size; // for matrices that come from floats
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            double product = 0.0;
            for (int axis = 0; axis < 3; ++axis)
                product += map(a, axis) * map(b, axis);
            if (!(std::fabs(product - (a == b ? size * size : 0.0)) <= tolerance))
                return false;
        }
    return true;
}

bool is_aligned(const VdbGrid& grid) {
    const Matrix map = matrix_of(grid.grid->transform());
    const double size = map(0, 0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (!(std::fabs(map(row, column) - (row == column ? size : 0.0)) <= 1e-6 * std::fabs(size)))
                return false;
    return size > 0.0;
}

VdbGrid join(const std::vector<VdbGrid>& solids, double memory_limit, std::vector<std::string>& warnings) {
    const auto finest = std::min_element(solids.begin(), solids.end(), [](const VdbGrid& a, const VdbGrid& b) {
        return smallest_edge(*a.grid) < smallest_edge(*b.grid);
    });
    const openvdb::math::Transform::Ptr lattice = lattice_of(*finest);
    if (solids.size() == 1 && is_aligned(*finest))
        return *finest;
    std::vector<Move> moves;
    constexpr float any = std::numeric_limits<float>::infinity();
    Widths band{any, any};
    for (const VdbGrid& solid : solids) {
        moves.push_back(plan_move(solid.grid, *lattice));
        band = {std::min(band.outer, moves.back().band.outer), std::min(band.inner, moves.back().band.inner)};
    }
    check_memory(moves, band, lattice->voxelSize().x(), memory_limit);
    FloatGrid::Ptr all;
    for (const Move& move : moves) {
        FloatGrid::Ptr placed =
            move.voxelize ? voxelized(move.grid, lattice, memory_limit) : interpolated(*move.grid, lattice, band);
        trim(*placed, band);
        if (all)
            openvdb::tools::csgUnion(*all, *placed);
        else
            all = placed;
        if (!move.voxelize)
            continue;
        const openvdb::Vec3d edges = move.grid->voxelSize();
        warnings.push_back(fmt::format(
            "grid '{}' has {}: its surface is voxelized again with cubic voxels of {:.4g}",
            in_one_line(move.grid->getName()),
            has_cubes({move.grid}) ? fmt::format("a band of only {:.3g} voxels", move.grid->background() / edges.x())
                                   : fmt::format("voxels of {:.4g} x {:.4g} x {:.4g}, which are not cubes", edges.x(),
                                                 edges.y(), edges.z()),
            lattice->voxelSize().x()));
    }
    all->setGridClass(openvdb::GRID_LEVEL_SET); // determines the orientation of faces
    all->setName(finest->grid->getName());
    all->setCreator(finest->grid->getCreator());
    return {all};
}

}
