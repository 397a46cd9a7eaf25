#include "alcove/grid/grid_stack.h"

#include <cmath>
#include <utility>

namespace alcove {

GridStack reframed(GridStack stack, const Frame& frame) {
    const Frame old = std::exchange(stack.frame, frame);
    if (old.center == frame.center && old.diagonal == frame.diagonal)
        return stack;
    for (LevelSet& level : stack.levels) {
        level.origin = frame.to_unit(old.to_scene(level.origin));
        level.voxel = static_cast<float>(level.voxel * old.diagonal / frame.diagonal);
    }
    return stack;
}

double value_unit_of(const Frame& frame) {
    return std::ldexp(1.0, std::ilogb(frame.diagonal));
}

}
