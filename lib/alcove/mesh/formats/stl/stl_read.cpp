// Format: 3D Systems (1988). The facets of the format share no vertices.
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/detail/weld.h"
#include "alcove/mesh/formats/byte_reader.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/stl/stl_colors.h"
#include "alcove/mesh/formats/text_scanner.h"

#include <algorithm>
#include <limits>

namespace alcove {
namespace {

constexpr std::size_t header_size = 80;
constexpr std::size_t preamble_size = header_size + sizeof(std::uint32_t);
constexpr std::size_t facet_size = 50;

/// Joins coincident corners. Before the call, each corner has its own position.
void join_corners(Mesh& mesh) {
    const std::vector<std::uint32_t> first = weld(mesh.positions);
    std::vector<std::uint32_t> number(mesh.positions.size());
    std::uint32_t count = 0;
    for (std::size_t corner = 0; corner < first.size(); ++corner) {
        if (first[corner] == corner) {
            number[corner] = count;
            mesh.positions[count++] = mesh.positions[corner];
        }
        mesh.corners.push_back(number[first[corner]]);
    }
    mesh.positions.resize(count);
    mesh.positions.shrink_to_fit();
}

/// Ends the facet whose corners are the positions added since the last call.
void close_facet(Mesh& mesh) {
    if (mesh.positions.size() > std::numeric_limits<std::uint32_t>::max())
        throw LimitError("more than 2^32 facet corners; split the mesh");
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
}

bool same_word(std::string_view a, std::string_view lower_case) {
    return a.size() == lower_case.size() && std::equal(a.begin(), a.end(), lower_case.begin(), [](char x, char y) {
               return (x >= 'A' && x <= 'Z' ? x - 'A' + 'a' : x) == y;
           });
}

bool begins_with_word(std::string_view a, std::string_view lower_case) {
    return same_word(a.substr(0, lower_case.size()), lower_case);
}

/// The number of triangles that the preamble of a binary file declares.
std::size_t declared_facets(const FileBytes& file) {
    ByteReader bytes(file, file.begin() + header_size, std::endian::little);
    return bytes.read<std::uint32_t>("the number of facets");
}

bool has_binary_size(const FileBytes& file) {
    return file.size() >= preamble_size && file.size() == preamble_size + facet_size * declared_facets(file);
}

/// Many binary files begin with the keyword of the text format too, but only binary files contain control characters.
/// At the very end of a text, control characters are padding.
bool is_text(const FileBytes& file) {
    constexpr std::string_view padding("\0\x1a \t\r\n", 6), spacing = "\t\n\v\f\r\x1a";
    const std::string_view text = file.view().substr(0, file.view().find_last_not_of(padding) + 1).substr(0, 1024);
    return !has_binary_size(file) && std::all_of(text.begin(), text.end(), [&](char c) {
        return static_cast<unsigned char>(c) >= ' ' || spacing.find(c) != std::string_view::npos;
    });
}

/// Reads the text format. Accepts the variants that exporters write: `end solid part`, `endsolidpart`, a solid without
/// its first or last line.
class TextReader {
  public:
    explicit TextReader(const FileBytes& file) : file_(file), text_(file, file.begin()) {}

    Mesh read() {
        while (!text_.at_end())
            read_item();
        if (mesh_.face_count() == 0 && skipped_ > 0)
            file_.fail("contains no facets, and a line begins with " + in_quotes(first_skipped_) +
                       ": is it an STL file?");
        if (in_solid_)
            mesh_.warnings.emplace_back("the file ends without 'endsolid': check that it is complete");
        if (skipped_ > 0)
            mesh_.warnings.push_back(
                counted(skipped_, "line does", "lines do") + " not begin with an STL keyword (first: line " +
                grouped(file_.line_at(first_skipped_.data())) + " with " + in_quotes(first_skipped_) + "); left out");
        join_corners(mesh_);
        return std::move(mesh_);
    }

  private:
    void read_item() {
        const std::string_view word = text_.peek();
        if (same_word(word, "facet"))
            return read_facet();
        if (begins_with_word(word, "solid"))
            in_solid_ = true;
        else if (begins_with_word(word, "endsolid") || take_end("solid"))
            in_solid_ = false;
        else if (!is_padding(word))
            skip(word);
        text_.next_line(); // skips the name
    }

    /// Counts a line that does not belong to a solid, such as the last line of a web page.
    void skip(std::string_view word) {
        for (const char* keyword : {"normal", "outer", "loop", "vertex", "endloop", "endfacet", "end"})
            if (same_word(word, keyword))
                fail_word("facet");
        if (skipped_++ == 0)
            first_skipped_ = word;
    }

