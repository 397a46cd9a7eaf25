#include "alcove/grid/grid_stack.h"

#include <cmath>
#include <utility>

namespace alcove {

double GridStack::scene_voxel(std::size_t level) const {
    return lattice ? std::ldexp(lattice->voxel, static_cast<int>(level)) : levels[level].voxel * frame.diagonal;
}

GridStack reframed(GridStack stack, const Frame& frame) {
    const Frame old = std::exchange(stack.frame, frame);
    if (old.center == frame.center && old.diagonal == frame.diagonal)
        return stack;
    for (std::vector<LevelSet>* set : {&stack.levels, &stack.partial})
        for (LevelSet& level : *set) {
            level.origin = exact_in_unit(frame, level.origin * old.diagonal + old.center);
            level.voxel *= old.diagonal / frame.diagonal;
        }
    return stack;
}

Vec3d exact_in_unit(const Frame& frame, const Vec3d& scene) {
    return (scene - frame.center) / frame.diagonal;
}

double value_unit_of(const Frame& frame) {
    return std::ldexp(1.0, std::ilogb(frame.diagonal));
}

}
