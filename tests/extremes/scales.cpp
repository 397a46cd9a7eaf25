/// Scenes of extreme scale and position. Neither may affect the result.
#include "extreme.h"

#include "alcove/mesh/files.h"

#include "scratch_folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

namespace alcove::extremes {
namespace {

/// Writes a mesh to a file with that extension, with all digits, and reads it back.
Mesh through_file(const Mesh& mesh, const std::string& extension) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder / ("mesh" + extension);
    {
        std::ofstream text(file);
        if (extension == ".off")
            text << fmt::format("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.face_count());
        if (extension == ".ply")
            text << fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
                                "property double z\nelement face {}\nproperty list uchar int vertex_indices\n"
                                "end_header\n",
                                mesh.vertex_count(), mesh.face_count());
        const bool obj = extension == ".obj";
        for (const Vec3d& p : mesh.positions)
            text << fmt::format("{}{:.17g} {:.17g} {:.17g}\n", obj ? "v " : "", p.x, p.y, p.z);
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            text << (obj ? "f" : std::to_string(mesh.face(f).size()));
            for (const std::uint32_t v : mesh.face(f))
                text << ' ' << (obj ? v + 1 : v);
            text << '\n';
        }
    }
    return read_mesh(file);
}

Mesh scaled(Mesh mesh, double factor) {
    for (Vec3d& p : mesh.positions)
        p *= factor;
    return mesh;
}

Mesh moved(Mesh mesh, const Vec3d& offset) {
    for (Vec3d& p : mesh.positions)
        p += offset;
    return mesh;
}

constexpr double same = 1e-4;

}

std::vector<Extreme> scales() {
    std::vector<Extreme> rows;
    const std::string_view extensions[] = {".ply", ".obj", ".off"};
    int row = 0;
    for (const double factor : {1e-30, 1e-20, 1e-10, 1e-5, 1e-3, 3.0, 1e3, 1e5, 1e10, 1e20, 1e30}) {
        const std::string extension(extensions[row++ % 3]);
        rows.push_back(
            {"scale", fmt::format("{:g}, {}", factor, extension), "ao within 1e-4 of that at unit scale",
             [=] { return against(bumpy(), through_file(scaled(bumpy(), factor), extension), all_kinds, same); }});
    }
    return rows;
}

std::vector<Extreme> offsets() {
    std::vector<Extreme> rows;
    for (const double extents : {1.0, 1e3, 1e6, 1e9}) {
        const Vec3d offset = 2.0 * extents * Vec3d(1.0, -0.7, 0.4);
        const bool lossy = extents > 1e7;
        rows.push_back({"offset", fmt::format("{:g} extents", extents),
                        lossy ? "RMSE no larger than that of the file's rounding alone"
                              : "ao within 1e-4 of that of the vertices in the file, moved back",
                        [=] {
                            const Mesh mesh = bumpy();
                            const Mesh away = through_file(moved(mesh, offset), ".ply");
                            const Mesh back = moved(away, -offset); // exact: nothing is lost on the way back
                            double lost = 0.0;
                            for (std::size_t i = 0; i < back.vertex_count(); ++i)
                                lost = std::max(lost, glm::length(back.positions[i] - mesh.positions[i]));
                            const Result rounded = rmse_against(mesh, back, all_kinds, same);
                            Result result = lossy ? rmse_against(back, away, all_kinds, same)
                                                  : against(back, away, all_kinds, same);
                            double moved_ao = 0.0;
                            for (std::size_t i = 0; i < rounded.figures.size(); ++i) {
                                moved_ao = std::max(moved_ao, rounded.figures[i].value);
                                if (lossy)
                                    result.figures[i].bound = std::max(same, rounded.figures[i].value);
                            }
                            result.note =
                                fmt::format("rounding in the file moves vertices by up to {:.1g} and changes ao "
                                            "by an RMSE of up to {:.1g}",
                                            lost, moved_ao);
                            return result;
                        }});
    }
    return rows;
}

}
