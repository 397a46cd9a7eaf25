/// A set of non-negative integers below a limit, which finds the next member in logarithmic time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace alcove {

class NumberSet {
  public:
    /// Empties the set and changes its limit.
    void reset(std::size_t limit);
    void insert(std::size_t number);
    void remove(std::size_t number);
    bool empty() const { return levels_.back()[0] == 0; }

    /// The smallest member that is at least `number`, or else the smallest of all. The set must not be empty.
    std::size_t next_or_first(std::size_t number) const;

  private:
    static constexpr std::size_t bits = 64;

    /// Level 0 has one bit per number. In the next levels, bit i is set if word i of the level before is not zero. The
    /// last level has one word.
    std::vector<std::vector<std::uint64_t>> levels_{{0}};
};

}
