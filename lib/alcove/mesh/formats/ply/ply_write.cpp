#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/ply/ply_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace alcove {
namespace {

constexpr std::size_t chunk_size = std::size_t(1) << 22;
constexpr std::array<const char*, 4> color_names{"red", "green", "blue", "alpha"};

/// A scalar property to write: one value per row, `stride` bytes apart.
struct Column {
    std::string name;
    PlyType type;
    const std::byte* values;
    std::size_t stride;
};

std::string column_name(const Attribute& attribute, int component) {
    if (attribute.components == 1)
        return attribute.name;
    const std::string stem = attribute.name == "bent_normal" ? "bent" : attribute.name;
    return attribute.components <= 4 ? fmt::format("{}_{}", stem, "xyzw"[component])
                                     : fmt::format("{}_{}", stem, component);
}

std::vector<Column> added_columns(const Mesh& mesh) {
    std::vector<Column> columns;
    for (const Attribute& attribute : mesh.attributes)
        for (int c = 0; c < attribute.components; ++c)
            columns.push_back({column_name(attribute, c), PlyType::float32,
                               reinterpret_cast<const std::byte*>(attribute.values.data() + c),
                               sizeof(float) * static_cast<std::size_t>(attribute.components)});
    if (!mesh.added_colors.empty()) {
        const auto* bytes = reinterpret_cast<const std::byte*>(mesh.added_colors.data());
        for (const char* name : color_names)
            columns.push_back({name, PlyType::uint8, bytes++, sizeof(Color)});
    }
    return columns;
}

/// One step in copying a row. Copies `fixed` bytes or the list `old` unchanged, or writes `column` in place of the
/// property `old` or, if `old` is null, after all other properties.
struct Step {
    std::size_t fixed = 0;
    const PlyProperty* old = nullptr;
    const Column* column = nullptr;
};

/// Writes an element with `columns`, which replace properties of the same name or come after the last one.
class ElementWriter {
  public:
    ElementWriter(const PlyElement& element, const std::vector<Column>& columns) : element_(element) {
        for (const PlyProperty& property : element.properties) {
            const auto column =
                std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == property.name; });
            if (column != columns.end())
                steps_.push_back({0, &property, &*column});
            else if (property.count_type)
                steps_.push_back({0, &property, nullptr});
            else if (!steps_.empty() && steps_.back().fixed > 0)
                steps_.back().fixed += size_of(property.type);
            else
                steps_.push_back({size_of(property.type), nullptr, nullptr});
            properties_.push_back(column == columns.end() ? property
                                                          : PlyProperty{property.name, column->type, std::nullopt});
        }
        for (const Column& column : columns)
            if (element.find(column.name) == nullptr) {
                steps_.push_back({0, nullptr, &column});
                properties_.push_back({column.name, column.type, std::nullopt});
            }
    }

    void write_header(std::string& header) const {
        fmt::format_to(std::back_inserter(header), "element {} {}\n", element_.name, element_.count);
        for (const PlyProperty& p : properties_)
            if (p.count_type)
                fmt::format_to(std::back_inserter(header), "property list {} {} {}\n", name_of(*p.count_type),
                               name_of(p.type), p.name);
            else
                fmt::format_to(std::back_inserter(header), "property {} {}\n", name_of(p.type), p.name);
    }

    void write_rows(AtomicFile& output) const {
        const bool unchanged =
            std::none_of(steps_.begin(), steps_.end(), [](const Step& s) { return s.column != nullptr; });
        if (unchanged) {
            output.write({reinterpret_cast<const char*>(element_.rows.data()), element_.rows.size()});
            return;
        }
        std::vector<std::byte> chunk;
        chunk.reserve(chunk_size + chunk_size / 4);
        const std::byte* from = element_.rows.data();
        for (std::size_t row = 0; row < element_.count; ++row) {
            from = append_row(chunk, from, row);
            if (chunk.size() >= chunk_size) {
                output.write({reinterpret_cast<const char*>(chunk.data()), chunk.size()});
                chunk.clear();
            }
        }
        output.write({reinterpret_cast<const char*>(chunk.data()), chunk.size()});
    }

  private:
    const std::byte* append_row(std::vector<std::byte>& to, const std::byte* from, std::size_t row) const {
        for (const Step& step : steps_) {
            const std::size_t old_size = step.old != nullptr ? stored_size(*step.old, from) : step.fixed;
            if (step.column != nullptr) {
                const std::byte* value = step.column->values + row * step.column->stride;
                to.insert(to.end(), value, value + size_of(step.column->type));
            } else {
                to.insert(to.end(), from, from + old_size);
            }
            from += old_size;
        }
        return from;
    }

    const PlyElement& element_;
    std::vector<Step> steps_;
    std::vector<PlyProperty> properties_;
};

