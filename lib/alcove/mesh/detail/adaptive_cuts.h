/// Refines a Bisection where a predicate returns true, for tessellate() with a predicate.
#pragma once

#include "alcove/mesh/detail/bisection.h"
#include "alcove/mesh/detail/tessellate.h"

namespace alcove {

/// \return false if `most_faces` prevented some cuts.
bool cut_where(Bisection& bisection, const Mesh& mesh, const SplitPredicate& split,
               const AdaptiveTessellateOptions& options);

}
