/// Meshes with defects. The sound parts must be baked as if the defects were not there.
#include "extreme.h"
#include "shapes.h"

#include "alcove/base/types.h"

#include <algorithm>
#include <limits>

namespace alcove::extremes {
namespace {

/// Calls `change(index, face)` for each face, and keeps the face if it returns true.
template <class Change>
Mesh with_faces(const Mesh& mesh, const Change& change) {
    Mesh changed;
    changed.positions = mesh.positions;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::vector<std::uint32_t> face(mesh.face(f).begin(), mesh.face(f).end());
        if (change(f, face))
            changed.add_face(face);
    }
    return changed;
}

Mesh flipped(const Mesh& mesh, const std::function<bool(std::size_t)>& which) {
    return with_faces(mesh, [&](std::size_t f, std::vector<std::uint32_t>& face) {
        if (which(f))
            std::reverse(face.begin(), face.end());
        return true;
    });
}

Mesh without_face(const Mesh& mesh, std::size_t left_out) {
    return with_faces(mesh, [=](std::size_t f, const std::vector<std::uint32_t>&) { return f != left_out; });
}

/// Adds triangles without area, on existing vertices.
Mesh with_degenerate(const Mesh& mesh) {
    Mesh changed = mesh;
    for (std::uint32_t v = 0; v + 1 < mesh.vertex_count(); v += 7) {
        changed.add_face(std::array{v, v, v + 1});
        changed.add_face(std::array{v, v, v});
    }
    return changed;
}

/// Adds a triangle on every tenth face, with one new corner at that position.
Mesh with_corner_at(const Mesh& mesh, const Vec3d& position) {
    Mesh changed = mesh;
    changed.positions.push_back(position);
    const auto added = static_cast<std::uint32_t>(mesh.vertex_count());
    for (std::size_t f = 0; f < mesh.face_count(); f += 10)
        changed.add_face(std::array{mesh.face(f)[0], mesh.face(f)[1], added});
    return changed;
}

Mesh combined(const Mesh& mesh, double scale, const Vec3d& move) {
    Mesh both = mesh;
    test::add_part(both, mesh, scale, move);
    return both;
}

/// Adds a flipped copy of all faces, on vertices of its own.
Mesh with_backs(const Mesh& mesh) {
    const std::size_t once = mesh.face_count();
    return flipped(combined(mesh, 1.0, Vec3d(0.0)), [=](std::size_t f) { return f >= once; });
}

Mesh with_faces_twice(const Mesh& mesh) {
    Mesh twice = mesh;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        twice.add_face(mesh.face(f));
    return twice;
}

/// Compares with exact rays only at vertices outside the solid: those inside should be buried, but rays that start
/// behind the faces escape.
Result outside_against_exact(const Mesh& mesh, const Methods& methods, double bound) {
    const Baked baked(mesh);
    const std::vector<float> truth = baked.truth();
    const std::vector<bool> buried = baked.buried();
    Result result;
    for (const std::string_view method : methods) {
        const std::vector<float> ao = baked.by(method);
        std::vector<float> outside, outside_truth;
        for (std::size_t i = 0; i < ao.size(); ++i)
            if (!buried[i]) {
                outside.push_back(ao[i]);
                outside_truth.push_back(truth[i]);
            }
        result.figures.push_back({std::string(method), compare(outside, outside_truth).rmse, bound});
    }
    const auto left_out = std::count(buried.begin(), buried.end(), true);
    result.note = std::to_string(left_out) + " vertices are inside";
    return result;
}

}

std::vector<Extreme> damages() {
    std::vector<Extreme> rows;
    const auto add = [&](std::string name, std::string must, std::function<Result()> run) {
        rows.push_back({"damage", std::move(name), std::move(must), std::move(run)});
    };
    constexpr double nothing = 0.0, bound = 0.04, infinity = std::numeric_limits<double>::infinity();
    const std::string unchanged = "bit-identical ao at all vertices";
    const std::string close = "RMSE at most 0.04 against exact rays on the same triangles";
    const std::string refusal = "a one-line error";
    const Methods rays = {"traced", "guided", "exact"};
    add("faces without area", unchanged,
        [=] { return against(bumpy(), with_degenerate(bumpy()), all_kinds, nothing); });
    add("vertices that no face uses", unchanged, [=] {
        Mesh changed = bumpy();
        changed.positions.resize(changed.vertex_count() + 1000, Vec3d(0.1, 0.2, 0.3));
        return against(bumpy(), changed, all_kinds, nothing);
    });
    for (const auto& [name, value] : {std::pair("NaN", std::numeric_limits<double>::quiet_NaN()),
                                      std::pair("+inf", infinity), std::pair("-inf", -infinity)})
        add(std::string("faces with a corner at ") + name, unchanged, [=, value = value] {
            return against(bumpy(), with_corner_at(bumpy(), Vec3d(0.0, value, 0.0)), all_kinds, nothing);
        });
    add("faces with a corner at 1e38", "a one-line error: in a box that large, no face has an area",
        [] { return refused<InputError>([] { const Baked baked(with_corner_at(bumpy(), Vec3d(1e38, 0, 0))); }); });
    add("all faces twice", close, [=] { return against_exact(Baked(with_faces_twice(bumpy())), rays, bound); });
    add("all faces twice, once reversed", close,
        [=] { return against_exact(Baked(with_backs(bumpy())), rays, bound); });
    add("all faces inside out", close,
        [=] { return against_exact(Baked(flipped(bumpy(), [](std::size_t) { return true; })), rays, bound); });
    add("a third of the faces inside out", "a warning that counts the edges where orientations differ", [=] {
        const Baked baked(flipped(bumpy(), [](std::size_t f) { return f % 3 == 0; }));
        const std::vector<std::string> warnings = baked.warnings();
        const auto found = std::find_if(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find(" edges the neighbouring faces have opposite orientations") != std::string::npos;
        });
        return Result{{{"warnings missing", found == warnings.end() ? 1.0 : 0.0, 0.0}},
                      found == warnings.end() ? "" : *found};
    });
    add("one face is missing", close, [=] { return against_exact(Baked(without_face(bumpy(), 1234)), rays, bound); });
    add("a shell within a shell", close,
        [=] { return against_exact(Baked(combined(bumpy(), 0.8, Vec3d(0.0))), rays, bound); });
    add("two intersecting bodies",
        "RMSE at most 0.05 against exact rays, except at vertices inside: the seam is sharper than any voxel",
        [=] { return outside_against_exact(combined(bumpy(), 0.9, Vec3d(0.7, 0.2, 0.1)), rays, 0.05); });
    add("two boxes with a face in common", close + ", except at vertices inside", [=] {
        Mesh boxes = test::box_mesh({0.5, 0.4, 0.3}, 16);
        test::add_part(boxes, test::box_mesh({0.5, 0.4, 0.3}, 16), 0.8, {0.9, 0.0, 0.0});
        return outside_against_exact(boxes, rays, bound);
    });
    add("no faces", refusal, [] {
        return refused<InputError>([] {
            Mesh mesh;
            mesh.positions = {{0, 0, 0}, {1, 0, 0}};
            const Baked baked(mesh);
        });
    });
    add("all vertices at one point", refusal, [] {
        return refused<InputError>([] {
            Mesh mesh = bumpy();
            for (Vec3d& p : mesh.positions)
                p = Vec3d(1.0, 2.0, 3.0);
            const Baked baked(mesh);
        });
    });
    return rows;
}

}
