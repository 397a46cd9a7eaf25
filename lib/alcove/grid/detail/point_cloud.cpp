#include "alcove/grid/detail/point_cloud.h"

#include "alcove/base/detail/morton_sort.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"

#include <glm/vector_relational.hpp>
#include <nanoflann.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

namespace alcove {
namespace {

constexpr std::size_t grain = 4096;
constexpr std::size_t near_count = 6, plane_count = 12; // neighbours for the spacing, and for a normal

struct PointsForTree {
    const std::vector<CloudPoint>& points;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i].position[static_cast<int>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointsForTree>, PointsForTree, 3,
                                                 std::uint32_t>;

/// The nearest neighbours of a point, with the point itself first.
template <std::size_t N>
struct Neighbours {
    std::array<std::uint32_t, N> index;
    std::array<float, N> square; ///< squared distances
    std::size_t count;

    Neighbours(const Tree& tree, const Vec3& position)
        : count(tree.knnSearch(&position.x, N, index.data(), square.data())) {}
};

/// Sorts along a Morton curve and drops points at the position of another.
void sort_and_join(PointCloud& cloud) {
    HugeVector<Keyed<std::uint64_t>> keys(cloud.points.size());
    constexpr double cells = 1 << morton_bits;
    for (std::uint32_t i = 0; i < keys.size(); ++i) {
        const Vec3d cell = glm::clamp((Vec3d(cloud.points[i].position) + 0.5) * cells, Vec3d(0.0), Vec3d(cells - 1.0));
        keys[i] = {morton_code(cell), i};
    }
    radix_sort(keys, 0, 3 * morton_bits);
    // Sorts the points in a cell by their positions, so that equal ones are adjacent.
    for (auto first = keys.begin(); first != keys.end();) {
        const auto end = std::find_if(first, keys.end(), [&](const auto& key) { return key.key != first->key; });
        if (end - first > 1)
            std::sort(first, end, [&](const auto& a, const auto& b) {
                const Vec3 &p = cloud.points[a.value].position, &q = cloud.points[b.value].position;
                return std::tie(p.x, p.y, p.z, a.value) < std::tie(q.x, q.y, q.z, b.value);
            });
        first = end;
    }
    std::vector<CloudPoint> sorted;
    sorted.reserve(keys.size());
    for (const auto& key : keys) {
        const CloudPoint& point = cloud.points[key.value];
        if (!sorted.empty() && sorted.back().position == point.position)
            cloud.duplicates.push_back({point.source, sorted.back().source});
        else
            sorted.push_back(point);
    }
    cloud.points = std::move(sorted);
}

void measure_spacing(PointCloud& cloud, const Tree& tree) {
    parallel_for(cloud.points.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Neighbours<near_count + 1> near(tree, cloud.points[i].position);
            float sum = 0.0f;
            for (std::size_t k = 1; k < near.count; ++k)
                sum += std::sqrt(near.square[k]);
            cloud.points[i].spacing = near.count > 1 ? sum / static_cast<float>(near.count - 1) : 0.0f;
        }
    });
    std::vector<float> all(cloud.points.size());
    std::transform(cloud.points.begin(), cloud.points.end(), all.begin(),
                   [](const CloudPoint& p) { return p.spacing; });
    std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
    cloud.spacing = all[all.size() / 2];
}

/// The direction in which the points vary least; its sign is arbitrary.
Vec3 plane_normal(const PointCloud& cloud, const Neighbours<plane_count + 1>& near) {
    Vec3 mean(0.0f);
    for (std::size_t k = 0; k < near.count; ++k)
        mean += cloud.points[near.index[k]].position;
    mean /= static_cast<float>(near.count);
    Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
    for (std::size_t k = 0; k < near.count; ++k) {
        const Vec3 d = (cloud.points[near.index[k]].position - mean) / cloud.spacing;
        const Eigen::Vector3f v(d.x, d.y, d.z);
        covariance += v * v.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(covariance);
    const Eigen::Vector3f n = solver.eigenvectors().col(0);
    return unit_or_zero(Vec3d(n.x(), n.y(), n.z()));
}

/// Estimates missing normals, and passes their orientation from neighbour to neighbour, the most parallel pairs first.
void estimate_normals(PointCloud& cloud, const Tree& tree) {
    std::vector<std::uint8_t> decided(cloud.points.size(), 1);
    parallel_for(cloud.points.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (cloud.points[i].normal == Vec3(0.0f)) {
                cloud.points[i].normal =
                    plane_normal(cloud, Neighbours<plane_count + 1>(tree, cloud.points[i].position));
                decided[i] = 0;
            }
    });
    cloud.estimated_normals = static_cast<std::size_t>(std::count(decided.begin(), decided.end(), 0));
    if (cloud.estimated_normals == 0)
        return;
    struct Pair {
        float parallel;
        std::uint32_t from, to;
        bool operator<(const Pair& other) const {
            return parallel != other.parallel ? parallel < other.parallel : to > other.to;
        }
    };
    std::priority_queue<Pair> pairs;
    const auto offer = [&](std::uint32_t from) {
        const Neighbours<near_count + 3> near(tree, cloud.points[from].position);
        for (std::size_t k = 1; k < near.count; ++k)
            if (!decided[near.index[k]])
                pairs.push({std::fabs(glm::dot(cloud.points[from].normal, cloud.points[near.index[k]].normal)), from,
                            near.index[k]});
    };
    for (std::uint32_t i = 0; i < decided.size(); ++i)
        if (decided[i])
            offer(i);
    std::vector<std::uint32_t> by_height(cloud.points.size());
    for (std::uint32_t i = 0; i < by_height.size(); ++i)
        by_height[i] = i;
    std::sort(by_height.begin(), by_height.end(), [&](std::uint32_t a, std::uint32_t b) {
        const float za = cloud.points[a].position.z, zb = cloud.points[b].position.z;
        return za != zb ? za > zb : a < b;
    });
    auto highest = by_height.begin();
    while (true) {
        while (!pairs.empty()) {
            const Pair pair = pairs.top();
            pairs.pop();
            if (std::exchange(decided[pair.to], 1))
                continue;
            CloudPoint& point = cloud.points[pair.to];
            if (glm::dot(point.normal, cloud.points[pair.from].normal) < 0.0f)
                point.normal = -point.normal;
            offer(pair.to);
        }
        while (highest != by_height.end() && decided[*highest])
            ++highest;
        if (highest == by_height.end())
            return;
        CloudPoint& point = cloud.points[*highest]; // of the next connected part
        if (point.normal.z < 0.0f)
            point.normal = -point.normal;
        decided[*highest] = 1;
        offer(*highest);
    }
}

/// Whether a point is an outlier, in one of three ways: it is apart from its neighbours and off their tangent planes;
/// it is far from its neighbours and they are off its tangent plane; or it is very far from its neighbours.
bool is_outlier(const PointCloud& cloud, const Tree& tree, const CloudPoint& point) {
    constexpr float apart = 1.4f, far = 2.5f, very_far = 8.0f; // spacings
    constexpr float off_plane = 0.3f, off_planes = 0.6f;       // sines
    if (point.spacing <= apart * cloud.spacing)
        return false;
    if (point.spacing > very_far * cloud.spacing)
        return true;
    const Neighbours<near_count + 1> near(tree, point.position);
    float off_own = 0.0f, off_theirs = 0.0f;
    for (std::size_t k = 1; k < near.count; ++k) {
        const CloudPoint& other = cloud.points[near.index[k]];
        const Vec3 direction = (other.position - point.position) / std::sqrt(near.square[k]);
        off_own += std::fabs(glm::dot(point.normal, direction));
        off_theirs += std::fabs(glm::dot(other.normal, direction));
    }
    const auto count = static_cast<float>(near.count - 1);
    return off_theirs > off_planes * count || (point.spacing > far * cloud.spacing && off_own > off_plane * count);
}

/// Removes outliers. \return their number.
std::size_t remove_outliers(PointCloud& cloud, const Tree& tree) {
    std::vector<std::uint8_t> is_out(cloud.points.size(), 0);
    parallel_for(cloud.points.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            is_out[i] = is_outlier(cloud, tree, cloud.points[i]);
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < is_out.size(); ++i)
        if (!is_out[i])
            cloud.points[kept++] = cloud.points[i];
    const std::size_t removed = cloud.points.size() - kept;
    cloud.points.resize(kept);
    cloud.outliers += removed;
    return removed;
}

}

