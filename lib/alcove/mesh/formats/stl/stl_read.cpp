// Format: 3D Systems (1988). Its facets share no vertices.
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/detail/weld.h"
#include "alcove/mesh/formats/byte_reader.h"
#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/text_scanner.h"

#include <algorithm>
#include <limits>

namespace alcove {
namespace {

constexpr std::size_t header_size = 80;
constexpr std::size_t preamble_size = header_size + sizeof(std::uint32_t);
constexpr std::size_t facet_size = 50;

/// Joins coincident corners; before, each corner has its own position.
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

/// The number of triangles that the preamble of a binary file declares.
std::size_t declared_facets(const FileBytes& file) {
    ByteReader bytes(file, file.begin() + header_size, std::endian::little);
    return bytes.read<std::uint32_t>("the number of facets");
}

bool has_binary_size(const FileBytes& file) {
    return file.size() >= preamble_size && file.size() == preamble_size + facet_size * declared_facets(file);
}

/// Many binary files begin with the keyword of the text format too, but only binary files contain zero bytes.
bool is_text(const FileBytes& file) {
    TextScanner text(file, file.begin());
    return !has_binary_size(file) && !text.at_end() && same_word(text.peek(), "solid") &&
           file.view().substr(0, 1024).find('\0') == std::string_view::npos;
}

class TextReader {
  public:
    explicit TextReader(const FileBytes& file) : text_(file, file.begin()) {}

    Mesh read() {
        while (!text_.at_end()) {
            expect("solid");
            text_.next_line();
            while (!next_is("endsolid"))
                read_facet();
            text_.next_line();
        }
        join_corners(mesh_);
        return std::move(mesh_);
    }

  private:
    void read_facet() {
        expect("facet");
        expect("normal");
        for (int c = 0; c < 3; ++c)
            text_.number("a normal");
        expect("outer");
        expect("loop");
        while (!next_is("endloop")) {
            expect("vertex");
            Vec3d p;
            for (int c = 0; c < 3; ++c)
                p[c] = text_.number("a coordinate");
            mesh_.positions.push_back(p);
        }
        expect("endloop");
        expect("endfacet");
        close_facet(mesh_);
    }

    bool next_is(const char* word) {
        if (text_.at_end())
            text_.fail_early(word);
        return same_word(text_.peek(), word);
    }

    void expect(const char* word) {
        if (!next_is(word))
            text_.fail(in_quotes(text_.peek()) + " found where '" + word + "' is expected; export the file again");
        text_.word(word);
    }

    TextScanner text_;
    Mesh mesh_;
};

Mesh read_binary(const FileBytes& file) {
    if (file.size() < preamble_size)
        file.fail_at_byte(file.end(),
                          "the file ends early: a binary STL has at least 84 bytes; copy or export it again");
    const std::size_t facets = declared_facets(file);
    ByteReader bytes(file, file.begin() + preamble_size, std::endian::little);
    if (facets > bytes.bytes_left() / facet_size)
        file.fail_at_byte(file.begin() + header_size, grouped(facets) + " facets of 50 bytes are declared but only " +
                                                          grouped(bytes.bytes_left()) +
                                                          " bytes follow; copy or export the file again");
    Mesh mesh;
    mesh.positions.reserve(3 * facets);
    mesh.corners.reserve(3 * facets);
    mesh.face_begin.reserve(facets + 1);
    std::size_t attributed = 0;
    for (std::size_t f = 0; f < facets; ++f) {
        for (int c = 0; c < 3; ++c)
            bytes.read<float>("a normal");
        for (int corner = 0; corner < 3; ++corner) {
            Vec3d p;
            for (int c = 0; c < 3; ++c)
                p[c] = bytes.read<float>("a coordinate");
            mesh.positions.push_back(p);
        }
        attributed += bytes.read<std::uint16_t>("the attribute") != 0;
        close_facet(mesh);
    }
    join_corners(mesh);
    if (attributed > 0)
        mesh.warnings.push_back(counted(attributed, "facet has", "facets have") +
                                " attribute bytes (often a colour); left out");
    if (bytes.bytes_left() > 0)
        mesh.warnings.push_back(grouped(bytes.bytes_left()) + " bytes after the last facet were not read");
    return mesh;
}

}

bool begins_as_stl(const FileBytes& file) {
    return has_binary_size(file) || is_text(file);
}

Mesh read_stl(const FileBytes& file) {
    return is_text(file) ? TextReader(file).read() : read_binary(file);
}

}
