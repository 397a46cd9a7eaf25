/// Bakes one input: reads, bakes, writes and prints.
#pragma once

#include "bake_batch.h"
#include "bake_verb.h"

namespace alcove::cli {

/// Bakes one input. \throw what read_mesh(), bake(), bake_maps() and write_mesh() throw; std::runtime_error if --strict
/// is given and the error target is missed.
void bake_file(const BakeVerb& verb, const BatchFile& file, const BakeProgress& progress);

}
