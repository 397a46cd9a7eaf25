/// All estimators by name, for selection at run time.
#pragma once

#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/occluders.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

/// A parameter of a method, without the type of its estimator.
struct ParameterInfo {
    std::string_view name;
    double standard; ///< default value
    double min, max; ///< inclusive
    bool integer, flag;
    std::string_view unit;
    std::string_view summary;
};

/// User settings: the radius, and parameters by name. If several methods run, a parameter applies to the first method
/// that has it. If a name occurs twice, the later value wins.
struct Settings {
    float radius = 0.1f; ///< units of the field; may be infinite
    std::vector<std::pair<std::string, double>> parameters{};
    /// Upper bound on the radius for methods that probe the field: farther than one diagonal from a mesh, probes carry
    /// no information.
    float max_probe_distance = 1.0f;
    /// Reference ao at some surfels of the mesh. Methods that contain a network fit the network to it. May be null.
    std::shared_ptr<const Labels> labels{};
};

/// The kind of samples that a method's sample-count parameter counts.
enum class SampleKind { none, rays, probes };
/// The name of the sample-count parameter for this kind: "rays", "samples" for probes, or "".
constexpr std::string_view parameter_of(SampleKind samples) {
    return samples == SampleKind::rays ? "rays" : samples == SampleKind::probes ? "samples" : "";
}

struct MethodInfo {
    std::string_view name;
    std::string_view summary;
    std::string_view formula;
    std::string_view source;
    std::string_view cost; ///< map() calls and rays per point, in words
    std::string_view good, bad;
    std::vector<ParameterInfo> (*parameters)();
    SampleKind samples_are; ///< kind of samples its sample-count parameter counts
};

/// A type-erased estimator with its description.
struct Method : MethodInfo {
    ChannelSet gives;
    bool needs_grid;        ///< probes the field
    bool needs_mesh;        ///< traces the triangles
    bool unbounded_radius;  ///< the radius may be infinite
    float reference_radius; ///< radius that the constants of the formula assume; 0 if they assume none
    /// Evaluates the surfels in the sequence `order`, their spatial_order(), which all methods of a bake share. Ignores
    /// parameters that the method does not have.
    ChannelValues (*bake)(std::span<const Surfel>, std::span<const std::uint32_t> order, const Occluders&,
                          const Settings&, ChannelSet wanted, const Progress&);
};

/// All methods, in documentation order.
std::span<const Method> catalog();

/// Finds the method called `name` among those that give ao. \throw InputError for an unknown name; the message lists
/// these methods.
const Method& find_method(std::string_view name);

/// The methods to run for the wanted channels, each once: the chosen method for every channel it gives, and for
/// each remaining channel the first method of the catalogue that gives it. \throw InputError if ao_short or
/// ao_long is wanted and the chosen method does not give it: these are factors of one method's own ao.
std::vector<const Method*> methods_for(const Method& chosen, ChannelSet wanted);

/// Checks the settings. \throw InputError if no method has a parameter of that name (the message lists those that
/// exist), or if a value is out of range.
void check_settings(std::span<const Method* const> methods, const Settings& settings);
void check_settings(const MethodInfo& method, const Settings& settings);

/// One of the methods that a bake runs, with its own settings and the channels that it computes.
struct MethodRun {
    const Method* method;
    Settings settings;
    ChannelSet wanted;
};
/// The methods of methods_for(), each with its settings and channels. \throw what methods_for() and check_settings()
/// throw.
std::vector<MethodRun> runs_for(const Method& chosen, const Settings& settings, ChannelSet wanted);

/// Evaluates all wanted channels at the surfels (unit space). \throw what methods_for() and check_settings()
/// throw, and InputError if a method needs a field or triangles and `occluders` has none.
ChannelValues evaluate(std::span<const Surfel> surfels, const Occluders& occluders, const Method& chosen,
                       const Settings& settings, ChannelSet wanted, const Progress& progress = {});
/// Like evaluate() above, for callers that already have the spatial_order() of the surfels.
ChannelValues evaluate(std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                       const Occluders& occluders, const Method& chosen, const Settings& settings, ChannelSet wanted,
                       const Progress& progress = {});

/// A method with its sample count.
struct MethodChoice {
    const Method* method = nullptr;
    /// Probes or rays per vertex (see MethodInfo::samples_are); 0 if the method has no such parameter.
    int samples = 0;

    std::string label() const;             ///< "guided:3", "multiscale"
    Settings settings(float radius) const; ///< radius in unit space
    int rays() const;                      ///< `samples` if they are rays, else 0
    bool operator==(const MethodChoice&) const = default;
};

/// `samples` defaults to the method's default. \throw InputError if the method has no sample count, or if
/// `samples` is out of its range.
MethodChoice choose(const Method& method, std::optional<int> samples = {});

/// The method, with the sample count from the settings, or with its default sample count if the settings have none.
MethodChoice choice_of(const Method& method, const Settings& settings);

/// Every method that gives ao, with its default sample count; also guided, exact and traced at several ray counts.
std::vector<MethodChoice> standard_choices();

}
