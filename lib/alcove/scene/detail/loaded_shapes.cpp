#include "alcove/scene/detail/loaded_shapes.h"

#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/detail/gaps.h"
#include "alcove/mesh/detail/join.h"
#include "alcove/mesh/files.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/render/renderer.h"
#include "alcove/scene/detail/support.h"
#include "alcove/vdb/vdb_file.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

namespace alcove {
namespace {

void add(Box& box, const Box& other) {
    box.add(other.min);
    box.add(other.max);
}

/// The box of the vertices that faces use.
Box box_of_faces(const LoadedMesh& file, const Pose& pose) {
    Box box;
    for (const Triangle& triangle : file.triangles)
        for (const std::uint32_t vertex : triangle)
            box.add(pose(file.mesh.positions[vertex]));
    return box;
}

double bytes_of(const LoadedMesh& file) {
    const Mesh& mesh = file.mesh;
    const double vertices = sizeof(Vec3d) * mesh.positions.size() + sizeof(Vec3) * mesh.normals.size();
    return vertices + sizeof(std::uint32_t) * (mesh.corners.size() + mesh.face_begin.size()) +
           sizeof(Triangle) * file.triangles.size();
}

/// Loads shapes; reads each file once.
class Loader {
  public:
    explicit Loader(MemoryEstimate& memory) : memory_(memory) {}

    LoadedShape load(const SceneObject& object, const Pose& outer) {
        LoadedShape loaded{&object, outer * pose_of(object.placement)};
        loaded.box = box_of(object.shape, loaded.pose);
        if (const auto* mesh = std::get_if<MeshShape>(&object.shape))
            load_mesh(*mesh, loaded);
        if (const auto* grid = std::get_if<GridShape>(&object.shape))
            load_grid(*grid, loaded);
        if (const auto* composite = std::get_if<CompositeShape>(&object.shape))
            load_parts(*composite, loaded);
        return loaded;
    }

  private:
    void load_mesh(const MeshShape& shape, LoadedShape& loaded) {
        std::shared_ptr<LoadedMesh>& file = meshes_[key_of(shape)];
        if (!file) {
            Mesh read = read_mesh(shape.file);
            if (shape.weld && read.face_count() == 0)
                throw InputError(shape.file.string() + ": contains points, but weld is for meshes: leave it out");
            file = std::make_shared<LoadedMesh>(LoadedMesh{with_surface(std::move(read)), {}});
            if (shape.weld)
                file->mesh = join_vertices(file->mesh, *shape.weld).mesh;
            file->triangles = triangulate(file->mesh).triangles;
            loaded.warnings = file->mesh.warnings;
            if (const Gaps gaps = find_gaps(file->mesh, file->triangles); gaps.closable > 0)
                loaded.warnings.push_back(gaps.advice());
            memory_.add(shape.file.string(), bytes_of(*file));
            memory_.check();
            if (!shape.own_colors && may_have_colors(file->mesh))
                loaded.warnings.emplace_back("its colours are not shown: write color = \"own\" to show them, or "
                                             "\"none\"");
        }
        if (shape.own_colors.value_or(false) && !file->colors) {
            file->colors = own_colors(file->mesh);
            const std::vector<std::string>& left_out = file->colors->warnings;
            loaded.warnings.insert(loaded.warnings.end(), left_out.begin(), left_out.end());
        }
        loaded.mesh = file;
        loaded.box = box_of_faces(*file, loaded.pose);
    }

    void load_grid(const GridShape& shape, LoadedShape& loaded) {
        const auto [place, is_new] = grids_.try_emplace({shape.file.lexically_normal(), shape.names});
        LoadedGrid& file = place->second;
        if (is_new) {
            file.stack = read_grids(shape.file, {shape.names});
            loaded.warnings = file.stack.warnings;
            try {
                file.box = outline(LevelStack(file.stack), file.stack.frame).box;
            } catch (const InputError& error) {
                throw InputError(shape.file.string() + ": " + error.what());
            }
        }
        loaded.stack = file.stack;
        add(loaded.box, posed(file.box, loaded.pose));
    }

    void load_parts(const CompositeShape& shape, LoadedShape& loaded) {
        const bool unite = shape.operation == CompositeShape::Operation::unite;
        for (const SceneObject& object : shape.parts) {
            loaded.parts.push_back(load(object, loaded.pose));
            if (!unite && loaded.parts.size() > 1)
                continue;
            const Box& box = loaded.parts.back().box;
            if (box.empty())
                throw InputError(object.name +
                                 ": is infinite, so it can only be subtracted from other parts: use a large box");
            add(loaded.box, box);
        }
        // A blend bulges where faces are flush: by a quarter of its width for two parts, never by more than its width.
        double bulge = 0.0;
        for (std::size_t i = 1; unite && i < shape.parts.size() && shape.blend > 0.0; ++i)
            bulge += std::pow(shape.blend - bulge, 2.0) / (4.0 * shape.blend);
        bulge *= loaded.pose.scale;
        loaded.box.min -= bulge;
        loaded.box.max += bulge;
    }

    struct LoadedGrid {
        GridStack stack;
        Box box; // of its surface
    };
    /// The file, and the value and unit of `weld`.
    using MeshKey = std::tuple<std::filesystem::path, double, Length::Unit>;
    static MeshKey key_of(const MeshShape& shape) {
        const Length weld = shape.weld.value_or(Length());
        return {shape.file.lexically_normal(), weld.value, weld.unit};
    }

    MemoryEstimate& memory_;
    std::map<MeshKey, std::shared_ptr<LoadedMesh>> meshes_;
    std::map<std::pair<std::filesystem::path, std::vector<std::string>>, LoadedGrid> grids_; // by file and names
};

}

std::vector<LoadedShape> load_shapes(const Scene& scene, MemoryEstimate& memory) {
    Loader loader(memory);
    std::vector<LoadedShape> shapes;
    for (const SceneObject& object : scene.objects)
        shapes.push_back(loader.load(object, Pose{}));
    return shapes;
}

}
