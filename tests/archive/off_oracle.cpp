#include "off_oracle.h"

#include <fstream>
#include <sstream>
#include <string>

namespace alcove::test {
namespace {

/// Reads the next line that is not just a comment.
bool next_line(std::istream& input, std::istringstream& line) {
    for (std::string text; std::getline(input, text);) {
        text = text.substr(0, text.find('#'));
        if (text.find_first_not_of(" \t\r") != std::string::npos) {
            line = std::istringstream(text);
            return true;
        }
    }
    return false;
}

}

std::optional<PlainMesh> read_plain_off(const std::filesystem::path& file) {
    std::ifstream input(file);
    std::istringstream line;
    std::string keyword;
    if (!next_line(input, line) || !(line >> keyword))
        return std::nullopt;
    if (keyword != "OFF" && keyword != "COFF" && keyword != "NOFF")
        return std::nullopt;
    std::size_t vertices = 0, faces = 0;
    if (!(line >> vertices >> faces) && (!next_line(input, line) || !(line >> vertices >> faces)))
        return std::nullopt;
    PlainMesh mesh;
    for (std::size_t v = 0; v < vertices; ++v) {
        std::array<double, 3> p{};
        if (!next_line(input, line) || !(line >> p[0] >> p[1] >> p[2]))
            return std::nullopt;
        mesh.positions.push_back(p);
    }
    for (std::size_t f = 0; f < faces; ++f) {
        std::size_t corners = 0;
        if (!next_line(input, line) || !(line >> corners))
            return std::nullopt;
        std::vector<unsigned> face(corners);
        for (unsigned& corner : face)
            if (!(line >> corner))
                return std::nullopt;
        mesh.faces.push_back(std::move(face));
    }
    return mesh;
}

}
