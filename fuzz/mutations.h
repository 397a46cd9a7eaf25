/// Random damage to files, text or not.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace alcove::fuzz {

using Random = std::mt19937_64;

/// Applies one to six random changes to `bytes`: flips bits, sets bytes, replaces words and numbers by extreme ones,
/// deletes or duplicates ranges, copies ranges from one of the `others`, truncates.
std::string mutated(std::string bytes, const std::vector<std::string>& others, Random& random);

}
