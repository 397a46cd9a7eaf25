#include "alcove/grid/detail/point_field.h"

#include "alcove/base/detail/closest_point.h"
#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

using Voxel = std::array<std::int32_t, 3>;

constexpr float half_thickness = 2.0f;                    // voxels
constexpr float spread = 2.5f;                            // spacings
constexpr float least_radius = 2.0f, most_radius = 12.0f; // voxels

constexpr std::uint8_t least_points = 3;
constexpr std::uint32_t no_vertex = ~std::uint32_t{0};

constexpr std::int32_t floor_div(std::int32_t a, std::int32_t b) {
    return (a >= 0 ? a : a - b + 1) / b;
}

}

std::uint64_t PointField::key(const Voxel& voxel) {
    constexpr std::int64_t offset = 1 << 20, mask = (1 << 21) - 1;
    std::uint64_t key = 0;
    for (const std::int32_t coordinate : voxel)
        key = key << 21 | static_cast<std::uint64_t>((floor_div(coordinate, side) + offset) & mask);
    return key;
}

std::size_t PointField::place_in(const Block& block, const Voxel& voxel) {
    std::size_t place = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        place = place * side + static_cast<std::size_t>(voxel[axis] - block.at[axis]);
    return place;
}

std::uint32_t PointField::make_block(const Voxel& voxel) {
    const std::uint64_t wanted = key(voxel);
    if (wanted == last_key_)
        return last_block_;
    const auto [place, is_new] = index_.try_emplace(wanted, static_cast<std::uint32_t>(blocks_.size()));
    if (is_new) {
        if (static_cast<double>(blocks_.size()) * sizeof(Block) > memory_limit())
            throw LimitError(fmt::format("the points need more than {} of memory: give a larger --point-size, or raise "
                                         "--max-memory",
                                         bytes_text(memory_limit())));
        Block& block = blocks_.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
            block.at[axis] = side * floor_div(voxel[axis], side);
        block.value.fill(0.0f);
        block.weight.fill(0.0f);
        block.count.fill(0);
        block.vertex.fill(no_vertex);
    }
    last_key_ = wanted;
    return last_block_ = place->second;
}

class PointField::Finder {
  public:
    explicit Finder(const PointField& field) : field_(field) {}

    const Block* find(const Voxel& voxel) {
        const std::uint64_t wanted = key(voxel);
        if (wanted != last_key_) {
            const auto found = field_.index_.find(wanted);
            last_ = found == field_.index_.end() ? nullptr : &field_.blocks_[found->second];
            last_key_ = wanted;
        }
        return last_;
    }
    std::optional<float> value(const Voxel& voxel) {
        const Block* const block = find(voxel);
        if (block == nullptr)
            return {};
        const std::size_t at = place_in(*block, voxel);
        if (block->count[at] < least_points)
            return {};
        return block->value[at] / block->weight[at];
    }
    std::uint32_t vertex(const Voxel& cell) {
        const Block* const block = find(cell);
        return block == nullptr ? no_vertex : block->vertex[place_in(*block, cell)];
    }

  private:
    const PointField& field_;
    std::uint64_t last_key_ = ~std::uint64_t{0};
    const Block* last_ = nullptr;
};

PointField::PointField(const PointCloud& cloud, float voxel) : voxel_(voxel) {
    // Consecutive points that are close compared with a voxel count as one.
    constexpr float close = 0.7f, parallel = 0.9f; // voxels; a cosine
    for (std::size_t i = 0; i < cloud.points.size();) {
        CloudPoint mean = cloud.points[i];
        Vec3 normal = mean.normal, position = mean.position;
        std::size_t end = i + 1;
        for (; end < cloud.points.size(); ++end) {
            const CloudPoint& next = cloud.points[end];
            if (glm::distance(next.position, cloud.points[i].position) > close * voxel ||
                glm::dot(next.normal, cloud.points[i].normal) < parallel)
                break;
            position += next.position;
            normal += next.normal;
            mean.spacing = std::max(mean.spacing, next.spacing);
        }
        mean.position = position / static_cast<float>(end - i);
        mean.normal = unit_or_zero(Vec3d(normal));
        if (mean.normal != Vec3(0.0f))
            add(mean, static_cast<float>(end - i));
        i = end;
    }
    build_surface();
    list_faces();
}

void PointField::list_faces() {
    first_face_of_.assign(surface_.vertex_count() + 1, 0);
    for (const std::uint32_t v : surface_.corners)
        ++first_face_of_[v + 1];
    for (std::size_t v = 1; v < first_face_of_.size(); ++v)
        first_face_of_[v] += first_face_of_[v - 1];
    faces_of_.resize(surface_.corners.size());
    std::vector<std::uint32_t> filled(first_face_of_.begin(), first_face_of_.end() - 1);
    for (std::uint32_t f = 0; f < surface_.face_count(); ++f)
        for (const std::uint32_t v : surface_.face(f))
            faces_of_[filled[v]++] = f;
}

