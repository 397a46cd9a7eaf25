#include "weld.h"

#include "options.h"

#include "alcove/mesh/detail/join.h"
#include "alcove/mesh/files.h"

#include <CLI/CLI.hpp>

#include <cmath>

namespace alcove::cli {
namespace {

Length parse_weld(const std::string& text) {
    const Length length = length_without_vx(text, "0.2 (scene units) or 0.001% (of the diagonal)");
    if (std::isinf(length.value))
        throw InputError("takes a finite length, not 'inf': write 0.2 (scene units) or 0.001%");
    return length;
}

}

void add_weld_option(CLI::App& verb, std::optional<Length>& weld) {
    verb.add_option_function<std::string>(
            "--weld", [&weld](const std::string& text) { weld = parse_weld(text); },
            "Before anything else, join vertices within this distance of each other (for example 0.2 in scene units, "
            "or 0.001% of the diagonal). This closes gaps caused by an exporter's rounding and smooths shading across "
            "seams")
        ->check(parsable(parse_weld))
        ->type_name("LEN");
}

void check_has_faces(const Mesh& mesh, const std::string& file, const std::string& option) {
    if (mesh.face_count() == 0)
        throw UsageError(option + " is for meshes, but " + file + " contains points: leave it out");
}

Mesh read_welded(const std::string& file, const std::optional<Length>& weld) {
    Mesh mesh = read_mesh(file);
    if (!weld)
        return mesh;
    check_has_faces(mesh, file, "--weld");
    Mesh joined = join_vertices(mesh, *weld).mesh;
    joined.source = mesh.source;
    return joined;
}

}
