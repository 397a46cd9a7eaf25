// Target for the reader of level sets.
#include "alcove/vdb/vdb_file.h"
#include "checks.h"
#include "grid_checks.h"
#include "memory_file.h"

using namespace alcove;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const fuzz::MemoryFile file({data, size});
    fuzz::accept_refusals(file.path().string(), [&] { fuzz::check_grids(read_grids(file.path())); });
    return 0;
}
