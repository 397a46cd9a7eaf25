/// The colours, texture coordinates and normals of an OBJ file, and their conversion for a Mesh.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alcove {

/// The indices of the texture coordinate and the normal of a corner, counted from 1; 0 for none.
struct CornerReference {
    std::uint32_t uv = 0, normal = 0;
};

/// References to items of one kind. Their range is checked at the end, as faces may precede the items.
struct References {
    std::int64_t largest = 0;         ///< the largest index
    const char* largest_at = nullptr; ///< where it is
    std::size_t missing = 0;          ///< references before the first item or beyond 2^32
    const char* missing_at = nullptr; ///< where the first of them is
};

/// Lines of one keyword whose values violate the format.
struct DamagedLines {
    std::size_t count = 0;
    const char* first = nullptr;

    void add(const char* place) {
        if (count++ == 0)
            first = place;
    }
};

struct ObjValues {
    static constexpr std::array<double, 4> no_color{-1.0, -1.0, -1.0, -1.0};

    std::vector<Vec2> uvs;
    std::vector<Vec3> normals;                 ///< unit length; zero if the file has a normal without direction
    std::vector<std::array<double, 4>> colors; ///< one per vertex, up to the last coloured one; r, g, b, alpha
    std::vector<CornerReference> corners;      ///< one per corner; empty until a corner has a reference
    References uv_references, normal_references;
    DamagedLines damaged_uvs, damaged_normals;
};

/// Adds the colours, texture coordinates and normals to the mesh, with warnings about what is missing or damaged.
void add_values(Mesh& mesh, ObjValues& values, const FileBytes& file);

}
