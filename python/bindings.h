/// The parts of the module that other files define.
#pragma once

#include "alcove/mesh/mesh.h"

#include <pybind11/pybind11.h>

namespace alcove::python {

void add_mesh(pybind11::module_& module);
void add_field(pybind11::module_& module);

/// The mesh that `object` is or describes: a Mesh, a pair (vertices, faces), or points (vertices, None). \throw
/// py::type_error that names `argument`
Mesh to_mesh(const pybind11::object& object, const std::string& argument);

}
