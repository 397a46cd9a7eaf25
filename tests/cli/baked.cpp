#include "baked.h"

#include "alcove/mesh/files.h"
#include "alcove/mesh/formats/ply/ply_document.h"

#include <array>

namespace alcove::test {

Baked read_baked(const std::filesystem::path& file) {
    Baked baked{read_mesh(file), {}};
    const PlyElement& vertices = *dynamic_cast<const PlyDocument&>(*baked.mesh.source).find("vertex");
    std::size_t stride = 0, offset = 0;
    for (const PlyProperty& property : vertices.properties) {
        if (property.name == "ao")
            offset = stride;
        stride += size_of(property.type);
    }
    for (std::size_t v = 0; v < baked.mesh.vertex_count(); ++v)
        baked.ao.push_back(static_cast<float>(number_at(vertices.rows.data() + v * stride + offset, PlyType::float32)));
    return baked;
}

Mesh floor_mesh(double half, std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j)
            mesh.positions.emplace_back(half * (2.0 * i / n - 1.0), 0.0, half * (2.0 * j / n - 1.0));
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t at = i * (n + 1) + j;
            mesh.add_face(std::array{at, at + 1, at + n + 2, at + n + 1});
        }
    return mesh;
}

}
