#include "alcove/mesh/formats/obj/obj_values.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/normals.h"

#include <algorithm>
#include <compare>

namespace alcove {
namespace {

constexpr std::uint32_t unset = 0xffffffffu;

/// A normal of a vertex. Ordered by vertex, then by value, to find the distinct normals of each vertex.
struct VertexNormal {
    std::uint32_t vertex;
    float x, y, z;
    auto operator<=>(const VertexNormal&) const = default;
};

class ValueAdder {
  public:
    ValueAdder(Mesh& mesh, ObjValues& values, const FileBytes& file) : mesh_(mesh), values_(values), file_(file) {}

    void add_all() {
        if (!values_.corners.empty())
            values_.corners.resize(mesh_.corners.size());
        warn_of(values_.damaged_uvs, "'vt'", "1 to 3", "a number that cannot be read counts as 0");
        warn_of(values_.damaged_normals, "'vn'", "3", "where a normal cannot be read, the normal of the faces is used");
        drop_missing(&CornerReference::uv, values_.uv_references, values_.uvs.size(), "texture coordinates");
        drop_missing(&CornerReference::normal, values_.normal_references, values_.normals.size(), "normals");
        add_colors();
        add_uvs();
        add_normals();
    }

  private:
    void warn(std::size_t count, const char* singular, const char* plural, const std::string& rest) {
        if (count > 0)
            mesh_.warnings.push_back(counted(count, singular, plural) + " " + rest);
    }

    void warn_of(const DamagedLines& lines, const std::string& keyword, const char* numbers, const char* effect) {
        const std::string singular = keyword + " line does", plural = keyword + " lines do";
        warn(lines.count, singular.c_str(), plural.c_str(),
             std::string("not hold ") + numbers + " finite numbers (first: line " +
                 grouped(file_.line_at(lines.first)) + "); " + effect);
    }

    /// Removes the references to items that the file does not have.
    void drop_missing(std::uint32_t CornerReference::*index, const References& references, std::size_t count,
                      const std::string& what) {
        std::size_t missing = references.missing;
        if (references.largest > static_cast<std::int64_t>(count))
            for (CornerReference& corner : values_.corners)
                if (corner.*index > count) {
                    corner.*index = 0;
                    ++missing;
                }
        if (missing == 0)
            return;
        const char* const place = references.missing > 0 ? references.missing_at : references.largest_at;
        warn(missing, "face corner names", "face corners name",
             what + " that the file does not have, for example in line " + grouped(file_.line_at(place)) +
                 "; they are ignored");
    }

    void add_colors() {
        if (values_.colors.empty())
            return;
        values_.colors.resize(mesh_.vertex_count(), ObjValues::no_color);
        double largest = 0.0;
        std::size_t without = 0;
        for (const auto& color : values_.colors)
            largest = std::max({largest, color[0], color[1], color[2]});
        const double scale = largest > 1.0 ? 1.0 : 255.0;
        const auto byte = [scale](double value) { return color_byte(value * scale); };
        for (const auto& [r, g, b, a] : values_.colors) {
            const bool colored = r >= 0.0 || g >= 0.0 || b >= 0.0;
            without += !colored;
            mesh_.vertex_colors.push_back(colored
                                              ? Color{byte(r), byte(g), byte(b), a < 0.0 ? std::uint8_t(255) : byte(a)}
                                              : Color{255, 255, 255, 255});
        }
        warn(without, "vertex has", "vertices have", "no colour, unlike others; white is used");
    }

    void add_uvs() {
        const auto& corners = values_.corners;
        if (std::none_of(corners.begin(), corners.end(), [](const CornerReference& c) { return c.uv != 0; }))
            return;
        std::size_t without = 0;
        std::vector<std::uint32_t> first(mesh_.vertex_count(), unset);
        bool one_per_vertex = true;
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const std::uint32_t uv = corners[c].uv;
            std::uint32_t& known = first[mesh_.corners[c]];
            without += uv == 0;
            if (known == unset)
                known = uv;
            one_per_vertex &= known == uv || (known != 0 && uv != 0 && values_.uvs[known - 1] == values_.uvs[uv - 1]);
        }
        const auto value = [&](std::uint32_t uv) { return uv == 0 || uv == unset ? Vec2(0.0f) : values_.uvs[uv - 1]; };
        if (one_per_vertex)
            for (const std::uint32_t uv : first)
                mesh_.vertex_uvs.push_back(value(uv));
        else
            for (const CornerReference& corner : corners)
                mesh_.corner_uvs.push_back(value(corner.uv));
        warn(without, "face corner has", "face corners have", "no texture coordinate, unlike others; (0, 0) is used");
    }

    /// The index of the normal of a corner, counted from 1; 0 if there is no normal or it has no direction.
    std::uint32_t normal_of(const CornerReference& corner) const {
        return corner.normal != 0 && values_.normals[corner.normal - 1] != Vec3(0.0f) ? corner.normal : 0;
    }

    /// A vertex with several normals gets the normalized sum of the distinct ones.
    void add_normals() {
        const auto& corners = values_.corners;
        if (std::none_of(corners.begin(), corners.end(), [&](const CornerReference& c) { return normal_of(c) != 0; }))
            return;
        std::vector<std::uint32_t> first(mesh_.vertex_count(), 0);
        std::vector<VertexNormal> others;
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const std::uint32_t normal = normal_of(corners[c]);
            std::uint32_t& known = first[mesh_.corners[c]];
            if (known == 0)
                known = normal;
            else if (normal != 0 && normal != known && values_.normals[normal - 1] != values_.normals[known - 1]) {
                const Vec3& n = values_.normals[normal - 1];
                others.push_back({mesh_.corners[c], n.x, n.y, n.z});
            }
        }
        if (!others.empty())
            for (const CornerReference& corner : corners)
                mesh_.corner_normals.push_back(normal_of(corner) == 0 ? Vec3(0.0f)
                                                                      : values_.normals[corner.normal - 1]);
        add_sums(first, others);
    }

    void add_sums(const std::vector<std::uint32_t>& first, std::vector<VertexNormal>& others) {
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        std::vector<Vec3d> sums;
        sums.reserve(first.size());
        for (const std::uint32_t normal : first)
            sums.push_back(normal == 0 ? Vec3d(0.0) : Vec3d(values_.normals[normal - 1]));
        for (const VertexNormal& other : others)
            sums[other.vertex] += Vec3d(other.x, other.y, other.z);
        for (const Vec3d& sum : sums)
            mesh_.normals.push_back(unit_or_zero(sum));
    }

    Mesh& mesh_;
    ObjValues& values_;
    const FileBytes& file_;
};

}

void add_values(Mesh& mesh, ObjValues& values, const FileBytes& file) {
    ValueAdder(mesh, values, file).add_all();
}

}