void PointField::add(const CloudPoint& point, float count) {
    const Vec3 center = point.position / voxel_;
    const float radius = std::clamp(spread * point.spacing / voxel_, least_radius, most_radius);
    // The box of a disc: its thickness along the normal, and its radius across.
    const Vec3 across = glm::sqrt(glm::max(Vec3(1.0f) - point.normal * point.normal, 0.0f));
    const Vec3 reach = radius * across + half_thickness * glm::abs(point.normal);
    Voxel low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        low[axis] = static_cast<std::int32_t>(std::ceil(center[a] - reach[a]));
        high[axis] = static_cast<std::int32_t>(std::floor(center[a] + reach[a]));
    }
    for (std::int32_t bx = floor_div(low[0], side); bx <= floor_div(high[0], side); ++bx)
        for (std::int32_t by = floor_div(low[1], side); by <= floor_div(high[1], side); ++by)
            for (std::int32_t bz = floor_div(low[2], side); bz <= floor_div(high[2], side); ++bz) {
                Block& block = blocks_[make_block({bx * side, by * side, bz * side})];
                const auto first = [&](std::size_t axis) { return std::max(low[axis], block.at[axis]); };
                const auto last = [&](std::size_t axis) { return std::min(high[axis], block.at[axis] + side - 1); };
                for (std::int32_t x = first(0); x <= last(0); ++x)
                    for (std::int32_t y = first(1); y <= last(1); ++y)
                        add_row(block, point, count, {x, y, 0}, first(2), last(2), center, radius);
            }
}

void PointField::add_row(Block& block, const CloudPoint& point, float count, Voxel voxel, std::int32_t first,
                         std::int32_t last, const Vec3& center, float radius) {
    // Where the row is within the thickness of the disc.
    const float dx = float(voxel[0]) - center.x, dy = float(voxel[1]) - center.y;
    const float height_at_center = dx * point.normal.x + dy * point.normal.y;
    constexpr float flat = 1e-3f;
    if (std::fabs(point.normal.z) > flat) {
        const float middle = center.z - height_at_center / point.normal.z,
                    half = half_thickness / std::fabs(point.normal.z);
        first = std::max(first, static_cast<std::int32_t>(std::ceil(middle - half)));
        last = std::min(last, static_cast<std::int32_t>(std::floor(middle + half)));
    }
    voxel[2] = block.at[2];
    const std::size_t row = place_in(block, voxel);
    for (std::int32_t z = first; z <= last; ++z) {
        const float dz = float(z) - center.z, height = height_at_center + dz * point.normal.z;
        const float beside = (dx * dx + dy * dy + dz * dz - height * height) / (radius * radius);
        const float above = height * height / (half_thickness * half_thickness);
        if (beside >= 1.0f || above >= 1.0f)
            continue;
        const float fall = (1.0f - beside) * (1.0f - above), weight = count * fall * fall;
        const std::size_t at = row + static_cast<std::size_t>(z - block.at[2]);
        block.value[at] += weight * height;
        block.weight[at] += weight;
        block.count[at] = static_cast<std::uint8_t>(std::min(float(block.count[at]) + count, 255.0f));
    }
}

