#include "alcove/grid/detail/band.h"

#include "alcove/base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace alcove {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// Appends the sub-blocks of side `smallest` that have nodes, each with its nodes.
void descend(const TriangleTree& tree, BandBlock from, Block block, int smallest, float reach,
             std::vector<BandBlock>& out) {
    check_cancelled();
    if (block.size == smallest) {
        out.push_back(std::move(from));
        return;
    }
    std::array<Nodes, 8> parts;
    split(tree, from.nodes, block, reach, parts);
    block.size /= 2;
    for (int i = 0; i < 8; ++i)
        if (auto& part = parts[static_cast<std::size_t>(i)]; !part.empty()) {
            block.low = from.low + block.size * Index3(i >> 2, i >> 1 & 1, i & 1);
            descend(tree, {block.low, std::move(part)}, block, smallest, reach, out);
        }
}

/// The side of a block that contains the whole band.
int size_around(const TriangleTree& tree, int stride, float reach) {
    float extent = 0.0f;
    for (std::uint32_t node = tree.top(); node < tree.nodes.size() && tree.nodes[node].radius >= 0.0f; ++node) {
        const Bounds& b = tree.nodes[node];
        extent = std::max({extent, b.centre.x + b.radius + b.thickness, b.centre.y + b.radius + b.thickness,
                           b.centre.z + b.radius + b.thickness});
    }
    int size = brick_size;
    while (static_cast<float>(size) * static_cast<float>(stride) < extent + reach + 1.0f)
        size *= 2;
    return size;
}

}

Nodes Band::all_nodes() const {
    Nodes nodes;
    for (std::uint32_t node = tree_->top(); node < tree_->nodes.size(); ++node)
        nodes.push_back(node);
    return nodes;
}

std::vector<BandBlock> Band::blocks(int stride) const {
    const float reach = width_.outer * static_cast<float>(stride);
    const int size = size_around(*tree_, stride, reach), task = std::min(size, 8 * brick_size);
    std::vector<BandBlock> tasks;
    descend(*tree_, {Index3(0), all_nodes()}, {Index3(0), size, stride}, task, reach, tasks);
    std::vector<std::vector<BandBlock>> found(tasks.size());
    parallel_for(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Block block{tasks[i].low, task, stride};
            descend(*tree_, std::move(tasks[i]), block, brick_size, reach, found[i]);
        }
    });
    std::vector<BandBlock> all;
    for (auto& blocks : found)
        std::move(blocks.begin(), blocks.end(), std::back_inserter(all));
    return all;
}

BandBrick Band::brick(const BandBlock& block, int stride, std::span<const float, brick_volume> known) const {
    const auto units = static_cast<float>(stride), per_unit = 1.0f / units;
    const Block at{block.low, brick_size, stride};
    std::array<std::uint8_t, brick_rows> inside{};
    if (columns_)
        inside = columns_->inside(at);
    NearestTriangles nearest;
    for (std::size_t voxel = 0; voxel < brick_volume; ++voxel) {
        const float distance = units * known[voxel];
        // The sign of a sheet needs the nearest triangle, so search again where it may be negative.
        const bool reuse = !normals_ || known[voxel] > sheet_thickness;
        nearest.distance2[voxel] = reuse ? distance * distance : infinite;
    }
    nearest_triangles(*tree_, block.nodes, at, {inside.data(), width_.outer * units, width_.inner * units}, nearest);

    BandBrick brick;
    std::copy_n(nearest.triangle, brick_volume, brick.triangle.begin());
    for (std::size_t row = 0; row < brick_rows; ++row) {
        const std::size_t first = row * brick_size;
        float distances[brick_size];
        for (std::size_t z = 0; z < brick_size; ++z)
            distances[z] = std::sqrt(nearest.distance2[first + z]) * per_unit;
        unsigned active = 0;
        for (std::size_t z = 0; z < brick_size; ++z) {
            const float width = (inside[row] >> z & 1) != 0 ? -width_.inner : width_.outer;
            active |= unsigned{distances[z] <= std::fabs(width)} << z;
            brick.values[first + z] = std::copysign(std::min(distances[z], std::fabs(width)), width);
        }
        brick.active[row / brick_size] |= std::uint64_t{active} << row % brick_size * brick_size;
        brick.count += static_cast<std::size_t>(std::popcount(active));
    }
    if (normals_)
        for (std::size_t voxel = 0; voxel < brick_volume; ++voxel)
            if (float& distance = brick.values[voxel]; distance < sheet_thickness) { // all are still positive
                const auto i = static_cast<int>(voxel);
                const Index3 p = stride * (block.low + Index3(i / (brick_size * brick_size),
                                                              i / brick_size % brick_size, i % brick_size));
                if (normals_->side(nearest.triangle[voxel], Vec3d(p)) < 0.0)
                    distance = -distance;
            }
    return brick;
}

}
