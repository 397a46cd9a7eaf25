/// Literal transcriptions of the reference formulas in double precision, to test the estimators against. Independent
/// of the code of the library.
#pragma once

#include "alcove/base/types.h"

#include <functional>

namespace alcove::test {

/// d(x) of the formulas.
using Distance = std::function<double(const Vec3d&)>;

/// How the hemisphere methods move directions to the side of the normal.
enum class Axes {
    world,  ///< reversed if they point below the surface, as in the reference formulas
    surfel, ///< mirrored into the upper half around the normal
};

// Each function returns the value of its formula at the surface point p with unit normal n, with the constants of the
// reference.

double classic(const Distance& d, const Vec3d& p, const Vec3d& n);
double convexity(const Distance& d, const Vec3d& p, const Vec3d& n);
double exponential(const Distance& d, const Vec3d& p, const Vec3d& n, double factor);
double decay(const Distance& d, const Vec3d& p, const Vec3d& n, double step);
double decay_linear(const Distance& d, const Vec3d& p, const Vec3d& n, double step);
double multiplicative(const Distance& d, const Vec3d& p, const Vec3d& n);
double multiscale(const Distance& d, const Vec3d& p, const Vec3d& n);
double multiscale_short(const Distance& d, const Vec3d& p, const Vec3d& n);
double multiscale_long(const Distance& d, const Vec3d& p, const Vec3d& n);
double jittered(const Distance& d, const Vec3d& p, const Vec3d& n);
double jittered_falloff(const Distance& d, const Vec3d& p, const Vec3d& n, double falloff);
double hemisphere_random(const Distance& d, const Vec3d& p, const Vec3d& n, Axes axes, double seed);
double hemisphere(const Distance& d, const Vec3d& p, const Vec3d& n, Axes axes, int count);
double fibonacci(const Distance& d, const Vec3d& p, const Vec3d& n, Axes axes);

}
