/// Random damage to files, text or not.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace alcove::fuzz {

using Random = std::mt19937_64;

/// `bytes` with one to six changes: bits and bytes set, words and numbers made extreme, pieces deleted, doubled, taken from
/// another of the `others`, the end cut off.
std::string mutated(std::string bytes, const std::vector<std::string>& others, Random& random);

}