    /// The normal is ignored, so it may be missing or consist of words that are not numbers.
    void read_facet() {
        expect("facet");
        if (next_is("normal"))
            text_.word("normal");
        for (int c = 0; c < 3 && !next_is("outer"); ++c)
            text_.word("outer");
        expect("outer");
        expect("loop");
        while (!take_end("loop")) {
            expect("vertex");
            Vec3d p;
            for (int c = 0; c < 3; ++c)
                p[c] = text_.number("a coordinate");
            mesh_.positions.push_back(p);
        }
        if (!take_end("facet"))
            fail_word("endfacet");
        close_facet(mesh_);
    }

    bool next_is(std::string_view word) {
        if (text_.at_end())
            text_.fail_early(word.data());
        return same_word(text_.peek(), word);
    }

    /// Reads past "end" and `what`, in one word or two, if they are next. \return whether they were.
    bool take_end(std::string_view what) {
        if (text_.at_end())
            text_.fail_early(("end" + std::string(what)).c_str());
        const std::string_view word = text_.peek();
        if (!begins_with_word(word, "end"))
            return false;
        TextScanner after(text_);
        after.word("end");
        const bool two_words = word.size() == 3 && !after.at_line_end() && same_word(after.peek(), what);
        if (!two_words && !same_word(word.substr(3), what))
            return false;
        if (two_words)
            after.word("end");
        text_.move_to(after.at());
        return true;
    }

    [[noreturn]] void fail_word(const std::string& wanted) {
        text_.fail(in_quotes(text_.peek()) + " found where '" + wanted + "' is expected; export the file again");
    }

    void expect(const char* word) {
        if (!next_is(word))
            fail_word(word);
        text_.word(word);
    }

    const FileBytes& file_;
    TextScanner text_;
    Mesh mesh_;
    bool in_solid_ = false;
    std::size_t skipped_ = 0;
    std::string_view first_skipped_;
};

/// The number of facets to read: the declared number or, if the exporter never filled it in, as many as the file has
/// room for.
std::size_t facets_of(const FileBytes& file, std::vector<std::string>& warnings) {
    const std::size_t declared = declared_facets(file), bytes = file.size() - preamble_size;
    const std::size_t room = bytes / facet_size;
    const bool filled_in = declared > 0 && declared < 0x7fffffff;
    if (filled_in && declared > room)
        file.fail_at_byte(file.begin() + header_size, grouped(declared) + " facets of 50 bytes are declared but only " +
                                                          grouped(bytes) + " bytes follow, which hold " +
                                                          grouped(room) + "; copy or export the file again");
    if (!filled_in && room > 0)
        warnings.push_back("the header declares " + grouped(declared) + " facets, but the file has room for " +
                           grouped(room) + ": all of these were read");
    return filled_in ? declared : room;
}

std::string warning_of_rest(std::size_t bytes, std::size_t facets) {
    std::string warning =
        counted(bytes, "byte after the last facet was", "bytes after the last facet were") + " not read";
    if (bytes % facet_size == 0)
        warning += "; they look like " + counted(bytes / facet_size, "facet", "facets") + " beyond the " +
                   grouped(facets) + " that the header declares";
    return warning;
}

Mesh read_binary(const FileBytes& file) {
    if (file.size() < preamble_size)
        file.fail_at_byte(file.end(),
                          "the file ends early: a binary STL has at least 84 bytes; copy or export it again");
    Mesh mesh;
    const std::size_t facets = facets_of(file, mesh.warnings);
    ByteReader bytes(file, file.begin() + preamble_size, std::endian::little);
    mesh.positions.reserve(3 * facets);
    mesh.corners.reserve(3 * facets);
    mesh.face_begin.reserve(facets + 1);
    std::vector<std::uint16_t> attributes;
    attributes.reserve(facets);
    for (std::size_t f = 0; f < facets; ++f) {
        for (int c = 0; c < 3; ++c)
            bytes.read<float>("a normal");
        for (int corner = 0; corner < 3; ++corner) {
            Vec3d p;
            for (int c = 0; c < 3; ++c)
                p[c] = bytes.read<float>("a coordinate");
            mesh.positions.push_back(p);
        }
        attributes.push_back(bytes.read<std::uint16_t>("the attribute"));
        close_facet(mesh);
    }
    join_corners(mesh);
    mesh.face_colors = stl_colors(file.view().substr(0, header_size), attributes, mesh.warnings);
    if (bytes.bytes_left() > 0)
        mesh.warnings.push_back(warning_of_rest(bytes.bytes_left(), facets));
    return mesh;
}

}

bool begins_as_stl(const FileBytes& file) {
    TextScanner text(file, file.begin());
    return has_binary_size(file) || (is_text(file) && !text.at_end() &&
                                     (begins_with_word(text.peek(), "solid") || same_word(text.peek(), "facet")));
}

Mesh read_stl(const FileBytes& file) {
    return is_text(file) ? TextReader(file).read() : read_binary(file);
}

}
