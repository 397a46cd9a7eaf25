// Format: Wavefront (1993), and the vertex colours that many programs write after the coordinates of
// a 'v' line.
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/obj/obj_document.h"
#include "alcove/mesh/formats/text_scanner.h"
#include "alcove/mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>

namespace alcove {
namespace {

/// Keywords of lines that are kept as text only.
constexpr std::array<std::string_view, 37> text_keywords{
    "usemtl",    "mtllib", "g",      "o",     "s",        "l",        "p",    "vp",     "mg",     "deg",
    "bmat",      "step",   "cstype", "curv",  "curv2",    "surf",     "parm", "trim",   "hole",   "scrv",
    "sp",        "end",    "con",    "bevel", "c_interp", "d_interp", "lod",  "maplib", "usemap", "shadow_obj",
    "trace_obj", "ctech",  "stech",  "call",  "csh",      "res",      "bzp"};

/// The texture coordinate and normal of a corner, counted from 1; 0 for none.
struct CornerReference {
    std::uint32_t uv = 0, normal = 0;
};

/// The largest index of one kind and its position. It is checked at the end, as faces may precede their vertices.
struct LargestIndex {
    std::int64_t index = 0;
    const char* place = nullptr;
};

/// Ordered by vertex, then by value, to find the distinct normals of each vertex.
struct VertexNormal {
    std::uint32_t vertex;
    float x, y, z;
    auto operator<=>(const VertexNormal&) const = default;
};

class ObjReader {
  public:
    explicit ObjReader(const FileBytes& file)
        : file_(file), text_(file, file.begin(), obj_syntax), document_(std::make_shared<ObjDocument>()) {}

    Mesh read() {
        for (; !text_.at_end(); text_.next_line())
            read_line();
        check_range(largest_vertex_, mesh_.vertex_count(), "vertices");
        check_range(largest_uv_, uvs_.size(), "texture coordinates");
        check_range(largest_normal_, normals_.size(), "normals");
        finish_colors();
        finish_uvs();
        finish_normals();
        finish_document();
        return std::move(mesh_);
    }

  private:
    void read_line() {
        const char* const begin = text_.at();
        const std::string_view keyword = text_.peek();
        text_.move_to(begin + keyword.size());
        if (keyword == "v") {
            document_->vertex_lines.push_back(static_cast<std::size_t>(begin - file_.begin()));
            read_vertex();
        } else if (keyword == "f" || keyword == "fo") {
            read_face();
        } else if (keyword == "vt") {
            read_uv();
        } else if (keyword == "vn") {
            Vec3d n;
            for (int c = 0; c < 3; ++c)
                n[c] = number_on_line("a normal");
            normals_.push_back(unit_or_zero(n));
            check_line_end();
        } else {
            if (keyword == "usemtl")
                document_->material_uses.push_back({mesh_.face_count(), rest_of_line()});
            else if (keyword == "mtllib")
                document_->material_files.push_back(rest_of_line());
            const auto known = std::find(text_keywords.begin(), text_keywords.end(), keyword);
            if (known != text_keywords.end())
                ++text_lines_[static_cast<std::size_t>(known - text_keywords.begin())];
            else if (unknown_lines_++ == 0)
                first_unknown_ = keyword;
        }
    }

    /// The rest of the line without the blanks around it. Names of materials and files may contain blanks and '#'.
    std::string rest_of_line() const {
        const std::string_view rest(text_.at(), text_.bytes_left());
        const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
        const std::size_t first = line.find_first_not_of(" \t");
        return first == line.npos ? "" : std::string(line.substr(first, line.find_last_not_of(" \t") + 1 - first));
    }

    double number_on_line(const char* expected) {
        if (text_.at_line_end())
            text_.fail(std::string("the line ends early: ") + expected + " is missing; export the file again");
        return text_.number(expected);
    }

    void check_line_end() {
        if (!text_.at_line_end())
            text_.fail("unexpected " + in_quotes(text_.peek()) + " where the line should end; export the file again");
    }

    void read_uv() {
        const double u = number_on_line("a texture coordinate");
        const double v = text_.at_line_end() ? 0.0 : text_.number("a texture coordinate");
        if (!text_.at_line_end())
            text_.number("a third texture coordinate");
        uvs_.push_back(Vec2(static_cast<float>(u), static_cast<float>(v)));
        check_line_end();
    }

