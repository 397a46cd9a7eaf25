/// The choice of an estimator and of its parameters, for every verb that computes occlusion.
#pragma once

#include "common.h"

#include "alcove/occlusion/catalog.h"

#include <optional>

namespace alcove::cli {

/// What a user may say of the method.
struct MethodRequest {
    std::string method = "traced";
    std::optional<int> samples{}, rays{};
    std::optional<std::uint32_t> seed{};
    std::vector<std::string> set{}; ///< name=value
};

/// Adds --method, --samples, --rays, --seed and --set.
void add_method_options(CLI::App& verb, MethodRequest& request, const std::string& method_help);

/// The estimator of that name. \throw UsageError listing the known ones.
const Method& parse_method(const std::string& name);

/// As methods_for(). \throw UsageError where that throws.
std::vector<const Method*> needed_methods(const Method& chosen, ChannelSet wanted);

/// The parameters that were set; the radius is not among them. \throw UsageError for what is no name=value, and
/// for what the methods that give the wanted channels do not take.
Settings parse_settings(const MethodRequest& request, const Method& method, ChannelSet wanted);

/// The same of one method alone.
Settings parse_settings(const MethodRequest& request, const MethodInfo& method);

/// What the methods that give the wanted channels ask.
struct Needs {
    bool field = false; ///< a grid
    bool rays = false;  ///< the triangles
};
Needs needs_of(const Method& method, ChannelSet wanted);

/// The names of the methods, one after the other.
std::string method_names();

}