std::string header_comments(const PlyDocument& document, const Mesh& mesh) {
    std::vector<std::string> lines = document.comments;
    // Comments about values that this run replaces are no longer true.
    for (const std::string& comment : mesh.added_comments)
        std::erase_if(lines, [&](const std::string& line) {
            return line.starts_with("comment " + comment.substr(0, comment.find(' ') + 1));
        });
    for (std::string comment : mesh.added_comments) {
        std::replace_if(
            comment.begin(), comment.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        std::string line = "comment " + comment;
        if (std::find(lines.begin(), lines.end(), line) == lines.end())
            lines.push_back(std::move(line));
    }
    std::string text;
    for (const std::string& line : lines)
        text += line + "\n";
    return text;
}

/// Lists the vertex properties that the columns replace, except colours that the reader understood, and except values
/// that, according to a comment, an earlier run of the same program made.
void list_replaced(const PlyDocument& document, const Mesh& mesh, std::vector<std::string>& lost) {
    const auto list = [&](const std::string& name) {
        if (document.has_vertex_property(name))
            lost.push_back("the property " + in_quotes(name) + " of the input is replaced");
    };
    const auto made_before = [&](const std::string& name) {
        return std::any_of(mesh.added_comments.begin(), mesh.added_comments.end(), [&](const std::string& comment) {
            return names_value(document.comment(comment.substr(0, comment.find(' ') + 1)), name);
        });
    };
    for (const Attribute& attribute : mesh.attributes)
        for (int c = 0; c < attribute.components && !made_before(attribute.name); ++c)
            list(column_name(attribute, c));
    if (!mesh.added_colors.empty() && mesh.vertex_colors.empty())
        for (const char* name : color_names)
            list(name);
}

bool belongs_to(const PlyDocument& document, const Mesh& mesh) {
    const PlyElement* vertices = document.find("vertex");
    const PlyElement* faces = document.find("face");
    return vertices != nullptr && vertices->count == mesh.vertex_count() &&
           (faces != nullptr ? faces->count : 0) == mesh.face_count();
}

}

std::vector<std::string> write_ply(const Mesh& mesh, const std::filesystem::path& file) {
    std::vector<std::string> lost;
    PlyDocument made;
    const auto* document = dynamic_cast<const PlyDocument*>(mesh.source.get());
    if (document != nullptr && !belongs_to(*document, mesh)) {
        lost.push_back("the mesh no longer has the vertices and faces of its file: other properties are not stored");
        document = nullptr;
    }
    if (document == nullptr) {
        made = make_ply_document(mesh);
        document = &made;
    }
    if (mesh.source != nullptr && dynamic_cast<const PlyDocument*>(mesh.source.get()) == nullptr)
        for (const std::string& content : mesh.source->contents())
            lost.push_back("not stored in PLY: " + content);

    list_replaced(*document, mesh, lost);
    const std::vector<Column> columns = added_columns(mesh);
    const std::vector<Column> no_columns;
    std::vector<ElementWriter> writers;
    std::string header = "ply\nformat binary_little_endian 1.0\n" + header_comments(*document, mesh);
    for (const PlyElement& element : document->elements) {
        writers.emplace_back(element, element.name == "vertex" ? columns : no_columns);
        writers.back().write_header(header);
    }
    header += "end_header\n";

    AtomicFile output(file);
    output.write(header);
    for (const ElementWriter& writer : writers)
        writer.write_rows(output);
    output.commit();
    return lost;
}

}
