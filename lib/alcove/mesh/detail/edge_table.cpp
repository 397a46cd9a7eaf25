#include "alcove/mesh/detail/edge_table.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/parallel.h"

#include <algorithm>
#include <numeric>

namespace alcove {

SoundFaces sound_faces(const Mesh& mesh, std::span<const std::uint32_t> joined) {
    SoundFaces sound;
    reserve_huge(sound.begin, mesh.face_begin.size());
    reserve_huge(sound.corners, mesh.corners.size());
    reserve_huge(sound.face_of, mesh.corners.size());
    reserve_huge(sound.source, mesh.face_count());
    const bool all_finite = std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        if (!all_finite &&
            !std::all_of(face.begin(), face.end(), [&](std::uint32_t v) { return is_finite(mesh.positions[v]); }))
            continue;
        const std::size_t begin = sound.begin.back();
        for (const std::uint32_t v : face)
            if (sound.corners.size() == begin || sound.corners.back() != joined[v])
                sound.corners.push_back(joined[v]);
        while (sound.corners.size() > begin + 1 && sound.corners.back() == sound.corners[begin])
            sound.corners.pop_back();
        if (sound.corners.size() < begin + 3) {
            sound.corners.resize(begin);
            ++sound.collapsed;
            continue;
        }
        sound.face_of.resize(sound.corners.size(), static_cast<std::uint32_t>(sound.count()));
        sound.source.push_back(static_cast<std::uint32_t>(f));
        sound.begin.push_back(static_cast<std::uint32_t>(sound.corners.size()));
    }
    return sound;
}

EdgeTable::EdgeTable(const SoundFaces& faces, std::size_t vertex_count)
    : begin_(huge_vector<std::uint32_t>(vertex_count + 1)), uses_(huge_vector<EdgeUse>(faces.corners.size())) {
    const auto for_each_side = [&](auto&& visit) {
        for (std::size_t f = 0; f < faces.count(); ++f) {
            std::uint32_t from = faces.begin[f + 1] - 1;
            for (std::uint32_t to = faces.begin[f]; to < faces.begin[f + 1]; from = to++)
                visit(from, faces.corners[from], faces.corners[to]);
        }
    };
    for_each_side([&](std::uint32_t, std::uint32_t a, std::uint32_t b) { ++begin_[std::min(a, b)]; });
    // Each offset first points to the end of the sides of its vertex. Filling backwards moves the offset to their
    // start.
    std::inclusive_scan(begin_.begin(), begin_.end(), begin_.begin());
    for_each_side([&](std::uint32_t corner, std::uint32_t a, std::uint32_t b) {
        uses_[--begin_[std::min(a, b)]] = {std::max(a, b), corner & (UINT32_MAX >> 1), a < b};
    });

    parallel_for(vertex_count, 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            std::sort(uses_.begin() + static_cast<std::ptrdiff_t>(begin_[v]),
                      uses_.begin() + static_cast<std::ptrdiff_t>(begin_[v + 1]),
                      [](const EdgeUse& a, const EdgeUse& b) {
                          return a.high != b.high ? a.high < b.high : a.corner < b.corner;
                      });
    });
}

DisjointSets::DisjointSets(std::size_t count) : parent_(huge_vector<std::uint32_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0u);
}

}
