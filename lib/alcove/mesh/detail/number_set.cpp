#include "alcove/mesh/detail/number_set.h"

#include <bit>

namespace alcove {

void NumberSet::reset(std::size_t limit) {
    std::size_t level = 0;
    for (std::size_t count = limit; level == 0 || count > 1; ++level) {
        count = (count + bits - 1) / bits;
        if (level == levels_.size())
            levels_.emplace_back();
        levels_[level].assign(count > 0 ? count : 1, 0);
    }
    levels_.resize(level);
}

void NumberSet::insert(std::size_t number) {
    for (std::vector<std::uint64_t>& level : levels_) {
        level[number / bits] |= std::uint64_t{1} << number % bits;
        number /= bits;
    }
}

void NumberSet::remove(std::size_t number) {
    for (std::vector<std::uint64_t>& level : levels_) {
        level[number / bits] &= ~(std::uint64_t{1} << number % bits);
        number /= bits;
        if (level[number] != 0)
            return;
    }
}

std::size_t NumberSet::next_or_first(std::size_t number) const {
    std::size_t level = 0;
    for (; level < levels_.size(); ++level) {
        const std::size_t word = number / bits;
        const std::uint64_t from = word < levels_[level].size() ? levels_[level][word] >> number % bits : 0;
        if (from != 0) {
            number += static_cast<std::size_t>(std::countr_zero(from));
            break;
        }
        number = word + 1;
    }
    if (level == levels_.size()) {
        --level;
        number = static_cast<std::size_t>(std::countr_zero(levels_[level][0]));
    }
    for (; level > 0; --level)
        number = number * bits + static_cast<std::size_t>(std::countr_zero(levels_[level - 1][number]));
    return number;
}

}
