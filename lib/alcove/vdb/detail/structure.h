/// A look at a .vdb before OpenVDB reads it, which believes what the file says of itself.
#pragma once

#include <filesystem>

namespace alcove {

/// Follows the names and metadata of the file, and all of its grids of floats down to the values of each leaf, whatever
/// their compression. \throw InputError where a length is more than what is left of the file or other than that of the
/// values it is of, where places or masks that are stored twice differ, a transform contradicts itself, zipped values do
/// not unpack, or bytes are left over; and for grids of floats that OpenVDB before 2.0 (2013) wrote. Grids of other types are
/// passed over. What is no .vdb passes: OpenVDB says so better. Cost: reads the file once, and unzips what is zipped.
void check_vdb_structure(const std::filesystem::path& file);

}
