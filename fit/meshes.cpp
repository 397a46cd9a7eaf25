#include "meshes.h"

#include "alcove/base/types.h"
#include "alcove/mesh/files.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>

namespace alcove::fit {
namespace {

constexpr std::size_t min_vertices = 100;

std::string family_of(std::string name) {
    for (const std::string prefix : {"refined_", "larger_"})
        if (name.starts_with(prefix))
            name.erase(0, prefix.size());
    const auto letter = [](unsigned char c) { return std::isalpha(c) != 0; };
    name.erase(std::find_if_not(name.begin(), name.end(), letter), name.end());
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name;
}

bool large_enough(const std::filesystem::path& path) {
    try {
        return read_mesh(path.string()).vertex_count() >= min_vertices;
    } catch (const InputError&) {
        return false;
    }
}

}

std::vector<MeshFile> split_meshes(const std::filesystem::path& folder) {
    std::set<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        paths.insert(entry.path());
    std::set<std::string> names;
    std::map<std::string, std::vector<std::filesystem::path>> families;
    for (const std::filesystem::path& path : paths) {
        const std::string name = path.stem().string();
        if (name.ends_with("-shuffled") || !names.insert(name).second || !large_enough(path))
            continue;
        families[family_of(name)].push_back(path);
    }
    std::vector<MeshFile> files;
    bool fitted = true;
    for (const auto& [family, members] : families) {
        for (const std::filesystem::path& path : members)
            files.push_back({path, fitted});
        fitted = !fitted;
    }
    return files;
}

}
