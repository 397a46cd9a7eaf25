// Format: Wavefront (1993), and the vertex colours that many programs write after the coordinates of
// a 'v' line.
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/obj/obj_document.h"
#include "alcove/mesh/formats/obj/obj_keywords.h"
#include "alcove/mesh/formats/obj/obj_mrgb.h"
#include "alcove/mesh/formats/obj/obj_values.h"
#include "alcove/mesh/formats/text_scanner.h"
#include "alcove/mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace alcove {
namespace {

class ObjReader {
  public:
    explicit ObjReader(const FileBytes& file)
        : file_(file), text_(file, file.begin(), obj_syntax), document_(std::make_shared<ObjDocument>()) {}

    Mesh read() {
        for (; !text_.at_end(); text_.next_line())
            read_line();
        check_vertex_range();
        add_values(mesh_, values_, file_);
        add_mrgb();
        warn_of_rest();
        finish_document();
        return std::move(mesh_);
    }

  private:
    void read_line() {
        const char* const begin = text_.at();
        const std::string_view keyword = text_.peek();
        text_.move_to(begin + keyword.size());
        if (keyword == "v") {
            document_->vertex_lines.push_back(offset_of(begin));
            read_vertex();
        } else if (keyword == "f" || keyword == "fo") {
            read_face();
        } else if (keyword == "vt") {
            read_uv(begin);
        } else if (keyword == "vn") {
            read_normal(begin);
        } else {
            read_other(keyword);
        }
    }

    /// The rest of the line without the blanks around it. Names of materials and files may contain blanks and '#'.
    std::string rest_of_line() const {
        const std::string_view rest(text_.at(), text_.bytes_left());
        const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
        const std::size_t first = line.find_first_not_of(" \t");
        return first == line.npos ? "" : std::string(line.substr(first, line.find_last_not_of(" \t") + 1 - first));
    }

    void read_other(std::string_view keyword) {
        if (keyword == "o" || keyword == "g" || keyword == "usemtl") {
            (keyword == "o"   ? object_
             : keyword == "g" ? group_
                              : material_) = rest_of_line().substr(0, FaceGroup::most_letters);
            starts_group_ = true;
        }
        if (keyword == "usemtl")
            document_->material_uses.push_back({mesh_.face_count(), rest_of_line()});
        else if (keyword == "mtllib")
            document_->material_files.push_back(rest_of_line());
        if (const auto known = obj_text_keyword(keyword)) {
            ++text_lines_[*known];
            if (names_files(keyword))
                document_->file_lines.push_back(offset_of(keyword.data()));
            return;
        }
        if (hides_data_keyword(keyword)) {
            text_.move_to(keyword.data());
            text_.fail(in_quotes(keyword) +
                       " is not an OBJ keyword; remove the characters before or after the keyword");
        }
        if (unknown_lines_++ == 0)
            first_unknown_ = keyword;
    }

    std::size_t offset_of(const char* place) const { return static_cast<std::size_t>(place - file_.begin()); }

    /// Reads the rest of the line; tokens that are not numbers become NaN. \return whether there are from `least` to
    /// `values.size()` tokens, all of them finite numbers.
    bool read_values(std::span<double> values, std::size_t least) {
        std::size_t count = 0;
        bool finite = true;
        for (; !text_.at_line_end(); ++count) {
            const double value = text_.number_or_nan();
            finite &= std::isfinite(value);
            if (count < values.size())
                values[count] = value;
        }
        return finite && count >= least && count <= values.size();
    }

    void read_uv(const char* line) {
        std::array<double, 3> values{};
        if (!read_values(values, 1))
            values_.damaged_uvs.add(line);
        const auto finite_or_zero = [](double value) {
            return std::isfinite(value) ? static_cast<float>(value) : 0.0f;
        };
        values_.uvs.emplace_back(finite_or_zero(values[0]), finite_or_zero(values[1]));
    }

