/// Checks the structure of a .vdb file before OpenVDB reads it, as OpenVDB trusts the file.
#pragma once

#include "alcove/vdb/vdb_file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace alcove {

/// A grid in the order of the file.
struct GridEntry {
    StoredGrid grid;
    std::string unique_name;
    /// The centre and the diagonal of the stack's frame, if Alcove wrote the grid as a level of a stack; otherwise
    /// empty.
    std::vector<double> stack;
    std::string parent;    ///< unique name of the grid whose tree this one shares; empty if it does not share one
    bool is_linear = true; ///< whether its transform is linear; otherwise it is a frustum
    std::size_t bytes = 0; ///< of its tree in memory, including doubles that are converted to floats
    std::int64_t end = 0;  ///< offset of the next grid
};

struct VdbStructure {
    bool has_offsets = true; ///< a stream has none
    std::vector<GridEntry> grids;
};

/// Parses the names and metadata of all grids. Parses grids of floats and doubles down to the values of each leaf, for
/// all types of compression, and skips the values of other grids.
/// \throw InputError if the file is not a .vdb, a length exceeds the rest of the file or does not fit the values, an
/// offset is wrong, the two copies of a mask differ, a transform is inconsistent, zipped values cannot be decompressed,
/// or bytes are left over; also for files that OpenVDB before 2.0 (2013) wrote. Cost: reads the file once and unzips
/// zipped values.
VdbStructure check_vdb_structure(const std::filesystem::path& file);

}
