/// Checks the structure of a .vdb file before OpenVDB reads it, as OpenVDB trusts the file.
#pragma once

#include <filesystem>

namespace alcove {

/// Parses the names and metadata of the file, and all of its float grids down to the values of each leaf, for all
/// types of compression. Skips grids of other types.
/// \throw InputError if the file is not a .vdb, a length exceeds the rest of the file or differs from that of its
/// values, offsets or masks that are stored twice differ, a transform is inconsistent, zipped values do not unpack, or
/// bytes are left over; also for float grids that OpenVDB before 2.0 (2013) wrote. Cost: reads the file once and unzips
/// what is zipped.
void check_vdb_structure(const std::filesystem::path& file);

}