    void read_vertex() {
        std::array<double, 8> values{};
        std::size_t count = 0;
        for (; !text_.at_line_end() && count < values.size(); ++count)
            values[count] = text_.number("a coordinate");
        if (count != 3 && count != 4 && count != 6 && count != 7)
            text_.fail("a vertex of " + grouped(count) +
                       " numbers; x y z, x y z w or x y z r g b are expected; export the file again");
        mesh_.positions.push_back({values[0], values[1], values[2]});
        document_->weights += count == 4 && values[3] != 1.0;
        if (count >= 6) {
            colors_.resize(mesh_.vertex_count() - 1, no_color);
            colors_.push_back({values[3], values[4], values[5], count == 7 ? values[6] : -1.0});
        }
    }

    void read_face() {
        while (!text_.at_line_end()) {
            const char* const place = text_.at();
            const char* at = place;
            CornerReference reference;
            const std::uint32_t vertex = index_at(at, mesh_.vertex_count(), largest_vertex_, place);
            if (*at == '/') {
                ++at;
                if (*at != '/')
                    reference.uv = index_at(at, uvs_.size(), largest_uv_, place) + 1;
                if (*at == '/')
                    reference.normal = index_at(++at, normals_.size(), largest_normal_, place) + 1;
            }
            text_.move_to(at);
            if (!text_.at_token_end()) {
                text_.move_to(place);
                fail_corner();
            }
            mesh_.corners.push_back(vertex);
            has_uvs_ |= reference.uv != 0;
            has_normals_ |= reference.normal != 0;
            if (has_uvs_ || has_normals_) {
                references_.resize(mesh_.corners.size() - 1);
                references_.push_back(reference);
            }
        }
        close_face(mesh_);
    }

    [[noreturn]] void fail_corner() {
        text_.fail(in_quotes(text_.peek()) + " is not a corner of a face; whole numbers vertex, vertex/uv, "
                                             "vertex//normal or vertex/uv/normal are expected");
    }

    /// The index at `at`, counted from 0; a negative one counts back from the last of the `so_far` items read.
    std::uint32_t index_at(const char*& at, std::size_t so_far, LargestIndex& largest, const char* place) {
        const bool negative = *at == '-';
        at += negative ? 1 : 0;
        const char* const first = at;
        std::int64_t count = 0;
        for (; *at >= '0' && *at <= '9'; ++at)
            count = std::min<std::int64_t>(count * 10 + (*at - '0'), beyond_index);
        if (at == first)
            fail_corner();
        const std::int64_t index = negative ? static_cast<std::int64_t>(so_far) + 1 - count : count;
        if (count == 0 || index < 1 || index >= beyond_index)
            text_.fail("index " + in_quotes({negative ? first - 1 : first, at}) +
                       " is out of range: indices count from 1, or back from -1; export the file again");
        if (index > largest.index)
            largest = {index, place};
        return static_cast<std::uint32_t>(index - 1);
    }

    void check_range(const LargestIndex& largest, std::size_t count, const char* what) const {
        if (largest.index > static_cast<std::int64_t>(count))
            file_.fail_at_line(largest.place, "index " + std::to_string(largest.index) +
                                                  " is out of range: the file has " + grouped(count) + " " + what +
                                                  "; export it again");
    }

    void finish_colors() {
        if (colors_.empty())
            return;
        colors_.resize(mesh_.vertex_count(), no_color);
        double largest = 0.0;
        std::size_t without = 0;
        for (const auto& color : colors_)
            largest = std::max({largest, color[0], color[1], color[2]});
        const double scale = largest > 1.0 ? 1.0 : 255.0;
        const auto byte = [scale](double value) { return color_byte(value * scale); };
        for (const auto& [r, g, b, a] : colors_) {
            const bool colored = r >= 0.0 || g >= 0.0 || b >= 0.0;
            without += !colored;
            mesh_.vertex_colors.push_back(colored
                                              ? Color{byte(r), byte(g), byte(b), a < 0.0 ? std::uint8_t(255) : byte(a)}
                                              : Color{255, 255, 255, 255});
        }
        if (without > 0)
            mesh_.warnings.push_back(counted(without, "vertex has", "vertices have") +
                                     " no colour, unlike others; white is used");
    }

