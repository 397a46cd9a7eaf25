// Format: the Geomview manual, [ST][C][N][4][n]OFF [BINARY].
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/byte_reader.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/off/off_layout.h"
#include "alcove/mesh/formats/text_scanner.h"
#include "alcove/mesh/normals.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// Limit for counting tokens on the rest of a line: more than the values that a vertex can declare.
constexpr std::size_t most_tokens = 16;

/// The order of the groups is chosen from the values of this many vertices.
constexpr std::size_t sampled_vertices = 1000;

/// Colours as in the file. Whether they range to 1 or to 255 is known only after all are read.
class ColorList {
  public:
    void add(std::size_t index, const std::array<double, 4>& rgba, std::size_t components, bool fraction) {
        indices_.push_back(index);
        values_.push_back(rgba);
        if (components < 4)
            values_.back()[3] = -1.0;
        fraction_ |= fraction;
        for (std::size_t c = 0; c < components; ++c)
            largest_ = std::max(largest_, rgba[c]);
    }
    std::size_t size() const { return indices_.size(); }

    /// `count` colours. Elements without a colour get the default of the format, a grey of two thirds.
    std::vector<Color> resolved(std::size_t count) const {
        std::vector<Color> colors(count, Color{170, 170, 170, 255});
        const double scale = fraction_ || largest_ <= 1.0 ? 255.0 : 1.0;
        const auto byte = [scale](double value) { return color_byte(value * scale); };
        for (std::size_t i = 0; i < indices_.size(); ++i) {
            const auto& [r, g, b, a] = values_[i];
            colors[indices_[i]] = {byte(r), byte(g), byte(b), a < 0.0 ? std::uint8_t(255) : byte(a)};
        }
        return colors;
    }

  private:
    std::vector<std::size_t> indices_;
    std::vector<std::array<double, 4>> values_;
    bool fraction_ = false;
    double largest_ = 0.0;
};

class OffReader {
  public:
    explicit OffReader(const FileBytes& file) : file_(file), text_(file, file.begin(), off_syntax) {}

    Mesh read() {
        read_keyword();
        if (binary_)
            read_binary();
        else
            read_text();
        if (vertex_colors_.size() > 0)
            mesh_.vertex_colors = vertex_colors_.resolved(vertices_);
        if (face_colors_.size() > 0) {
            mesh_.face_colors = face_colors_.resolved(faces_);
            if (face_colors_.size() < faces_)
                warn(faces_ - face_colors_.size(), "face has", "faces have", "no colour, unlike others; grey is used");
        }
        warn_of_order();
        if (map_indices_ > 0)
            warn(map_indices_, "colour is an index", "colours are indices",
                 "into a colour map that is not in the file; left out");
        if (undeclared_ > 0)
            warn(undeclared_, "vertex line has", "vertex lines have",
                 "more values than the header keyword declares (COFF, NOFF, ...); left out");
        return std::move(mesh_);
    }

  private:
    void warn(std::size_t count, const char* singular, const char* plural, const char* rest) {
        mesh_.warnings.push_back(counted(count, singular, plural) + " " + rest);
    }

    void read_keyword() {
        if (text_.at_end())
            text_.fail_early("the number of vertices");
        const std::string_view keyword = text_.peek();
        if (const auto layout = off_layout(keyword)) {
            layout_ = *layout;
            text_.move_to(keyword.data() + layout->keyword.size());
            if (!text_.at_line_end() && text_.peek() == "BINARY") {
                text_.word("BINARY");
                binary_ = true;
            }
        } else if (keyword.empty() || !(keyword[0] >= '0' && keyword[0] <= '9')) {
            text_.fail(in_quotes(keyword) +
                       " is not an OFF keyword; a file begins with [ST][C][N][4][n]OFF or its counts");
        }
    }

