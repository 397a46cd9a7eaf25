/// What a fit leaves: the table the library is compiled with, and the error of every mesh.
#pragma once

#include "examples.h"
#include "training.h"

#include <string>
#include <vector>

namespace alcove::fit {

/// Of one mesh at one radius.
struct Errors {
    double deviation;        ///< standard deviation of the truth: the RMSE of the best constant
    double ten, twenty_four; ///< RMSE
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

/// A C++ header of the coefficients, with the meshes they were fitted to and the mean errors above them.
std::string table_of(const Fit& fit);

/// The mean errors, and those of each mesh, as Markdown.
std::string report_of(const Fit& fit);

}
