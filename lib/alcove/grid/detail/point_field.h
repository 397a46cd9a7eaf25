/// A function of space whose zero isosurface runs through points with normals.
#pragma once

#include "alcove/grid/detail/point_cloud.h"
#include "alcove/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace alcove {

/// The mean signed distance to the tangent planes of nearby points, weighted by distance (implicit moving least
/// squares, Shen, O'Brien and Shewchuk 2004; Kolluri 2005), at the voxels near points. A point contributes within a
/// disc that is four voxels thick, with a radius of 2.5 times the point's spacing, but at least two voxels. The
/// function is known where at least three points contribute, so that single points make no surface.
class PointField {
  public:
    /// `voxel` in unit space. Cost: about 0.5 µs per point. \throw LimitError if it exceeds the memory limit.
    PointField(const PointCloud& cloud, float voxel);

    /// The surface where the function is known, as triangles that face outward, unit space. One vertex per cell that
    /// the surface crosses, at the mean of its crossings with the edges of the cell (surface nets, Gibson 1998).
    const Mesh& surface() const { return surface_; }

    struct Place {
        Vec3d position;
        std::uint32_t face;
    };
    /// The closest point on the faces around the nearest vertex; std::nullopt if no cell around the point has a vertex.
    std::optional<Place> closest(const Vec3& point) const;

  private:
    static constexpr int side = 8; ///< voxels along a block
    static constexpr std::size_t volume = 512;
    struct Block {
        std::array<std::int32_t, 3> at; ///< its first voxel
        std::array<float, volume> value, weight;
        std::array<std::uint8_t, volume> count;   ///< number of points, at most 255
        std::array<std::uint32_t, volume> vertex; ///< of the cell whose lowest corner this is
    };
    static std::uint64_t key(const std::array<std::int32_t, 3>& voxel);
    static std::size_t place_in(const Block& block, const std::array<std::int32_t, 3>& voxel);
    std::uint32_t make_block(const std::array<std::int32_t, 3>& voxel);
    /// Finds blocks, and remembers the last one.
    class Finder;
    void add(const CloudPoint& point, float count); ///< `point` stands for `count` points
    /// Adds a point to the voxels of a block from `first` to `last` along z. `center` and `radius` are in voxels.
    static void add_row(Block& block, const CloudPoint& point, float count, std::array<std::int32_t, 3> voxel,
                        std::int32_t first, std::int32_t last, const Vec3& center, float radius);
    void build_surface();
    void list_faces();

    float voxel_;
    Mesh surface_;
    std::vector<std::uint32_t> first_face_of_, faces_of_; ///< the faces of each vertex
    std::vector<Block> blocks_;
    std::unordered_map<std::uint64_t, std::uint32_t> index_;
    std::uint64_t last_key_ = ~std::uint64_t{0};
    std::uint32_t last_block_ = 0;
};

}