    void read_normal(const char* line) {
        constexpr double missing = std::numeric_limits<double>::quiet_NaN();
        std::array<double, 3> values{missing, missing, missing};
        if (!read_values(values, 3))
            values_.damaged_normals.add(line);
        values_.normals.push_back(unit_or_zero({values[0], values[1], values[2]}));
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
            values_.colors.resize(mesh_.vertex_count() - 1, ObjValues::no_color);
            values_.colors.push_back({values[3], values[4], values[5], count == 7 ? values[6] : -1.0});
        }
    }

    /// Starts a group of faces, at the first face after a line that names an object, a group or a material.
    void add_group() {
        starts_group_ = false;
        if (mesh_.groups.empty() && mesh_.face_count() > 0)
            mesh_.groups.emplace_back();
        FaceGroup& group = mesh_.groups.emplace_back();
        group.first_face = static_cast<std::uint32_t>(mesh_.face_count());
        for (const std::string& name : {object_, group_, material_})
            if (!name.empty())
                group.names.push_back(name);
    }

    void read_face() {
        if (starts_group_)
            add_group();
        while (!text_.at_line_end()) {
            const char* const place = text_.at();
            const char* at = place;
            const std::uint32_t vertex = vertex_at(at);
            CornerReference reference;
            if (*at == '/') {
                reference.uv = reference_at(++at, values_.uvs.size(), values_.uv_references);
                if (*at == '/')
                    reference.normal = reference_at(++at, values_.normals.size(), values_.normal_references);
            }
            text_.move_to(at);
            if (!text_.at_token_end()) {
                text_.move_to(place);
                fail_corner();
            }
            mesh_.corners.push_back(vertex);
            if (reference.uv != 0 || reference.normal != 0 || !values_.corners.empty()) {
                values_.corners.resize(mesh_.corners.size() - 1);
                values_.corners.push_back(reference);
            }
        }
        close_face(mesh_);
    }

    [[noreturn]] void fail_corner() {
        text_.fail(in_quotes(text_.peek()) + " is not a corner of a face; whole numbers vertex, vertex/uv, "
                                             "vertex//normal or vertex/uv/normal are expected");
    }

    /// The signed whole number at `at`, limited to the range of an index; moves past it.
    std::int64_t integer_at(const char*& at) {
        const bool negative = *at == '-';
        at += negative ? 1 : 0;
        const char* const first = at;
        std::int64_t value = 0;
        for (; *at >= '0' && *at <= '9'; ++at)
            value = std::min<std::int64_t>(value * 10 + (*at - '0'), beyond_index);
        if (at == first)
            fail_corner();
        return negative ? -value : value;
    }

    /// The vertex index at `at`, converted to count from 0. A negative one counts back from the last vertex read.
    std::uint32_t vertex_at(const char*& at) {
        const char* const place = at;
        const std::int64_t value = integer_at(at);
        const std::int64_t index = value < 0 ? static_cast<std::int64_t>(mesh_.vertex_count()) + 1 + value : value;
        if (index < 1 || index >= beyond_index)
            text_.fail("index " + in_quotes({place, at}) +
                       " is out of range: indices count from 1, or back from -1; export the file again");
        if (index > largest_vertex_) {
            largest_vertex_ = index;
            largest_vertex_at_ = place;
        }
        return static_cast<std::uint32_t>(index - 1);
    }

    /// The reference at `at` to one of the texture coordinates or normals, counted from 1; 0 if there is none, or if
    /// its index is out of range for any file.
    std::uint32_t reference_at(const char*& at, std::size_t so_far, References& references) {
        if (*at != '-' && !(*at >= '0' && *at <= '9'))
            return 0;
        const char* const place = at;
        const std::int64_t value = integer_at(at);
        const std::int64_t index = value < 0 ? static_cast<std::int64_t>(so_far) + 1 + value : value;
        if (index < 1 || index >= beyond_index) {
            if (references.missing++ == 0)
                references.missing_at = place;
            return 0;
        }
        if (index > references.largest) {
            references.largest = index;
            references.largest_at = place;
        }
        return static_cast<std::uint32_t>(index);
    }

