// Target for voxelization. The bytes define the triangles: shared, degenerate, far apart, not finite.
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "checks.h"
#include "grid_checks.h"

#include <array>
#include <cstring>
#include <limits>

using namespace alcove;

namespace {

/// Takes values from the front of the bytes, and zeros after the last byte.
class Source {
  public:
    explicit Source(fuzz::Bytes bytes) : left_(bytes) {}

    bool empty() const { return left_.empty(); }
    std::uint8_t byte() { return take<std::uint8_t>(); }

    /// Mostly one of a few values, so that vertices coincide and triangles share them.
    double coordinate() {
        using Limits = std::numeric_limits<double>;
        constexpr double infinity = Limits::infinity(), no_number = Limits::quiet_NaN();
        constexpr std::array outliers{0.0,   -0.0,   1e-320,   1e-160,    1e-30,     1e-7,    1e7,  1e30,
                                      1e160, -1e160, infinity, -infinity, no_number, 1.7e308, 1e39, -1e308};
        const std::uint8_t kind = byte();
        if (kind < 192)
            return kind % 16 - 8;
        if (kind < 224)
            return take<float>();
        if (kind < 240)
            return take<double>();
        return outliers[kind - 240];
    }

  private:
    template <class T>
    T take() {
        T value{};
        const std::size_t size = std::min(sizeof value, left_.size());
        std::memcpy(&value, left_.data(), size);
        left_ = left_.subspan(size);
        return value;
    }

    fuzz::Bytes left_;
};

VoxelizeOptions options_of(Source& source) {
    const std::uint8_t choice = source.byte();
    VoxelizeOptions options;
    options.grid = {.radius = choice & 1 ? 0.5f : 0.1f,
                    .largest_voxel = 1.0f / 32.0f,
                    .cluster = (choice & 2) != 0,
                    .memory_limit = 64.0 * (1 << 20)};
    options.sign = static_cast<SignChoice>((choice >> 2) % 3);
    return options;
}

Mesh soup_of(Source& source) {
    Mesh mesh;
    for (int vertices = 1 + source.byte() % 64; vertices > 0; --vertices) {
        const double x = source.coordinate(), y = source.coordinate();
        mesh.positions.emplace_back(x, y, source.coordinate());
    }
    while (!source.empty()) {
        Triangle face{};
        for (std::uint32_t& vertex : face)
            vertex = static_cast<std::uint32_t>(source.byte() % mesh.vertex_count());
        mesh.add_face(face);
    }
    return mesh;
}

}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Source source({data, size});
    const VoxelizeOptions options = options_of(source);
    const Mesh mesh = soup_of(source);
    fuzz::accept_refusals("", [&] { fuzz::check_grids(voxelize(mesh, triangulate(mesh).triangles, options)); });
    return 0;
}
