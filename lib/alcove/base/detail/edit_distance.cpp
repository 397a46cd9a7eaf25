#include "alcove/base/detail/edit_distance.h"

#include <algorithm>
#include <numeric>

namespace alcove {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t(0));
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

std::string nearest_name(std::string_view typed, const std::vector<std::string>& names) {
    std::string best;
    std::size_t fewest = typed.size() / 3 + 1;
    for (const std::string& name : names)
        if (const std::size_t count = edit_distance(typed, name); count <= fewest && (best.empty() || count < fewest)) {
            fewest = count;
            best = name;
        }
    return best;
}

}