Box box_without_outliers(std::span<const Vec3d> positions) {
    Box all;
    std::array<std::vector<double>, 3> axes;
    for (const Vec3d& p : positions)
        if (is_finite(p)) {
            all.add(p);
            for (std::size_t axis = 0; axis < 3; ++axis)
                axes[axis].push_back(p[static_cast<int>(axis)]);
        }
    if (all.empty())
        return all;
    constexpr std::size_t share = 100;
    const std::size_t few = axes[0].size() / share;
    Box inner;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double>& values = axes[static_cast<std::size_t>(axis)];
        const auto nth = [&](std::size_t n) {
            std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
            return values[n];
        };
        inner.min[axis] = nth(few);
        inner.max[axis] = nth(values.size() - 1 - few);
    }
    const Vec3d size(inner.diagonal());
    const Box allowed{inner.min - size, inner.max + size};
    return {glm::max(all.min, allowed.min), glm::min(all.max, allowed.max)};
}

PointCloud clean_points(std::span<const Vec3d> positions, std::span<const Vec3> normals, const Frame& frame) {
    PointCloud cloud;
    cloud.points.reserve(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const Vec3 p = frame.to_unit(positions[i]);
        if (!is_finite(positions[i]))
            ++cloud.not_finite;
        else if (glm::any(glm::greaterThan(glm::abs(p), Vec3(0.5001f))))
            ++cloud.outliers; // outside of the frame
        else
            cloud.points.push_back({p, normals.empty() ? Vec3(0.0f) : unit_or_zero(Vec3d(normals[i])), 0.0f, i});
    }
    sort_and_join(cloud);
    // Each round removes neighbours of the remaining outliers, which are then further from other points.
    constexpr int most_rounds = 3;
    for (int round = 0; round < most_rounds; ++round) {
        constexpr std::size_t least_points = 3;
        if (cloud.points.size() < least_points)
            throw InputError("has fewer than three different points, which determine no surface");
        const PointsForTree adaptor{cloud.points};
        const Tree tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(16));
        measure_spacing(cloud, tree);
        if (round == 0)
            estimate_normals(cloud, tree);
        constexpr double few = 1e-3;
        if (static_cast<double>(remove_outliers(cloud, tree)) <= few * static_cast<double>(cloud.points.size()))
            break;
    }
    return cloud;
}

}