    void finish_uvs() {
        if (!has_uvs_)
            return;
        references_.resize(mesh_.corners.size());
        std::size_t without = 0;
        std::vector<std::uint32_t> first(mesh_.vertex_count(), unset);
        bool one_per_vertex = true;
        for (std::size_t c = 0; c < references_.size(); ++c) {
            const std::uint32_t uv = references_[c].uv;
            std::uint32_t& known = first[mesh_.corners[c]];
            without += uv == 0;
            if (known == unset)
                known = uv;
            one_per_vertex &= known == uv || (known != 0 && uv != 0 && uvs_[known - 1] == uvs_[uv - 1]);
        }
        const auto value = [&](std::uint32_t uv) { return uv == 0 || uv == unset ? Vec2(0.0f) : uvs_[uv - 1]; };
        if (one_per_vertex)
            for (const std::uint32_t uv : first)
                mesh_.vertex_uvs.push_back(value(uv));
        else
            for (const CornerReference& reference : references_)
                mesh_.corner_uvs.push_back(value(reference.uv));
        if (without > 0)
            mesh_.warnings.push_back(counted(without, "face corner has", "face corners have") +
                                     " no texture coordinate, unlike others; (0, 0) is used");
    }

    /// A vertex with several normals gets the normalized sum of the distinct ones.
    void finish_normals() {
        if (!has_normals_)
            return;
        references_.resize(mesh_.corners.size());
        std::vector<std::uint32_t> first(mesh_.vertex_count(), 0);
        std::vector<VertexNormal> others;
        for (std::size_t c = 0; c < references_.size(); ++c) {
            const std::uint32_t normal = references_[c].normal;
            std::uint32_t& known = first[mesh_.corners[c]];
            if (known == 0)
                known = normal;
            else if (normal != 0 && normal != known && normals_[normal - 1] != normals_[known - 1]) {
                const Vec3& n = normals_[normal - 1];
                others.push_back({mesh_.corners[c], n.x, n.y, n.z});
            }
        }
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        std::vector<Vec3d> sums;
        sums.reserve(first.size());
        for (const std::uint32_t normal : first)
            sums.push_back(normal == 0 ? Vec3d(0.0) : Vec3d(normals_[normal - 1]));
        std::size_t several = 0;
        for (std::size_t i = 0; i < others.size(); ++i) {
            sums[others[i].vertex] += Vec3d(others[i].x, others[i].y, others[i].z);
            several += i == 0 || others[i].vertex != others[i - 1].vertex;
        }
        for (const Vec3d& sum : sums)
            mesh_.normals.push_back(unit_or_zero(sum));
        if (several > 0)
            mesh_.warnings.push_back(counted(several, "vertex has", "vertices have") +
                                     " more than one normal; the direction of their sum is used");
    }

    void finish_document() {
        if (unknown_lines_ > 0)
            mesh_.warnings.push_back(counted(unknown_lines_, "line does", "lines do") +
                                     " not begin with an OBJ keyword, the first with " + in_quotes(first_unknown_) +
                                     "; kept as text");
        for (std::size_t k = 0; k < text_keywords.size(); ++k)
            if (text_lines_[k] > 0)
                document_->other_lines.emplace_back(in_quotes(text_keywords[k]) + " lines", text_lines_[k]);
        if (unknown_lines_ > 0)
            document_->other_lines.emplace_back("lines of unknown keywords", unknown_lines_);
        document_->text = file_.view();
        std::size_t comments = document_->text.starts_with('#');
        for (std::size_t at = 0; (at = document_->text.find("\n#", at)) != std::string::npos; ++at)
            ++comments;
        if (comments > 0)
            document_->other_lines.emplace_back("comment lines", comments);
        mesh_.source = document_;
    }

    static constexpr std::int64_t beyond_index = std::int64_t(1) << 32;
    static constexpr std::uint32_t unset = 0xffffffffu;
    static constexpr std::array<double, 4> no_color{-1.0, -1.0, -1.0, -1.0};

    const FileBytes& file_;
    TextScanner text_;
    std::shared_ptr<ObjDocument> document_;
    Mesh mesh_;
    std::vector<Vec2> uvs_;
    std::vector<Vec3> normals_;
    std::vector<std::array<double, 4>> colors_;
    std::vector<CornerReference> references_; ///< one per corner; empty until a corner has one
    bool has_uvs_ = false, has_normals_ = false;
    LargestIndex largest_vertex_, largest_uv_, largest_normal_;
    std::array<std::size_t, text_keywords.size()> text_lines_{};
    std::size_t unknown_lines_ = 0;
    std::string_view first_unknown_;
};

}

bool begins_as_obj(const FileBytes& file) {
    TextScanner text(file, file.begin(), obj_syntax);
    if (text.at_end())
        return false;
    const std::string_view keyword = text.peek();
    return keyword == "v" || keyword == "vt" || keyword == "vn" || keyword == "f" ||
           std::find(text_keywords.begin(), text_keywords.end(), keyword) != text_keywords.end();
}

Mesh read_obj(const FileBytes& file) {
    return ObjReader(file).read();
}

}
