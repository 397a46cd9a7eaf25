/// The formulas of the documents, word for word and in double: what the estimators are held against. Nothing here
/// knows the library's own versions.
#pragma once

#include "alcove/base/types.h"

#include <functional>

namespace alcove::test {

/// d(x) of the formulas.
using Distance = std::function<double(const Vec3d&)>;

/// Which way the directions of the hemisphere methods are brought to the normal's side.
enum class Axes {
    world,  ///< reversed where they point below the surface, as the documents have it
    surfel, ///< mirrored into the upper half around the normal
};

// Each gives ao at the surface point p with unit normal n, at the constants of its document.

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
