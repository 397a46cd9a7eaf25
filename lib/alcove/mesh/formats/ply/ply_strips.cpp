#include "alcove/mesh/formats/ply/ply_strips.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/formats.h"

#include <algorithm>

namespace alcove {
namespace {

/// The index that separates strips: -1, or the largest value of an unsigned type, which cannot hold -1.
std::int64_t separator_of(PlyType type) {
    switch (type) {
    case PlyType::uint8:
        return 0xff;
    case PlyType::uint16:
        return 0xffff;
    case PlyType::uint32:
        return 0xffffffff;
    default:
        return -1;
    }
}

/// Turns the indices of strips into triangles.
class Strips {
  public:
    explicit Strips(Mesh& mesh) : mesh_(mesh) {}

    void add(std::uint32_t v) {
        if (length_ >= 2 && v != last_[0] && v != last_[1] && last_[0] != last_[1]) {
            const bool turned = length_ % 2 == 1;
            mesh_.corners.insert(mesh_.corners.end(), {last_[turned], last_[!turned], v});
            close_face(mesh_);
        }
        last_ = {last_[1], v};
        ++length_;
    }
    void end() {
        too_short_ += length_ == 1 || length_ == 2;
        length_ = 0;
    }
    std::size_t too_short() const { return too_short_; }

  private:
    Mesh& mesh_;
    std::array<std::uint32_t, 2> last_{};
    std::size_t length_ = 0, too_short_ = 0;
};

void add_triangles(const FileBytes& file, const PlyHeader& header, const PlyElement& element, Mesh& mesh) {
    const PlyProperty& list = *corner_list(element);
    const std::int64_t separator = separator_of(list.type);
    const auto vertices = static_cast<std::int64_t>(mesh.vertex_count());
    Strips strips(mesh);
    for_each_value(element, list, [&](std::size_t row, const std::byte* bytes) {
        std::int64_t left = integer_at(bytes, *list.count_type);
        bytes += size_of(*list.count_type);
        for (; left > 0; --left, bytes += size_of(list.type)) {
            const std::int64_t index = integer_at(bytes, list.type);
            if (index >= 0 && index < vertices)
                strips.add(static_cast<std::uint32_t>(index));
            else if (index == separator)
                strips.end();
            else
                fail_in_row(file, header, element, row, static_cast<std::size_t>(bytes - element.rows.data()),
                            "vertex index " + std::to_string(index) + " is out of range: there are " +
                                grouped(mesh.vertex_count()) + " vertices, counted from 0; export the file again");
        }
        strips.end();
    });
    if (strips.too_short() > 0)
        mesh.warnings.push_back(counted(strips.too_short(), "triangle strip has", "triangle strips have") +
                                " fewer than three vertices; left out");
}

}

void read_strips(const FileBytes& file, PlyHeader& header, Mesh& mesh) {
    std::vector<PlyElement>& elements = header.document.elements;
    const auto strips = std::find_if(elements.begin(), elements.end(),
                                     [](const PlyElement& element) { return element.name == "tristrips"; });
    add_triangles(file, header, *strips, mesh);
    if (mesh.face_count() == 0)
        file.fail("its triangle strips contain no triangle; export it with faces");
    for (const PlyProperty& property : strips->properties)
        if (&property != corner_list(*strips))
            mesh.warnings.push_back("the property " + in_quotes(property.name) +
                                    " of the triangle strips is left out, since they are written as faces");
    *strips = face_element(mesh);
    elements.erase(
        std::remove_if(elements.begin(), elements.end(),
                       [&](const PlyElement& element) { return element.name == "face" && element.count == 0; }),
        elements.end());
}

}
