/// The surfels of a target, with their contacts, their order and the pilot. Each of these is computed at its first use.
#pragma once

#include "alcove/bake/detail/pilot.h"
#include "alcove/bake/detail/target.h"
#include "alcove/bake/detail/target_occluders.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alcove {

class TargetSurfels {
  public:
    /// Adds the time that its functions take to `seconds`.
    TargetSurfels(BakeTarget& target, TargetOccluders& occluders, BakeSeconds& seconds)
        : target_(target), occluders_(occluders), seconds_(seconds) {}

    /// Finds the contacts of all surfels, unless they have been found already.
    void find_contacts();
    /// Finds the contacts of copies of some surfels, unless the contacts of all surfels have been found already.
    void find_contacts(std::span<const std::uint32_t> indices, std::span<Surfel> copies);
    /// The number of surfels that touch other faces; estimated until all contacts are known.
    std::size_t contacts() const { return contacts_; }
    /// False only if it is certain that no surfel touches other faces.
    bool may_touch() const { return !has_all_contacts_ || contacts_ > 0; }

    /// A number of rays per surfel that costs hardly any time; large if there are few surfels.
    int cheap_rays() const;

    /// See spatial_order().
    const std::vector<std::uint32_t>& order();
    /// The indices of `count` runs of at most `length` surfels along the Morton curve, evenly spread.
    std::vector<std::uint32_t> runs(std::size_t count, std::size_t length);

    /// The pilot, which the first call makes. Later calls ignore the options.
    const Pilot& pilot(const PilotOptions& options);
    /// Null before the first call of pilot().
    const Pilot* known_pilot() const { return pilot_ ? &*pilot_ : nullptr; }

  private:
    void find_contacts_of_sample(const std::vector<std::uint32_t>& indices);

    BakeTarget& target_;
    TargetOccluders& occluders_;
    BakeSeconds& seconds_;
    std::size_t contacts_ = 0;
    bool has_all_contacts_ = false;
    std::vector<std::uint32_t> order_;
    std::optional<Pilot> pilot_;
};

}
