#include "alcove/grid/band.h"

#include "alcove/parallel.h"

#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace alcove {
namespace {

using openvdb::Coord;
using openvdb::FloatTree;
using openvdb::Int32Tree;
using openvdb::MaskTree;
using MaskLeaf = MaskTree::LeafNodeType;

constexpr int leaf_size = 8;
constexpr int apron_size = leaf_size + 2;
constexpr int apron_volume = apron_size * apron_size * apron_size;
constexpr int no_triangle = -1;
static_assert(MaskLeaf::DIM == leaf_size);

int apron_index(int x, int y, int z) {
    return (x * apron_size + y) * apron_size + z;
}

/// The nearest triangles of a leaf's voxels and of one more layer around it.
std::array<int, apron_volume> apron(const openvdb::tree::ValueAccessor<const Int32Tree>& nearest,
                                    const Coord& origin) {
    std::array<int, apron_volume> around;
    around.fill(no_triangle);
    const auto range = [](int side) { // of local coordinates that a neighbouring leaf covers
        return side < 0   ? std::pair{-1, 0}
               : side > 0 ? std::pair{leaf_size, leaf_size + 1}
                          : std::pair{0, leaf_size};
    };
    for (int sx = -1; sx <= 1; ++sx)
        for (int sy = -1; sy <= 1; ++sy)
            for (int sz = -1; sz <= 1; ++sz) {
                const Coord neighbour = origin.offsetBy(sx * leaf_size, sy * leaf_size, sz * leaf_size);
                const auto* leaf = nearest.probeConstLeaf(neighbour);
                if (!leaf)
                    continue;
                const auto [x0, x1] = range(sx);
                const auto [y0, y1] = range(sy);
                const auto [z0, z1] = range(sz);
                for (int x = x0; x < x1; ++x)
                    for (int y = y0; y < y1; ++y)
                        for (int z = z0; z < z1; ++z) {
                            const auto n = Int32Tree::LeafNodeType::coordToOffset(Coord(x, y, z));
                            if (leaf->isValueOn(n))
                                around[static_cast<std::size_t>(apron_index(x + 1, y + 1, z + 1))] =
                                    leaf->getValue(n);
                        }
            }
    return around;
}

struct Found {
    int triangle;
    float distance; // voxels
};

}

Band::Band(const Surface& surface, int stride, Int32Tree::Ptr nearest, BandWidth width)
    : surface_(&surface), stride_(stride), nearest_(std::move(nearest)),
      distance_(std::make_shared<FloatTree>(0.0f)) {
    grow(width);
}

void Band::evaluate(const MaskTree& targets, BandWidth width, MaskTree& accepted) {
    std::vector<const MaskLeaf*> leaves;
    targets.getNodes(leaves);
    std::vector<std::vector<Found>> found(leaves.size());
    parallel_for(leaves.size(), 4, [&](std::size_t begin, std::size_t end) {
        openvdb::tree::ValueAccessor<const Int32Tree> nearest(*nearest_);
        for (std::size_t l = begin; l < end; ++l) {
            const auto around = apron(nearest, leaves[l]->origin());
            found[l].reserve(leaves[l]->onVoxelCount());
            for (auto voxel = leaves[l]->beginValueOn(); voxel; ++voxel) {
                const Coord at = voxel.getCoord(), local = at - leaves[l]->origin();
                const Vec3d p = double(stride_) * Vec3d(at.x(), at.y(), at.z());
                std::array<int, 27> tried;
                std::size_t tries = 0;
                double best2 = std::numeric_limits<double>::infinity();
                int best = no_triangle;
                for (int x = 0; x < 3; ++x)
                    for (int y = 0; y < 3; ++y)
                        for (int z = 0; z < 3; ++z) {
                            const int t = around[static_cast<std::size_t>(
                                apron_index(local.x() + x, local.y() + y, local.z() + z))];
                            if (t == no_triangle ||
                                std::find(tried.begin(), tried.begin() + tries, t) != tried.begin() + tries)
                                continue;
                            tried[tries++] = t;
                            const double d2 = surface_->distance2(static_cast<std::size_t>(t), p);
                            if (d2 < best2 || (d2 == best2 && t < best)) {
                                best2 = d2;
                                best = t;
                            }
                        }
                if (best == no_triangle) {
                    found[l].push_back({no_triangle, 0.0f});
                    continue;
                }
                best = static_cast<int>(surface_->descend(static_cast<std::size_t>(best), p));
                const ClosestPoint point = surface_->closest(static_cast<std::size_t>(best), p);
                const auto distance = static_cast<float>(std::sqrt(point.distance2) / stride_);
                found[l].push_back({best, point.side < 0.0 ? -distance : distance});
            }
        }
    });
    for (std::size_t l = 0; l < leaves.size(); ++l) {
        auto* nearest = nearest_->touchLeaf(leaves[l]->origin());
        auto* distance = distance_->touchLeaf(leaves[l]->origin());
        MaskLeaf* kept = nullptr;
        std::size_t i = 0;
        for (auto voxel = leaves[l]->beginValueOn(); voxel; ++voxel, ++i) {
            const auto [triangle, d] = found[l][i];
            if (triangle == no_triangle || d > width.outer || d < -width.inner)
                continue;
            if (!kept)
                kept = accepted.touchLeaf(leaves[l]->origin());
            kept->setValueOn(voxel.pos());
            nearest->setValueOn(voxel.pos(), triangle);
            distance->setValueOn(voxel.pos(), d);
        }
    }
}

