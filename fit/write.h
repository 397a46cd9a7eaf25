/// Writes the results of a fit: the table that the library is compiled with, and the error on every mesh.
#pragma once

#include "examples.h"
#include "training.h"

#include <string>
#include <vector>

namespace alcove::fit {

/// Errors on one mesh at one radius.
struct Errors {
    double deviation;        ///< standard deviation of the reference: the RMSE of the best constant
    double ten, twenty_four; ///< RMSE with ten and 24 probes
};

struct MeshErrors {
    std::string name;
    bool fitted;
    std::array<Errors, radii.size()> at;
};

struct Fit {
    Network ten, twenty_four;
    std::vector<MeshErrors> errors;
};

/// A C++ header of the coefficients. A comment lists the meshes they were fitted to and the mean errors.
std::string table_of(const Fit& fit);

/// The mean errors and those on each mesh, as Markdown.
std::string report_of(const Fit& fit);

}
