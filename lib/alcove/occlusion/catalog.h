/// Every estimator by its name: what is chosen at run time, once a bake.
#pragma once

#include "alcove/occlusion/bake.h"
#include "alcove/occlusion/method_info.h"
#include "alcove/occlusion/occluders.h"

#include <string_view>
#include <vector>

namespace alcove {

/// An estimator behind a function pointer, as its struct describes itself.
struct Method : MethodInfo {
    ChannelSet gives;
    bool asks_field;       ///< whether it probes the field
    bool asks_rays;        ///< whether it traces the triangles
    float document_radius; ///< that the constants of the formula stand for; 0 where it has none
    /// Along the spatial_order(), which methods of one bake share. Settings of parameters the method has not are
    /// passed over.
    ChannelValues (*bake)(std::span<const Surfel>, std::span<const std::uint32_t> order, const Occluders&,
                          const Settings&, ChannelSet wanted, const Progress&);
};

/// All methods, in the order of the documentation.
std::span<const Method> catalog();

/// The method of that name that gives ao. \throw InputError for an unknown name, listing the known ones.
const Method& find_method(std::string_view name);

/// The methods that give the wanted channels, each asked once: the chosen one for all that it gives, for the
/// rest the first of the catalog. \throw InputError for a channel that only other methods than the chosen one
/// can give along with its ao, naming them.
std::vector<const Method*> methods_for(const Method& chosen, ChannelSet wanted);

/// \throw InputError if none of the methods has a parameter that is set, or its value is out of range, naming
/// what there is.
void check_settings(std::span<const Method* const> methods, const Settings& settings);
void check_settings(const MethodInfo& method, const Settings& settings);

/// All wanted channels. \throw what methods_for() and check_settings() throw, and InputError where there is
/// neither field nor triangles of the kind that a method asks.
ChannelValues bake_channels(std::span<const Surfel> surfels, const Occluders& occluders, const Method& chosen,
                            const Settings& settings, ChannelSet wanted, const Progress& progress = {});

}
