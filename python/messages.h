/// Messages of the library in the words of the module.
#pragma once

#include <string>
#include <vector>

namespace alcove::python {

/// The message with the arguments of the module instead of the options of the program: `normals="angle"` instead of
/// `--normals angle`. Options that the module lacks become `the program's --name`.
std::string in_python(const std::string& message);
std::vector<std::string> in_python(std::vector<std::string> messages);

}
