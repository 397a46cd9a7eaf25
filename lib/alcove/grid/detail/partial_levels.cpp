#include "alcove/grid/detail/partial_levels.h"

#include "alcove/base/detail/duplicate_faces.h"
#include "alcove/base/parallel.h"
#include "alcove/grid/detail/plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace alcove {
namespace {

constexpr double around = 1.5; // the distance around unresolved voxels, in voxels of the finest whole level

using Bricks = std::vector<Index3>; // the lowest voxel of each brick, sorted, without duplicates

bool before(const Index3& a, const Index3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

void sort_unique(Bricks& bricks) {
    std::sort(bricks.begin(), bricks.end(), before);
    bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
}

/// The bricks around `voxels` on a level whose voxels are `finer` times smaller. The last layer of cells in a brick
/// needs the next bricks, so those are added, too.
Bricks bricks_around(std::span<const Index3> voxels, int finer) {
    Bricks bricks;
    for (const Index3& v : voxels) {
        const Vec3d low = (Vec3d(v) - around) * double(finer) / double(brick_size),
                    high = (Vec3d(v) + around) * double(finer) / double(brick_size);
        const Index3 first = glm::max(Index3(glm::floor(low)), Index3(0)), last(glm::floor(high));
        for (int x = first.x; x <= last.x; ++x)
            for (int y = first.y; y <= last.y; ++y)
                for (int z = first.z; z <= last.z; ++z)
                    if (const Index3 brick = brick_size * Index3(x, y, z); bricks.empty() || bricks.back() != brick)
                        bricks.push_back(brick);
    }
    sort_unique(bricks);
    const std::size_t count = bricks.size();
    for (std::size_t i = 0; i < count; ++i)
        for (int next = 1; next < 8; ++next)
            bricks.push_back(bricks[i] + brick_size * Index3(next >> 2, next >> 1 & 1, next & 1));
    sort_unique(bricks);
    return bricks;
}

/// Whether the index of the field over the box of all bricks stays small.
bool are_compact(const Bricks& bricks) {
    constexpr double most_slots = 1 << 23;
    Index3 low = bricks.front(), high = low;
    for (const Index3& brick : bricks) {
        low = glm::min(low, brick);
        high = glm::max(high, brick);
    }
    double slots = 1.0;
    for (int axis = 0; axis < 3; ++axis)
        slots *= (high[axis] - low[axis]) / brick_size + 4;
    return slots <= most_slots;
}

/// Marks the cubes of `side_` voxels of the finest whole level, or the columns of such cubes along z, that boxes touch.
class Cells {
  public:
    Cells(const Index3& size, bool flat) : flat_(flat) {
        constexpr std::size_t most = std::size_t{1} << 24;
        std::size_t count = 0;
        do {
            side_ *= 2;
            size_ = size / side_ + 2;
            count = static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                    (flat ? 1 : static_cast<std::size_t>(size_.z));
        } while (count > most);
        marked_.assign(count, 0);
    }

    /// Marks all cells that a box touches.
    void mark(const Vec3d& low, const Vec3d& high) {
        any_of(low, high, [&](std::size_t cell) {
            marked_[cell] = 1;
            return false;
        });
    }
    bool touches(const Vec3d& low, const Vec3d& high) const {
        return any_of(low, high, [&](std::size_t cell) { return marked_[cell] != 0; });
    }

  private:
    template <class Test>
    bool any_of(const Vec3d& low, const Vec3d& high, const Test& test) const {
        const Index3 first = glm::clamp(Index3(glm::floor(low / double(side_))), Index3(0), size_ - 1),
                     last = glm::clamp(Index3(glm::floor(high / double(side_))), Index3(0), size_ - 1);
        for (int x = first.x; x <= last.x; ++x)
            for (int y = first.y; y <= last.y; ++y)
                for (int z = flat_ ? 0 : first.z; z <= (flat_ ? 0 : last.z); ++z)
                    if (test((static_cast<std::size_t>(x) * static_cast<std::size_t>(size_.y) +
                              static_cast<std::size_t>(y)) *
                                 (flat_ ? 1 : static_cast<std::size_t>(size_.z)) +
                             static_cast<std::size_t>(z)))
                        return true;
        return false;
    }

    bool flat_; // columns along z
    int side_ = 2;
    Index3 size_{1};
    std::vector<std::uint8_t> marked_;
};

/// The triangles whose boxes touch marked cells.
std::vector<Triangle> touching(const Surface& surface, const Cells& cells) {
    std::vector<Triangle> found;
    for (const Triangle& t : surface.triangles) {
        const Vec3d &a = surface.positions[t[0]], &b = surface.positions[t[1]], &c = surface.positions[t[2]];
        if (cells.touches(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))))
            found.push_back(t);
    }
    return found;
}

