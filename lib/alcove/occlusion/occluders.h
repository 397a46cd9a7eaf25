/// What stands around the surfels, for estimators that are chosen at run time.
#pragma once

#include "alcove/field/any_field.h"
#include "alcove/occlusion/exact.h"

#include <optional>
#include <vector>

namespace alcove {

/// A field, triangles, or both, in unit space. Copies share them; const use is thread-safe.
class Occluders {
  public:
    Occluders(AnyField field) : field_(std::move(field)) {}
    Occluders(RaySurface rays) : rays_(std::move(rays)) {}
    Occluders(AnyField field, RaySurface rays) : field_(std::move(field)), rays_(std::move(rays)) {}

    /// \throw InputError where there is none.
    const AnyField& field() const;
    /// \throw InputError where there are no triangles.
    const RaySurface& rays() const;

  private:
    std::optional<AnyField> field_;
    std::optional<RaySurface> rays_;
};

}
