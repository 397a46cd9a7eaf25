#include "alcove/scene/detail/memory_estimate.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {

void MemoryEstimate::add(const std::string& file, double bytes) {
    by_file_[file] += bytes;
    total_ += bytes;
}

void MemoryEstimate::check() const {
    if (left() < 0.0)
        refuse();
}

void MemoryEstimate::refuse() const {
    const auto most = std::max_element(by_file_.begin(), by_file_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    const auto gigabytes = [](double bytes) { return rounded(bytes / 1e9, 2); };
    throw LimitError(fmt::format("the scene needs about {} GB, over the limit of {} GB; {} needs most, {} GB: use a "
                                 "coarser voxel for it, fewer objects, or fewer triangles",
                                 gigabytes(total_), gigabytes(limit_), most->first, gigabytes(most->second)));
}

}