/// Bytes for the search for nearest triangles, for the positions, and for the crossings of columns that are 1 /
/// `finest` voxels apart.
double bytes_to_build(const Surface& surface, std::span<const Triangle> nearest, std::span<const Triangle> crossed,
                      int finest) {
    constexpr double bytes_per_crossing = 60.0;
    double columns = 0.0;
    for (const auto& [a, b, c] : crossed)
        columns +=
            0.5 *
            std::fabs(
                glm::cross(surface.positions[b] - surface.positions[a], surface.positions[c] - surface.positions[a]).z);
    return bytes_per_triangle * static_cast<double>(nearest.size()) +
           static_cast<double>(sizeof(Vec3d) * surface.positions.size()) +
           bytes_per_crossing * columns * finest * finest;
}

/// The blocks of `bricks`, with the tree nodes near them.
std::vector<BandBlock> blocks_of(const Band& band, const Bricks& bricks, int stride) {
    std::vector<BandBlock> blocks;
    std::vector<std::uint8_t> found(bricks.size(), 0);
    for (BandBlock& block : band.blocks(stride)) {
        const auto brick = std::lower_bound(bricks.begin(), bricks.end(), block.low, before);
        if (brick == bricks.end() || *brick != block.low)
            continue;
        found[static_cast<std::size_t>(brick - bricks.begin())] = 1;
        blocks.push_back(std::move(block));
    }
    for (std::size_t i = 0; i < bricks.size(); ++i)
        if (!found[i]) // no triangle is near, but whether the brick is inside must be known
            blocks.push_back({bricks[i], band.all_nodes()});
    return blocks;
}

}

std::vector<LevelSet> partial_levels(const UnresolvedVoxels& unresolved, const PartialLevelsSource& source) {
    std::vector<Bricks> bricks; // of the levels with half and with a quarter of the voxel
    std::size_t count = 0;
    int finer = 2;
    for (const std::vector<Index3>* voxels : {&unresolved.below_two, &unresolved.below_one}) {
        if (voxels->empty())
            break;
        Bricks level = bricks_around(*voxels, finer);
        count += level.size();
        if (count > source.max_bricks || !are_compact(level))
            break;
        bricks.push_back(std::move(level));
        finer *= 2;
    }
    if (bricks.empty())
        return {};

    Vec3d extent(0.0);
    for (const Triangle& t : source.surface.triangles)
        for (const std::uint32_t v : t)
            extent = glm::max(extent, source.surface.positions[v]);
    Cells near(Index3(extent), false), columns_near(Index3(extent), true);
    for (const Index3& brick : bricks.front()) {
        const Vec3d low = 0.5 * Vec3d(brick), high = low + 0.5 * brick_size;
        const double reach = 0.5 * double(source.width.outer) + 1.0;
        near.mark(low - reach, high + reach);
        columns_near.mark(low - 1.0, high + 1.0);
    }
    const std::vector<Triangle> triangles = touching(source.surface, near);
    const int finest = finer / 2;
    const std::vector<Triangle> crossed =
        source.sign == Sign::solid ? touching(source.surface, columns_near) : std::vector<Triangle>();
    if (bytes_to_build(source.surface, triangles, crossed, finest) > source.max_bytes)
        return {};
    HugeVector<Vec3d> positions(source.surface.positions.size());
    parallel_for(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            positions[v] = double(finest) * source.surface.positions[v];
    });
    std::optional<WindingColumns> columns;
    std::optional<Pseudonormals> normals;
    std::vector<Triangle> single;
    if (source.sign == Sign::solid)
        columns.emplace(positions, crossed);
    else
        single = without_duplicate_faces<Vec3d>(positions, triangles);
    const std::vector<Triangle>& nearest = source.sign == Sign::solid ? triangles : single;
    const FragmentLeaves fragments(positions, nearest);
    if (fragments.count() == 0)
        return {};
    const TriangleTree tree(fragments);
    if (source.sign == Sign::sheet)
        normals.emplace(positions, nearest);
    const Band band = normals ? Band(tree, *normals, source.width.outer) : Band(tree, *columns, source.width);

    std::vector<LevelSet> levels;
    for (std::size_t i = bricks.size(); i-- > 0;) {
        const int stride = finest >> (i + 1);
        const double voxel = std::ldexp(source.voxel, -static_cast<int>(i) - 1);
        LevelSet level = partial_level_set(band, blocks_of(band, bricks[i], stride), stride,
                                           std::ldexp(source.value_scale, -static_cast<int>(i) - 1));
        level.voxel = voxel;
        level.origin = source.origin;
        level.outer_band = source.width.outer;
        level.inner_band = source.width.inner;
        levels.push_back(std::move(level));
    }
    return levels;
}

}
