// Target for the mesh readers, built once per format. ALCOVE_FUZZ_FILE is the file name that the reader sees.
#include "alcove/mesh/formats/formats.h"
#include "checks.h"
#include "mesh_checks.h"

using namespace alcove;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::accept_refusals(ALCOVE_FUZZ_FILE, [&] {
        fuzz::check_mesh(read_bytes(FileBytes(ALCOVE_FUZZ_FILE, fuzz::text_of({data, size}))));
    });
    return 0;
}