    void check_vertex_range() const {
        if (largest_vertex_ > static_cast<std::int64_t>(mesh_.vertex_count()))
            file_.fail_at_line(largest_vertex_at_, "index " + std::to_string(largest_vertex_) +
                                                       " is out of range: the file has " +
                                                       grouped(mesh_.vertex_count()) + " vertices; export it again");
    }

    void add_mrgb() {
        MrgbColors mrgb = read_mrgb(without_byte_order_mark(file_.view()));
        document_->mrgb_lines = mrgb.lines;
        if (mrgb.lines == 0)
            return;
        const std::string unused = "the colours in '#MRGB' lines are not used: ";
        if (!mesh_.vertex_colors.empty())
            mesh_.warnings.push_back(unused + "the vertex lines have colours too");
        else if (mrgb.damaged_lines > 0)
            mesh_.warnings.push_back(unused + grouped(mrgb.damaged_lines) + " of " + grouped(mrgb.lines) +
                                     " lines cannot be read");
        else if (mrgb.colors.size() != mesh_.vertex_count())
            mesh_.warnings.push_back(unused + "there are " + grouped(mrgb.colors.size()) + " for " +
                                     counted(mesh_.vertex_count(), "vertex", "vertices"));
        else
            mesh_.vertex_colors = std::move(mrgb.colors);
    }

    void warn_of_rest() {
        if (unknown_lines_ > 0) {
            const std::string first = in_quotes(first_unknown_);
            if (mesh_.vertex_count() == 0)
                file_.fail_at_line(first_unknown_.data(), first + " is not an OBJ keyword; is this an OBJ file?");
            mesh_.warnings.push_back(
                counted(unknown_lines_, "line does", "lines do") + " not begin with an OBJ keyword (first: line " +
                grouped(file_.line_at(first_unknown_.data())) + " with " + first + "); kept as text");
        }
        if (text_.padding() > 0)
            mesh_.warnings.push_back(counted(text_.padding(), "byte (NUL or Ctrl-Z) after the last line was",
                                             "bytes (NUL or Ctrl-Z) after the last line were") +
                                     " ignored");
    }

    void finish_document() {
        for (std::size_t k = 0; k < obj_text_keywords.size(); ++k)
            if (text_lines_[k] > 0)
                document_->other_lines.emplace_back(in_quotes(obj_text_keywords[k]) + " lines", text_lines_[k]);
        if (unknown_lines_ > 0)
            document_->other_lines.emplace_back("lines of unknown keywords", unknown_lines_);
        document_->text = file_.view();
        document_->keeper = file_.keeper();
        document_->folder = file_.path().parent_path();
        std::size_t comments = without_byte_order_mark(document_->text).starts_with('#');
        for (std::size_t at = 0; (at = document_->text.find("\n#", at)) != std::string::npos; ++at)
            ++comments;
        if (comments > 0)
            document_->other_lines.emplace_back("comment lines", comments);
        mesh_.source = document_;
    }

    static constexpr std::int64_t beyond_index = std::int64_t(1) << 32;

    const FileBytes& file_;
    TextScanner text_;
    std::shared_ptr<ObjDocument> document_;
    Mesh mesh_;
    ObjValues values_;
    std::string object_, group_, material_; ///< names that apply to the next faces
    bool starts_group_ = false;
    std::int64_t largest_vertex_ = 0; ///< checked at the end, as faces may precede their vertices
    const char* largest_vertex_at_ = nullptr;
    std::array<std::size_t, obj_text_keywords.size()> text_lines_{};
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
           obj_text_keyword(keyword).has_value();
}

Mesh read_obj(const FileBytes& file) {
    return ObjReader(file).read();
}

}
