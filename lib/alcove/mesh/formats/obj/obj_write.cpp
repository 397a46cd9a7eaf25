#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/obj/obj_document.h"
#include "alcove/mesh/formats/obj/obj_file_names.h"
#include "alcove/mesh/formats/text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

namespace alcove {
namespace {

using Buffer = fmt::memory_buffer;

void append(Buffer& to, std::string_view text) {
    to.append(text.data(), text.data() + text.size());
}

/// Appends the shortest decimal that reads back as the same value, as a float if the value is a float, otherwise as a
/// double.
void append_number(Buffer& to, double value) {
    const auto single = static_cast<float>(value);
    if (static_cast<double>(single) == value)
        fmt::format_to(std::back_inserter(to), " {}", single);
    else
        fmt::format_to(std::back_inserter(to), " {}", value);
}

/// Writes bytes as decimals, such as " 0.5020" for 128. Four decimals distinguish all 256 values.
class ColorWriter {
  public:
    ColorWriter() {
        for (std::size_t i = 0; i < decimals_.size(); ++i)
            decimals_[i] = fmt::format(" {:.4f}", static_cast<double>(i) / 255.0);
    }
    void append_to(Buffer& to, const Color& color) const {
        for (std::size_t c = 0; c < 3; ++c)
            append(to, decimals_[color[c]]);
    }

  private:
    std::array<std::string, 256> decimals_;
};

/// Copies a text piece by piece, and makes the replacements in it.
class TextCopy {
  public:
    TextCopy(std::string_view text, const std::vector<Replacement>& replacements)
        : text_(text), next_(replacements.begin()), last_(replacements.end()) {
        to_.reserve(text.size());
    }
    Buffer& to() { return to_; }

    /// Copies up to `end`, which no replacement crosses.
    void copy_until(std::size_t end) {
        check_cancelled();
        for (; next_ != last_ && next_->begin < end; ++next_) {
            append(to_, text_.substr(from_, next_->begin - from_));
            append(to_, next_->text);
            from_ = next_->end;
        }
        append(to_, text_.substr(from_, end - from_));
        from_ = end;
    }
    void skip_until(std::size_t end) { from_ = end; }

  private:
    std::string_view text_;
    std::vector<Replacement>::const_iterator next_, last_;
    std::size_t from_ = 0;
    Buffer to_;
};

/// Puts the colours in place of whatever follows x y z on each 'v' line.
void recolor(TextCopy& copy, const ObjDocument& document, const FileBytes& text, const std::vector<Color>& colors) {
    const ColorWriter writer;
    const auto offset = [&](const char* place) { return static_cast<std::size_t>(place - text.begin()); };
    TextScanner line(text, text.begin(), obj_syntax);
    for (std::size_t v = 0; v < colors.size(); ++v) {
        line.move_to(text.begin() + document.vertex_lines[v] + 1);
        for (int c = 0; c < 3; ++c)
            line.word("a coordinate");
        copy.copy_until(offset(line.at()));
        writer.append_to(copy.to(), colors[v]);
        const char* rest = line.at();
        for (; !line.at_line_end(); rest = line.at())
            line.word("a number");
        copy.skip_until(offset(rest));
    }
}

/// Writes the text of the input. \return messages about changes other than colours, and about what the colours replace.
std::vector<std::string> write_text(AtomicFile& output, const ObjDocument& document, const Mesh& mesh,
                                    const std::filesystem::path& file) {
    if (mesh.added_colors.empty() && document.file_lines.empty()) {
        output.write(document.text);
        return {};
    }
    const FileBytes text(file, document.text);
    MovedNames names = moved_names(document, text, file.parent_path());
    TextCopy copy(document.text, names.replacements);
    if (!mesh.added_colors.empty())
        recolor(copy, document, text, mesh.added_colors);
    copy.copy_until(document.text.size());
    output.write({copy.to().data(), copy.to().size()});
    if (!mesh.added_colors.empty() && document.weights > 0)
        names.warnings.push_back("not stored in OBJ: the weights of " +
                                 counted(document.weights, "vertex", "vertices") + ", which the colours replace");
    if (!mesh.added_colors.empty() && document.mrgb_lines > 0)
        names.warnings.push_back(counted(document.mrgb_lines, "'#MRGB' line still holds", "'#MRGB' lines still hold") +
                                 " the colours of the input; programs that read them show those, not the new ones");
    return std::move(names.warnings);
}

Buffer composed(const Mesh& mesh) {
    Buffer to;
    for (std::string comment : mesh.added_comments) {
        std::replace_if(
            comment.begin(), comment.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        append(to, "# " + comment + "\n");
    }
    const ColorWriter writer;
    const std::vector<Color>& colors = mesh.added_colors.empty() ? mesh.vertex_colors : mesh.added_colors;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        check_cancelled();
        append(to, "v");
        for (int c = 0; c < 3; ++c)
            append_number(to, mesh.positions[v][c]);
        if (!colors.empty())
            writer.append_to(to, colors[v]);
        append(to, "\n");
    }
    const bool has_uvs = !mesh.vertex_uvs.empty() || !mesh.corner_uvs.empty();
    for (const Vec2& uv : mesh.vertex_uvs.empty() ? mesh.corner_uvs : mesh.vertex_uvs)
        fmt::format_to(std::back_inserter(to), "vt {} {}\n", uv.x, uv.y);
    for (const Vec3& n : mesh.normals)
        fmt::format_to(std::back_inserter(to), "vn {} {} {}\n", n.x, n.y, n.z);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        check_cancelled();
        append(to, "f");
        for (std::size_t c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c) {
            const fmt::format_int vertex(std::size_t(mesh.corners[c]) + 1);
            append(to, " ");
            append(to, {vertex.data(), vertex.size()});
            if (!has_uvs && mesh.normals.empty())
                continue;
            append(to, "/");
            if (!mesh.corner_uvs.empty())
                append(to, fmt::format_int(c + 1).str());
            else if (has_uvs)
                append(to, {vertex.data(), vertex.size()});
            if (mesh.normals.empty())
                continue;
            append(to, "/");
            append(to, {vertex.data(), vertex.size()});
        }
        append(to, "\n");
    }
    return to;
}

}

std::vector<std::string> write_obj(const Mesh& mesh, const std::filesystem::path& file) {
    std::vector<std::string> lost;
    for (const Attribute& attribute : mesh.attributes)
        if (mesh.added_colors.empty() ||
            (attribute.name != "ao" && attribute.name != "quality")) // these two equal the colours
            lost.push_back("not stored in OBJ: attribute " + in_quotes(attribute.name));
    const std::vector<Color>& colors = mesh.added_colors.empty() ? mesh.vertex_colors : mesh.added_colors;
    if (std::any_of(colors.begin(), colors.end(), [](const Color& c) { return c[3] != 255; }))
        lost.push_back("not stored in OBJ: the alpha of the vertex colours");

    AtomicFile output(file);
    const auto* text = dynamic_cast<const ObjDocument*>(mesh.source.get());
    if (text != nullptr && text->vertex_lines.size() == mesh.vertex_count()) {
        for (std::string& message : write_text(output, *text, mesh, file))
            lost.push_back(std::move(message));
    } else {
        if (mesh.source != nullptr)
            for (const std::string& content : mesh.source->contents())
                lost.push_back("not stored in OBJ: " + content);
        if (!mesh.face_colors.empty())
            lost.push_back("not stored in OBJ: the colours of the faces");
        const Buffer bytes = composed(mesh);
        output.write({bytes.data(), bytes.size()});
    }
    output.commit();
    return lost;
}

}
