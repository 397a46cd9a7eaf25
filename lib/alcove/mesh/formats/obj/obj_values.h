/// The data of an OBJ file about vertices and corners besides positions and faces, and how a Mesh gets them.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alcove {

/// The texture coordinate and normal of a corner, counted from 1; 0 for none.
struct CornerReference {
    std::uint32_t uv = 0, normal = 0;
};

/// References to items of one kind. Their range is checked at the end, as faces may precede the items.
struct References {
    std::int64_t largest = 0;         ///< the largest index
    const char* largest_at = nullptr; ///< where it is
    std::size_t missing = 0;          ///< references that precede the first item
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
    std::vector<Vec3> normals;                 ///< of unit length; zero where the file has no direction
    std::vector<std::array<double, 4>> colors; ///< one per vertex, up to the last one with a colour; r, g, b, alpha
    std::vector<CornerReference> corners;      ///< one per corner; empty until a corner has one
    References uv_references, normal_references;
    DamagedLines damaged_uvs, damaged_normals;
};

/// Adds the colours, texture coordinates and normals to the mesh, with warnings of what is missing or damaged.
void add_values(Mesh& mesh, ObjValues& values, const FileBytes& file);

}