void PointField::build_surface() {
    // The corners of a cell, and its edges as pairs of them.
    constexpr std::array<std::array<int, 2>, 12> edges{
        {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
    const auto corner = [](int c) { return Voxel{c >> 2 & 1, c >> 1 & 1, c & 1}; };
    Mesh& mesh = surface_;
    struct Crossing {
        Voxel cell;
        std::array<float, 8> values;
    };
    std::vector<Crossing> crossings;
    Finder finder(*this);
    for (const Block& block : blocks_)
        for (std::int32_t x = 0; x < side; ++x)
            for (std::int32_t y = 0; y < side; ++y)
                for (std::int32_t z = 0; z < side; ++z) {
                    const std::size_t at = place_in(block, {block.at[0] + x, block.at[1] + y, block.at[2] + z});
                    if (block.count[at] < least_points)
                        continue;
                    Crossing crossing{{block.at[0] + x, block.at[1] + y, block.at[2] + z}, {}};
                    bool known = true, any_inside = false, any_outside = false;
                    for (int c = 0; c < 8 && known; ++c) {
                        const Voxel d = corner(c);
                        std::optional<float> v;
                        if (x + d[0] < side && y + d[1] < side && z + d[2] < side) {
                            const std::size_t here = place_in(
                                block, {crossing.cell[0] + d[0], crossing.cell[1] + d[1], crossing.cell[2] + d[2]});
                            if (block.count[here] >= least_points)
                                v = block.value[here] / block.weight[here];
                        } else {
                            v = finder.value(
                                {crossing.cell[0] + d[0], crossing.cell[1] + d[1], crossing.cell[2] + d[2]});
                        }
                        known = v.has_value();
                        if (known) {
                            crossing.values[static_cast<std::size_t>(c)] = *v;
                            (*v < 0.0f ? any_inside : any_outside) = true;
                        }
                    }
                    if (known && any_inside && any_outside)
                        crossings.push_back(crossing);
                }
    for (const Crossing& crossing : crossings) {
        Vec3 sum(0.0f);
        float count = 0.0f;
        for (const auto& [a, b] : edges) {
            const float va = crossing.values[static_cast<std::size_t>(a)],
                        vb = crossing.values[static_cast<std::size_t>(b)];
            if ((va < 0.0f) == (vb < 0.0f))
                continue;
            const float t = va / (va - vb);
            const Voxel ca = corner(a), cb = corner(b);
            sum += (1.0f - t) * Vec3(ca[0], ca[1], ca[2]) + t * Vec3(cb[0], cb[1], cb[2]);
            count += 1.0f;
        }
        Block& block = blocks_[make_block(crossing.cell)];
        block.vertex[place_in(block, crossing.cell)] = static_cast<std::uint32_t>(mesh.positions.size());
        const Vec3d place = Vec3d(crossing.cell[0], crossing.cell[1], crossing.cell[2]) + Vec3d(sum / count);
        mesh.positions.push_back(double(voxel_) * place);
    }
    // A quad around each edge of the lattice that the surface crosses, made at the cell whose first corner is the start
    // of the edge.
    for (const Crossing& crossing : crossings)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float begin = crossing.values[0], end = crossing.values[std::size_t(4) >> axis];
            if ((begin < 0.0f) == (end < 0.0f))
                continue;
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<std::uint32_t, 4> quad{};
            bool complete = true;
            constexpr std::array<std::array<int, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
            for (std::size_t k = 0; k < 4 && complete; ++k) {
                Voxel cell = crossing.cell;
                cell[u] -= around[k][0];
                cell[v] -= around[k][1];
                quad[k] = finder.vertex(cell);
                complete = quad[k] != no_vertex;
            }
            if (!complete)
                continue;
            if (begin >= 0.0f) // outside at the start
                std::reverse(quad.begin(), quad.end());
            // As triangles, so that no other code splits the quad along the other diagonal.
            const auto diagonal = [&](std::size_t k) {
                return glm::distance(mesh.positions[quad[k]], mesh.positions[quad[k + 2]]);
            };
            const std::size_t first = diagonal(0) <= diagonal(1) ? 0 : 1;
            for (const std::size_t k : {first, first + 2})
                mesh.add_face(std::array{quad[k % 4], quad[(k + 1) % 4], quad[(k + 2) % 4]});
        }
}

std::optional<PointField::Place> PointField::closest(const Vec3& point) const {
    const Vec3 corner = glm::floor(point / voxel_ - 0.5f); // of the eight cells whose centres surround the point
    Finder finder(*this);
    std::uint32_t nearest = no_vertex;
    double nearest_square = std::numeric_limits<double>::infinity();
    for (int c = 0; c < 8; ++c) {
        const auto at = [&](int axis, int bit) { return static_cast<std::int32_t>(corner[axis]) + (c >> bit & 1); };
        const std::uint32_t vertex = finder.vertex({at(0, 2), at(1, 1), at(2, 0)});
        if (vertex == no_vertex || first_face_of_[vertex] == first_face_of_[vertex + 1])
            continue;
        const Vec3d offset = surface_.positions[vertex] - Vec3d(point);
        if (const double square = glm::dot(offset, offset); square < nearest_square) {
            nearest_square = square;
            nearest = vertex;
        }
    }
    if (nearest == no_vertex)
        return {};
    std::optional<Place> best;
    double best_square = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = first_face_of_[nearest]; i < first_face_of_[nearest + 1]; ++i) {
        const std::uint32_t face = faces_of_[i];
        const auto p = [&](std::size_t k) { return surface_.positions[surface_.face(face)[k]]; };
        const Vec3d offset = closest_on_triangle(p(0), p(1), p(2), Vec3d(point)).offset;
        if (const double square = glm::dot(offset, offset); square < best_square) {
            best_square = square;
            best = Place{Vec3d(point) - offset, face};
        }
    }
    return best;
}

}
