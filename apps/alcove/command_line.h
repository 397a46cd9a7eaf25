/// What is wrong with a command line, said in one line with the mend.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace alcove::cli {

/// The message for an error of parsing `words`, the arguments without the program's name.
std::string explain(const CLI::App& program, const CLI::ParseError& error,
                    const std::vector<std::string>& words);

/// The name that takes the fewest typing mistakes to become `typed`; empty where
/// none is near enough to be meant.
std::string nearest(std::string_view typed, const std::vector<std::string>& names);

}
