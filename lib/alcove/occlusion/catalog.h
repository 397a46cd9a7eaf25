/// Every estimator by its name: what is chosen at run time, once a bake.
#pragma once

#include "alcove/occlusion/evaluate.h"
#include "alcove/occlusion/occluders.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

/// A parameter of a method, as the Parameter of its struct describes it.
struct ParameterInfo {
    std::string_view name;
    double standard; ///< its default
    double min, max; ///< inclusive
    bool integer, flag;
    std::string_view unit;
    std::string_view summary;
};

/// What a user sets: the radius of every estimator, and parameters by their names. Where several methods bake, a
/// parameter is that of the first which has it; of two values the later holds.
struct Settings {
    float radius = 0.1f; ///< units of the field; may be infinite
    std::vector<std::pair<std::string, double>> parameters{};
    /// The radius is cut to this where it is that of probes: one further from a mesh than its diagonal tells nothing of
    /// it.
    float max_probe_distance = 1.0f;
};

struct MethodInfo {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    std::string_view cost; ///< in map() calls a surfel
    std::string_view good, bad;
    std::vector<ParameterInfo> (*parameters)();

    bool has_parameter(std::string_view parameter) const {
        for (const ParameterInfo& info : parameters())
            if (info.name == parameter)
                return true;
        return false;
    }
};

/// An estimator behind a function pointer, as its struct describes itself.
struct Method : MethodInfo {
    ChannelSet gives;
    bool needs_grid;        ///< whether it probes the field
    bool needs_mesh;        ///< whether it traces the triangles
    float reference_radius; ///< that the constants of the formula stand for; 0 where it has none
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

/// A method and the number of samples or rays it is given.
struct MethodChoice {
    const Method* method = nullptr;
    /// Probes or rays a vertex, as the parameter of that name counts them; 0 where the method has neither.
    int samples = 0;

    std::string label() const;             ///< "guided:3", "multiscale"
    Settings settings(float radius) const; ///< unit space
    int rays() const;                      ///< `samples` of a method that takes rays, else 0
    bool operator==(const MethodChoice&) const = default;
};

/// Without a number, the method's default. \throw InputError if the method takes none, or not that one.
MethodChoice choose(const Method& method, std::optional<int> samples = {});

/// With the number that is among the settings, else the default.
MethodChoice choice_of(const Method& method, const Settings& settings);

/// Every method that gives ao by its defaults, and those whose error falls with their rays at a few of them.
std::vector<MethodChoice> standard_choices();

}
