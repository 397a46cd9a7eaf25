#include "inputs.h"

#include "options.h"

#include "alcove/base/types.h"
#include "alcove/grid/voxelize.h"

namespace alcove::cli {

bool is_grid(const std::string& file) {
    return extension(file) == ".vdb";
}

Mesh surface_of(const GridStack& grids, const std::string& file, float adaptivity) {
    try {
        Mesh mesh = mesh_zero_surface(grids, adaptivity);
        mesh.name = file;
        return mesh;
    } catch (const InputError& error) {
        throw InputError(file + ": " + error.what());
    }
}

}