    void check_counts(std::int64_t vertices, std::int64_t faces, std::size_t vertex_bytes, std::size_t face_bytes,
                      std::size_t left, const auto& fail) {
        if (vertices < 0 || faces < 0)
            fail("a count is negative; export the file again");
        vertices_ = static_cast<std::size_t>(vertices);
        faces_ = static_cast<std::size_t>(faces);
        if (vertices_ > (left + 1) / vertex_bytes || faces_ > (left + 1) / face_bytes)
            fail(counted(vertices_, "vertex", "vertices") + " and " + counted(faces_, "face", "faces") +
                 " are declared but only " + grouped(left) + " bytes follow; copy or export the file again");
        mesh_.positions.reserve(vertices_);
        mesh_.face_begin.reserve(faces_ + 1);
    }

    void read_text() {
        if (layout_.dimension && text_.integer("the dimension") != 3)
            text_.fail("vertices of a dimension other than 3 cannot be read; export a plain OFF file");
        text_.at_end();
        const char* const counts = text_.at();
        const std::int64_t vertices = text_.integer("the number of vertices");
        const std::int64_t faces = text_.integer("the number of faces");
        if (!text_.at_line_end() || next_line_is_one_number())
            text_.integer("the number of edges");
        // The shortest vertex is "0 0 0\n", the shortest face "0\n"; the last line end may be missing.
        check_counts(vertices, faces, 6, 2, text_.bytes_left(),
                     [&](const std::string& message) { file_.fail_at_line(counts, message); });
        if (layout_.groups.size() > 1)
            choose_order();
        for (std::size_t v = 0; v < vertices_; ++v)
            read_text_vertex(v);
        if (faces_ == 0)
            fail_without_faces(file_, counts, vertices_);
        for (std::size_t f = 0; f < faces_; ++f)
            read_text_face(f);
        warn_of_rest();
    }

    void warn_of_rest() {
        if (!text_.at_end())
            mesh_.warnings.push_back(grouped(text_.bytes_left()) + " bytes after the last face were not read, from " +
                                     in_quotes(text_.peek()) + " in line " + grouped(file_.line_at(text_.at())));
        else if (text_.padding() > 0)
            mesh_.warnings.push_back(counted(text_.padding(), "byte (NUL or Ctrl-Z) after the last face was",
                                             "bytes (NUL or Ctrl-Z) after the last face were") +
                                     " ignored");
    }

    void warn_of_order() {
        const bool is_sorted = std::is_sorted(layout_.groups.begin(), layout_.groups.end());
        if (layout_.is_standard && is_sorted)
            return;
        const std::string keyword = in_quotes(layout_.keyword);
        mesh_.warnings.push_back(
            "the values of each vertex are read as " + layout_.columns(color_components_) +
            (layout_.is_standard
                 ? ", which fits the numbers; " + keyword + " declares another order"
                 : "; the keyword " + keyword + " does not follow the order of the format, " + "[ST][C][N][4][n]OFF"));
    }

    /// Whether the line after the two other counts has a single number, which is then the edge count.
    bool next_line_is_one_number() {
        TextScanner ahead(text_);
        return !ahead.at_end() && ahead.tokens_on_line(2) == 1;
    }

    /// Chooses the order of normals, colours and texture coordinates, on which programs disagree.
    void choose_order() {
        TextScanner ahead(text_);
        if (ahead.at_end())
            return;
        const std::size_t width = ahead.tokens_on_line(most_tokens), without_color = layout_.width(0);
        color_components_ = width - std::min(width, without_color);
        const bool has_color = layout_.has(OffGroup::color);
        if (has_color ? color_components_ != 3 && color_components_ != 4 : width != without_color)
            return;
        std::vector<double> rows;
        for (std::size_t v = 0; v < std::min(vertices_, sampled_vertices) && !ahead.at_end(); ++v) {
            if (ahead.tokens_on_line(most_tokens) != width)
                break;
            while (!ahead.at_line_end())
                rows.push_back(ahead.number_or_nan());
        }
        alcove::choose_order(layout_, rows, color_components_);
    }

