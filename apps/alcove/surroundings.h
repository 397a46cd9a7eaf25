/// What occludes a mesh beside itself: other meshes, and the ground.
#pragma once

#include "method_options.h"
#include "voxelized.h"

#include "alcove/field/level_stack.h"
#include "alcove/occlusion/occluders.h"

#include <optional>

namespace alcove::cli {

struct SurroundingsRequest {
    std::vector<std::string> occluders; ///< meshes, in the coordinates of the scene
    bool ground = false;
    Vec3d up{0.0, 1.0, 0.0}; ///< any length but 0
};

/// Adds --occluder, --ground and --up.
void add_surroundings_options(CLI::App& verb, SurroundingsRequest& request);

/// In scene space, so that any unit space can be made part of it.
class Surroundings {
  public:
    /// Reads occluders; what is too far away to occlude is left out. The ground is the plane through the lowest
    /// vertex. Warnings go to `input`. \throw what reading throws.
    Surroundings(const SurroundingsRequest& request, VoxelizedMesh& input);

    /// Makes the grids of the occluders. Voxels are as large as those of the mesh, but from 1/512 to 1/32 of an
    /// occluder, as far as memory goes. Warnings go to `input`. \throw what voxelizing throws.
    void voxelize(VoxelizedMesh& input);
    bool fit() const; ///< whether there is memory for their grids

    /// The mesh and its grid among them, in the unit space of `frame`: as a field, which takes voxelize() before,
    /// as triangles, or both.
    Occluders around(const Mesh& mesh, std::span<const Triangle> triangles, const GridStack& stack,
                     const Frame& frame, Needs needs) const;
    std::size_t bytes() const; ///< of the grids

  private:
    struct Occluder {
        std::string file;
        Mesh mesh;
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
    AnyField field_around(const GridStack& stack, const Frame& frame) const;
    RaySurface rays_around(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame) const;
    void add_occluder(const std::string& file, VoxelizedMesh& input);
    double memory_each() const; ///< bytes that the grids of an occluder may take

    std::vector<Occluder> occluders_;
    std::optional<Ground> ground_;
};

}
