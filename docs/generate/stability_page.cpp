// Writes docs/stability.md: every row of the table of extremes, with its figures.
//
//     alcove_stability_page <folder of meshes> <docs folder>
#include "extreme.h"
#include "page.h"
#include "row.h"

#include "alcove/render/camera.h"
#include "alcove/render/detail/painted.h"

#include <alcove/alcove.h>

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <map>

namespace alcove::docs {
namespace {

using extremes::Extreme;
using extremes::Figure;
using extremes::Result;

constexpr std::string_view head = R"(# Stability

Written by `tools/docs.sh stability`, from the same table that the tests check (`tests/extremes`; `ctest -R Extremes`).
The second column states what each case must meet. Figures are differences of ao, which is in [0, 1]: the largest at any
vertex, or the RMSE over all vertices, as the case says. The radius is 10 % of the diagonal D, the voxel D/256, and all
other settings have their defaults, unless the case says otherwise. The *bumpy* surface is closed, with 4,098 vertices,
bumps and hollows.

)";

const std::map<std::string_view, std::string_view> words{
    {"scale", "The bumpy surface at other scales, read from files with all digits of a double. Grids are built in "
              "units of D, so only rounding differs."},
    {"offset",
     "The bumpy surface far from the origin. The last column shows the precision that the file itself loses there."},
    {"shape", "Flat, long and sharp shapes, whose ao is known."},
    {"damage", "The bumpy surface with defects."},
    {"thin", "Walls, gaps and slots; their sizes are in voxels of D/256. The grid resolves gaps between "
             "solids, however narrow. It may miss walls thinner than a voxel and a half, and rays then "
             "pass through them. In that case, a warning names a voxel size that resolves the walls, and the "
             "figure is the error at that size. If a grid of that size does not fit into memory, the warning names "
             "only `guided`, whose rays hit the triangles. The image shows fins half a voxel thick, baked by "
             "`traced`, by `traced` with the voxel size from the warning, and by `guided`.\n\n"
             "![fins of half a voxel](images/stability/fins.png)"},
    {"setting", "Radii, voxels and numbers of rays, from one extreme to the other, on the bumpy surface."},
};

/// Escapes `|`, which would end a cell.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
        text.replace(at, 1, "\\|");
    return text;
}

std::string figures_of(const Result& result) {
    std::string text;
    for (const Figure& figure : result.figures) {
        const bool has_value = figure.bound > 0.0 || figure.value > 0.0;
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", figure.of,
                            has_value                         ? fmt::format(" {:.2g}", figure.value)
                            : figure.of == "warnings missing" ? " 0"
                                                              : "");
        if (!figure.holds())
            text += " **over**";
    }
    return text;
}

void write_fins(const std::filesystem::path& file) {
    const Mesh fins = extremes::comb(12, 0.5 / 256, 6.0 / 256, false);
    const std::vector<Triangle> triangles = triangulate(fins).triangles;
    const Camera camera = make_camera({.up = {0.0, 0.0, 1.0}}, fins.positions, {400, 300});
    const extremes::Baked coarse(fins), fine(fins, {.voxel = coarse.resolving_voxel()});
    std::vector<Image> row;
    for (const std::vector<float>& ao : {coarse.by("traced"), fine.by("traced"), coarse.by("guided")})
        row.push_back(paint(fins.positions, triangles, ao, camera));
    write_png(row_of(row), file, Pass::ao);
}

void write_stability(const std::filesystem::path& docs) {
    std::filesystem::create_directories(docs / "images/stability");
    write_fins(docs / "images/stability/fins.png");
    std::string page(head), group;
    std::size_t rows = 0, over = 0;
    for (const Extreme& extreme : extremes::all_extremes()) {
        if (extreme.group != group) {
            group = extreme.group;
            page += fmt::format("{}## {}\n\n{}\n\n| case | requirement | figures | note |\n| --- | --- | --- | --- |\n",
                                rows > 0 ? "\n" : "", group, words.at(group));
        }
        const Result result = extreme.run();
        ++rows;
        for (const Figure& figure : result.figures)
            over += !figure.holds();
        page += fmt::format("| {} | {} | {} | {} |\n", cell(extreme.name), cell(extreme.must), figures_of(result),
                            cell(result.note));
        std::cerr << extreme.group << ": " << extreme.name << "\n";
    }
    page += fmt::format("\n{} cases, {} figures over their bound.\n", rows, over);
    write_text(docs / "stability.md", page);
}

}
}

int main(int argc, char** argv) {
    return alcove::docs::run_page(argc, argv,
                                  [](const auto&, const auto& docs) { alcove::docs::write_stability(docs); });
}