    void read_text_vertex(std::size_t v) {
        const std::size_t tokens = v > 0 || text_.at_end() ? 0 : text_.tokens_on_line(most_tokens);
        Vec3d p;
        for (int c = 0; c < 3; ++c)
            p[c] = text_.number("a coordinate");
        if (layout_.weights)
            p /= text_.number("the fourth coordinate");
        mesh_.positions.push_back(p);
        std::size_t behind = layout_.width(0) - (layout_.weights ? 4 : 3); // values after the colour
        for (const OffGroup group : layout_.groups)
            if (group == OffGroup::color) {
                read_text_vertex_color(v, behind);
            } else {
                read_text_group(group);
                behind -= group == OffGroup::normal ? 3 : 2;
            }
        if (text_.at_line_end())
            return;
        // Vertices may share a line. But if every vertex line has the same number of values, the values after the
        // declared ones belong to the vertex of their line.
        if (v == 0 ? every_vertex_line_has(tokens) : undeclared_ == v) {
            ++undeclared_;
            text_.next_line();
        }
    }

    void read_text_group(OffGroup group) {
        if (group == OffGroup::normal) {
            Vec3d n;
            for (int c = 0; c < 3; ++c)
                n[c] = text_.number("a normal");
            mesh_.normals.push_back(unit_or_zero(n));
        } else {
            const float s = text_.number<float>("a texture coordinate");
            const float t = text_.number<float>("a texture coordinate");
            mesh_.vertex_uvs.push_back({s, t});
        }
    }

    void read_text_vertex_color(std::size_t v, std::size_t behind) {
        const std::size_t left = text_.tokens_on_line(most_tokens);
        if (left < behind + 1)
            text_.fail("the vertex has no colour; one of 3 or 4 numbers is expected on its line");
        read_text_color(left - behind, v, vertex_colors_);
    }

    /// Whether the line of each vertex has `tokens` values. Called after the declared values of the first line.
    bool every_vertex_line_has(std::size_t tokens) const {
        TextScanner ahead(text_);
        for (std::size_t v = 1; v < vertices_; ++v) {
            ahead.next_line();
            if (ahead.at_end() || ahead.tokens_on_line(most_tokens) != tokens)
                return false;
        }
        return true;
    }

    void read_text_face(std::size_t f) {
        const std::int64_t corners = text_.integer("the number of corners of a face");
        if (corners < 0)
            text_.fail("the number of corners of a face is negative; export the file again");
        if (static_cast<std::size_t>(corners) > (text_.bytes_left() + 1) / 2)
            text_.fail("a face of " + grouped(static_cast<std::size_t>(corners)) +
                       " corners does not fit the rest of the file; copy or export it again");
        for (std::int64_t c = 0; c < corners; ++c) {
            const std::int64_t index = text_.integer("a vertex index");
            if (index < 0 || static_cast<std::size_t>(index) >= vertices_)
                text_.fail("vertex index " + std::to_string(index) + " is out of range: there are " +
                           grouped(vertices_) + " vertices, counted from 0; export the file again");
            mesh_.corners.push_back(static_cast<std::uint32_t>(index));
        }
        close_face(mesh_);
        if (!text_.at_line_end())
            read_text_color(text_.tokens_on_line(most_tokens), f, face_colors_);
    }

    void read_text_color(std::size_t components, std::size_t index, ColorList& colors) {
        if (components != 1 && components != 3 && components != 4)
            text_.fail("a colour of " + grouped(components) + " numbers; 3 or 4 are expected");
        std::array<double, 4> rgba{};
        bool fraction = false;
        for (std::size_t c = 0; c < components; ++c) {
            fraction |= text_.peek().find_first_of(".eE") != std::string_view::npos;
            rgba[c] = text_.number("a colour");
        }
        if (components == 1)
            ++map_indices_;
        else
            colors.add(index, rgba, components, fraction);
    }

