#include "alcove/mesh/detail/outlier_faces.h"

#include "alcove/base/detail/messages.h"

#include <fmt/format.h>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <vector>

namespace alcove {
namespace {

constexpr double small_share = 0.1; // of the diagonal

Box box_of(const Mesh& mesh, std::size_t face) {
    Box box;
    for (const std::uint32_t v : mesh.face(face))
        if (is_finite(mesh.positions[v]))
            box.add(mesh.positions[v]);
    return box;
}

/// The bounding box without the `few` faces that reach farthest towards each of its six sides.
Box trimmed(const std::vector<Box>& boxes, std::size_t few) {
    Box result;
    std::vector<double> ends(boxes.size());
    const auto nth = static_cast<std::ptrdiff_t>(few);
    for (int axis = 0; axis < 3; ++axis) {
        std::transform(boxes.begin(), boxes.end(), ends.begin(), [&](const Box& box) { return box.min[axis]; });
        std::nth_element(ends.begin(), ends.begin() + nth, ends.end());
        result.min[axis] = ends[few];
        std::transform(boxes.begin(), boxes.end(), ends.begin(), [&](const Box& box) { return -box.max[axis]; });
        std::nth_element(ends.begin(), ends.begin() + nth, ends.end());
        result.max[axis] = -ends[few];
    }
    return result;
}

/// The largest number of faces that may count as outliers.
std::size_t few_of(std::size_t faces) {
    constexpr std::size_t min_few = 2, one_in = 100;
    return std::max(min_few, faces / one_in);
}

/// Whether a sample of the faces, without the outermost ones, spreads over at least `small_share` of the diagonal.
bool spreads(const Mesh& mesh) {
    constexpr std::size_t most = 4096;
    std::vector<Box> sample;
    for (std::size_t i = 0; i < most; ++i)
        if (const Box box = box_of(mesh, i * mesh.face_count() / most); !box.empty())
            sample.push_back(box);
    const std::size_t few = 2 * few_of(sample.size());
    return sample.size() > few && trimmed(sample, few).diagonal() >= small_share * mesh.box().diagonal();
}

}

std::optional<OutlierFaces> find_outlier_faces(const Mesh& mesh) {
    constexpr std::size_t many_faces = 10'000;
    if (mesh.face_count() > many_faces && spreads(mesh))
        return {};
    std::vector<Box> boxes;
    std::vector<std::size_t> faces;
    Box whole;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        if (const Box box = box_of(mesh, f); !box.empty()) {
            boxes.push_back(box);
            faces.push_back(f);
            whole.add(box.min);
            whole.add(box.max);
        }
    const std::size_t few = few_of(boxes.size());
    if (boxes.size() < 4 * few)
        return {};
    const Box most = trimmed(boxes, few);
    const double allowed = small_share * whole.diagonal();
    if (most.empty() || most.diagonal() >= allowed)
        return {};
    const Vec3d margin(most.diagonal());
    OutlierFaces outliers{0, 0, {}};
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (glm::all(glm::greaterThanEqual(boxes[i].min, most.min - margin)) &&
            glm::all(glm::lessThanEqual(boxes[i].max, most.max + margin))) {
            outliers.rest.add(boxes[i].min);
            outliers.rest.add(boxes[i].max);
        } else {
            outliers.example = faces[i];
            ++outliers.count;
        }
    }
    if (outliers.count == 0 || outliers.count > few || outliers.rest.diagonal() >= allowed)
        return {};
    return outliers;
}

std::string OutlierFaces::text(const Mesh& mesh) const {
    const bool single = count == 1;
    return fmt::format("{} of {} faces, {}face {}, {} the diagonal of the bounding box {:.3g} instead of {:.3g}",
                       grouped(count), grouped(mesh.face_count()), single ? "" : "such as ", grouped(example + 1),
                       single ? "makes" : "make", mesh.box().diagonal(), rest.diagonal());
}

}
