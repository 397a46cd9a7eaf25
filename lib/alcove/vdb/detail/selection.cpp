#include "alcove/vdb/detail/selection.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/vdb/detail/archive.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

/// Why a grid cannot be read as a level set; empty if it can.
std::string obstacle(const GridEntry& entry) {
    const StoredGrid& grid = entry.grid;
    if (grid.grid_class != "level set" && grid.grid_class != "unknown")
        return fmt::format("is a {}, not a level set", grid.grid_class);
    if (grid.type != "float" && grid.type != "double")
        return fmt::format("is of type {}: save it as floats", grid.type);
    if (!entry.is_linear)
        return "has a frustum transform, whose voxels differ in size: resample it to a linear transform";
    return {};
}

bool is_named(const StoredGrid& grid, const std::string& name) {
    return grid.name == name || grid.name.substr(0, grid.name.rfind('[')) == name;
}

std::string listed(const VdbStructure& structure) {
    std::string list;
    for (const GridEntry& entry : structure.grids)
        list += fmt::format("{}{} ({}, {})", list.empty() ? "" : ", ", in_quotes(entry.grid.name), entry.grid.type,
                            entry.grid.grid_class);
    return list.empty() ? "no grids" : list;
}

std::vector<bool> named(const VdbStructure& structure, const std::vector<std::string>& names,
                        const std::filesystem::path& file) {
    const std::vector<GridEntry>& grids = structure.grids;
    std::vector<bool> wanted(grids.size());
    for (const std::string& name : names) {
        bool found = false;
        for (std::size_t i = 0; i < grids.size(); ++i) {
            if (!is_named(grids[i].grid, name))
                continue;
            if (const std::string why = obstacle(grids[i]); !why.empty())
                refuse(file, fmt::format("grid {} {}", in_quotes(grids[i].grid.name), why));
            found = true;
            for (std::size_t level = 0; level < grids.size(); ++level)
                if (level == i || (!grids[i].stack.empty() && grids[level].stack == grids[i].stack))
                    wanted[level] = true;
        }
        if (!found)
            refuse(file, fmt::format("has no grid {}, but {}", in_quotes(name), listed(structure)));
    }
    return wanted;
}

}

std::vector<bool> choose(const VdbStructure& structure, const std::vector<std::string>& names,
                         const std::filesystem::path& file, std::vector<std::string>& warnings) {
    if (!names.empty())
        return named(structure, names, file);
    std::vector<bool> wanted;
    for (const char* grid_class : {"level set", "unknown"}) {
        wanted.clear();
        for (const GridEntry& entry : structure.grids) {
            const std::string why = obstacle(entry);
            wanted.push_back(entry.grid.grid_class == grid_class && why.empty());
            if (entry.grid.grid_class == "level set" && grid_class == entry.grid.grid_class && !why.empty())
                warnings.push_back(fmt::format("grid {} is left out: it {}", in_quotes(entry.grid.name), why));
        }
        if (std::find(wanted.begin(), wanted.end(), true) != wanted.end())
            return wanted;
    }
    if (!warnings.empty())
        refuse(file, warnings.front());
    refuse(file, fmt::format("contains no level set of floats or doubles, but {}: alcove needs signed distances",
                             listed(structure)));
}

}