    void read_binary() {
        text_.at_line_end();
        text_.next_line();
        ByteReader bytes(file_, text_.at(), std::endian::big);
        if (layout_.dimension && bytes.read<std::int32_t>("the dimension") != 3)
            bytes.fail("vertices of a dimension other than 3 cannot be read; export a plain OFF file");
        const auto vertices = bytes.read<std::int32_t>("the number of vertices");
        const auto faces = bytes.read<std::int32_t>("the number of faces");
        bytes.read<std::int32_t>("the number of edges");
        const std::size_t vertex_bytes = sizeof(float) * layout_.width(4);
        check_counts(vertices, faces, vertex_bytes, 8, bytes.bytes_left(),
                     [&](const std::string& message) { bytes.fail(message); });
        for (std::size_t v = 0; v < vertices_; ++v)
            read_binary_vertex(bytes, v);
        for (std::size_t f = 0; f < faces_; ++f)
            read_binary_face(bytes, f);
        if (bytes.bytes_left() > 0)
            mesh_.warnings.push_back(grouped(bytes.bytes_left()) + " bytes after the last face were not read");
    }

    void read_binary_vertex(ByteReader& bytes, std::size_t v) {
        Vec3d p;
        for (int c = 0; c < 3; ++c)
            p[c] = bytes.read<float>("a coordinate");
        if (layout_.weights)
            p /= bytes.read<float>("the fourth coordinate");
        mesh_.positions.push_back(p);
        for (const OffGroup group : layout_.groups)
            if (group == OffGroup::color) {
                read_binary_color(bytes, 4, v, vertex_colors_);
            } else if (group == OffGroup::normal) {
                Vec3d n;
                for (int c = 0; c < 3; ++c)
                    n[c] = bytes.read<float>("a normal");
                mesh_.normals.push_back(unit_or_zero(n));
            } else {
                const float s = bytes.read<float>("a texture coordinate");
                const float t = bytes.read<float>("a texture coordinate");
                mesh_.vertex_uvs.push_back({s, t});
            }
    }

    void read_binary_face(ByteReader& bytes, std::size_t f) {
        const auto corners = bytes.read<std::int32_t>("the number of corners of a face");
        if (corners < 0 || static_cast<std::size_t>(corners) > bytes.bytes_left() / 4)
            bytes.fail("a face of " + std::to_string(corners) +
                       " corners does not fit the rest of the file; copy or export it again");
        for (std::int32_t c = 0; c < corners; ++c) {
            const auto index = bytes.read<std::int32_t>("a vertex index");
            if (index < 0 || static_cast<std::size_t>(index) >= vertices_)
                bytes.fail("vertex index " + std::to_string(index) + " is out of range: there are " +
                           grouped(vertices_) + " vertices, counted from 0; export the file again");
            mesh_.corners.push_back(static_cast<std::uint32_t>(index));
        }
        close_face(mesh_);
        const auto components = bytes.read<std::int32_t>("the number of colour components of a face");
        if (components != 0)
            read_binary_color(bytes, components, f, face_colors_);
    }

    void read_binary_color(ByteReader& bytes, std::int32_t components, std::size_t index, ColorList& colors) {
        if (components != 1 && components != 3 && components != 4)
            bytes.fail("a colour of " + std::to_string(components) + " numbers; 3 or 4 are expected");
        std::array<double, 4> rgba{};
        for (std::int32_t c = 0; c < components; ++c)
            rgba[static_cast<std::size_t>(c)] = bytes.read<float>("a colour");
        if (components == 1)
            ++map_indices_;
        else
            colors.add(index, rgba, static_cast<std::size_t>(components), true);
    }

    const FileBytes& file_;
    TextScanner text_;
    Mesh mesh_;
    OffLayout layout_;
    std::size_t color_components_ = 4; ///< of vertices, if choose_order() counted them
    bool binary_ = false;
    std::size_t vertices_ = 0, faces_ = 0, map_indices_ = 0, undeclared_ = 0;
    ColorList vertex_colors_, face_colors_;
};

}

bool begins_as_off(const FileBytes& file) {
    TextScanner text(file, file.begin(), off_syntax);
    return !text.at_end() && off_layout(text.peek());
}

Mesh read_off(const FileBytes& file) {
    return OffReader(file).read();
}

}
