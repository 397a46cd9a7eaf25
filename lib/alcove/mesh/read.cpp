#include "alcove/mesh/files.h"

#include "alcove/base/detail/file_kind.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/text_encoding.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <new>

namespace alcove {
namespace {

struct Format {
    std::string_view name;
    Mesh (*read)(const FileBytes&);
};
constexpr Format ply{"PLY", read_ply}, obj{"OBJ", read_obj}, off{"OFF", read_off}, stl{"STL", read_stl},
    gltf{"glTF", read_gltf};

const Format& format_of(const FileBytes& file) {
    if (begins_as_ply(file))
        return ply;
    if (begins_as_off(file))
        return off;
    if (begins_as_stl(file))
        return stl;
    if (begins_as_gltf(file))
        return gltf;
    refuse_wide_text(file);
    const std::string extension = lower_extension(file.path());
    if (extension == ".ply")
        return ply;
    if (extension == ".off")
        return off;
    if (extension == ".stl")
        return stl;
    if (extension == ".glb" || extension == ".gltf")
        return gltf;
    if (extension == ".toml")
        file.fail("is a scene: render it");
    if (extension == ".vdb")
        file.fail("is a grid, not a mesh");
    if (extension == ".obj" || begins_as_obj(file))
        return obj;
    file.fail("is not a mesh in a known format; PLY, OBJ, OFF, STL and glTF can be read");
}

std::string points_without_faces(std::size_t count) {
    return count == 0
               ? "contains no vertices and no faces; export it again"
               : "contains " + counted(count, "point", "points") + " but no faces; points can be read from a PLY file";
}

/// Whether all coordinates are finite and far from the largest double.
bool are_moderate(const std::vector<Vec3d>& positions) {
    std::size_t others = 0; // counted, because a loop without an early exit is fast
    for (const Vec3d& p : positions)
        others += !(std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) < 1e300);
    return others == 0;
}

bool has_first_edge(const Mesh& mesh) {
    return mesh.face_count() > 0 && mesh.face(0).size() > 1 &&
           std::isnormal(glm::distance(mesh.positions[mesh.face(0)[0]], mesh.positions[mesh.face(0)[1]]));
}

void check_extent(const FileBytes& file, const Mesh& mesh) {
    const double diagonal = mesh.box().diagonal();
    if (std::isinf(diagonal))
        file.fail("has vertices farther apart than numbers can represent; scale it down, or export it again");
    if (std::fpclassify(diagonal) == FP_SUBNORMAL)
        file.fail("has vertices closer together than numbers can resolve; scale it up, or export it again");
}

void warn_of_infinite_vertices(Mesh& mesh) {
    const auto non_finite =
        std::count_if(mesh.positions.begin(), mesh.positions.end(), [](const Vec3d& p) { return !is_finite(p); });
    if (non_finite > 0)
        mesh.warnings.push_back(counted(static_cast<std::size_t>(non_finite), "vertex has", "vertices have") +
                                " coordinates that are not finite numbers; kept, but faces that use them are ignored");
}

void warn_of_degenerate_faces(Mesh& mesh) {
    std::size_t degenerate = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        degenerate += mesh.face_begin[f + 1] - mesh.face_begin[f] < 3;
    if (degenerate > 0)
        mesh.warnings.push_back(counted(degenerate, "face has", "faces have") +
                                " fewer than three corners; kept, but ignored");
}

}

Mesh read_bytes(const FileBytes& file) {
    const Format& format = format_of(file);
    Mesh mesh = format.read(file);
    mesh.format = format.name;
    mesh.name = file.path().string();
    if (mesh.vertex_count() > std::numeric_limits<std::uint32_t>::max())
        throw LimitError(file.path().string() + ": more than 2^32 vertices; split the mesh");
    if (mesh.face_count() == 0 && mesh.format != ply.name)
        file.fail(mesh.format == stl.name ? "contains no facets; export it again"
                                          : points_without_faces(mesh.vertex_count()));
    // For most meshes, a quick test shows that the bounding box is neither too large nor too small. Computing the box
    // takes longer.
    const bool moderate = are_moderate(mesh.positions);
    if (!moderate || !has_first_edge(mesh))
        check_extent(file, mesh);
    if (!moderate)
        warn_of_infinite_vertices(mesh);
    warn_of_degenerate_faces(mesh);
    return mesh;
}

Mesh read_mesh(const std::filesystem::path& path) {
    try {
        return read_bytes(FileBytes(path, head_of_glb));
    } catch (const std::bad_alloc&) {
        throw MemoryError(path.string() + ": does not fit in memory; simplify or split the mesh");
    }
}

void fail_without_faces(const FileBytes& file, const char* place, std::size_t count) {
    file.fail_at_line(place, "the file " + points_without_faces(count));
}

void close_face(Mesh& mesh) {
    if (mesh.corners.size() > std::numeric_limits<std::uint32_t>::max())
        throw LimitError("more than 2^32 face corners; split the mesh");
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

bool is_padding(std::string_view text) {
    constexpr std::string_view padding("\0\x1a \t\r\n", 6);
    return text.find_first_not_of(padding) == std::string_view::npos;
}

std::uint8_t color_byte(double value) {
    return value > 0.0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 255.0))) : std::uint8_t(0);
}

}
