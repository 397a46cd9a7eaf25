/// Explains errors of the command line in one line with a fix.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace alcove::cli {

/// The message for a parsing error. `words` are the arguments without the program name.
std::string explain(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words);

}
