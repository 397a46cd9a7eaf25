/// The occluders of a mesh other than the mesh itself: other meshes and the ground.
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/field/level_stack.h"
#include "alcove/occlusion/occluders.h"

namespace alcove {

/// The representations of occluders that a method needs.
struct OccluderNeeds {
    bool field = false, rays = false;
};

/// A mesh or part to be baked.
struct Occludee {
    std::span<const Vec3d> positions; ///< scene units
    std::span<const Triangle> triangles;
    Frame frame; ///< defines its unit space
};

/// Holds the occluders in scene units, so that they can be transformed to any unit space.
class Surroundings {
  public:
    /// Keeps only those parts of the occluders that are near enough to occlude. The ground is the plane through the
    /// lowest vertex that a face of `mesh` uses. `radius` is in the unit space of `frame`. Appends to the warnings.
    Surroundings(const BakeOptions& options, const Mesh& mesh, const Frame& frame, float radius,
                 std::vector<std::string>& warnings);

    /// Builds the grids of the occluders. Their voxels are at most `voxel`, in scene units, clamped to between 1/512
    /// and 1/32 of each occluder's diagonal, unless the memory limit requires larger ones. If `voxel` is 0, the voxels
    /// are chosen automatically. Appends to the warnings.
    /// \throw like alcove::voxelize().
    void voxelize(double voxel, std::vector<std::string>& warnings);
    /// Whether the grids of the occluders fit in their share of the memory limit.
    bool fit() const;
    std::size_t bytes() const; ///< memory of the grids of the occluders

    /// The union of the fields of a grid stack and of the surroundings. \pre voxelize() was called
    AnyField field_around(const GridStack& stack, const Frame& frame) const;
    /// The triangles of a mesh and of the surroundings in the unit space of the mesh; the mesh comes first.
    RaySurface rays_around(const Occludee& baked) const;

  private:
    struct Occluder {
        std::string name;
        Mesh mesh; ///< clipped to the neighbourhood of the baked mesh
        std::vector<Triangle> triangles;
        Frame frame;
        std::size_t bytes = 0; ///< of its grids
        std::optional<LevelStack> field{};
    };
    struct Ground {
        Vec3d up; ///< unit length
        double height;

        float height_in(const Frame& frame) const {
            return static_cast<float>((height - glm::dot(up, frame.center)) / frame.diagonal);
        }
    };
    void add(const Mesh& occluder, const Box& near, std::vector<std::string>& warnings);
    GridStack voxelize(const Occluder& occluder, double voxel) const;
    double memory_each() const; ///< limit for the grids of one occluder, bytes

    double radius_; ///< scene units
    std::vector<Occluder> occluders_;
    std::optional<Ground> ground_;
};

}