void Band::grow(BandWidth width) {
    const auto dilate = [](MaskTree& mask) {
        openvdb::tools::dilateActiveValues(mask, 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                           openvdb::tools::IGNORE_TILES);
    };
    MaskTree seen(*nearest_, false, openvdb::TopologyCopy());
    dilate(seen);
    MaskTree targets(seen), frontier;
    while (targets.leafCount() > 0) {
        frontier.clear();
        evaluate(targets, width, frontier);
        targets.clear();
        targets.topologyUnion(frontier);
        dilate(targets);
        targets.topologyDifference(seen);
        openvdb::tools::pruneInactive(targets);
        seen.topologyUnion(targets);
    }
    // Once more over all of it: neighbours found later may know a nearer triangle.
    MaskTree all(*distance_, false, openvdb::TopologyCopy());
    evaluate(all, {2.0f * width.outer, 2.0f * width.inner}, frontier);
}

Band Band::coarser(BandWidth width) const {
    auto seeds = std::make_shared<Int32Tree>(no_triangle);
    openvdb::tree::ValueAccessor<Int32Tree> writer(*seeds);
    for (auto leaf = nearest_->cbeginLeaf(); leaf; ++leaf)
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            const Coord at = voxel.getCoord();
            if (((at.x() | at.y() | at.z()) & 1) == 0)
                writer.setValueOn(Coord(at.x() >> 1, at.y() >> 1, at.z() >> 1), *voxel);
        }
    return Band(*surface_, 2 * stride_, std::move(seeds), width);
}

bool Band::crossed(const openvdb::tree::ValueAccessor<const FloatTree>& distance, const Coord& behind) const {
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                float other;
                if (distance.probeValue(behind.offsetBy(x, y, z), other) && other >= 0.0f &&
                    other < sheet_thickness)
                    return true;
            }
    return false;
}

openvdb::FloatGrid::Ptr Band::level_set(Sign sign, BandWidth width, double value_scale) const {
    const auto scaled = [&](float voxels) { return static_cast<float>(voxels * value_scale); };
    auto tree = std::make_shared<FloatTree>(scaled(width.outer));
    std::vector<const FloatTree::LeafNodeType*> leaves;
    distance_->getNodes(leaves);
    const openvdb::tree::ValueAccessor<const FloatTree> distance(*distance_);
    for (const auto* leaf : leaves) {
        FloatTree::LeafNodeType* out = nullptr;
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            float d = *voxel;
            if (sign == Sign::sheet && d < 0.0f &&
                (d <= -sheet_thickness || !crossed(distance, voxel.getCoord())))
                d = -d;
            if (d > width.outer || d < -width.inner)
                continue;
            if (!out)
                out = tree->touchLeaf(leaf->origin());
            out->setValueOn(voxel.pos(), scaled(d));
        }
    }
    if (sign == Sign::solid)
        openvdb::tools::signedFloodFillWithValues(*tree, scaled(width.outer), scaled(-width.inner));
    auto grid = openvdb::FloatGrid::create(tree);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

double contradictions(const openvdb::FloatGrid& solid) {
    std::vector<const FloatTree::LeafNodeType*> leaves;
    solid.tree().getNodes(leaves);
    std::atomic<std::size_t> crossings{0}, false_crossings{0};
    parallel_for(leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
        const auto values = solid.getConstAccessor();
        std::size_t crossed = 0, wrong = 0;
        for (std::size_t l = begin; l < end; ++l)
            for (auto voxel = leaves[l]->cbeginValueAll(); voxel; ++voxel)
                for (int face = 0; face < 6; ++face) {
                    Coord next = voxel.getCoord();
                    next[face / 2] += face % 2 ? 1 : -1;
                    const float other = values.getValue(next);
                    if ((other < 0.0f) == (*voxel < 0.0f))
                        continue;
                    ++crossed;
                    wrong += std::fabs(other) + std::fabs(*voxel) > 1.1f;
                }
        crossings += crossed;
        false_crossings += wrong;
    });
    return crossings == 0 ? 0.0 : static_cast<double>(false_crossings) / static_cast<double>(crossings);
}

}
