#include "method_options.h"

#include "alcove/base/errors.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>

namespace alcove::cli {
namespace {

double parse_value(const std::string& setting, const std::string& text) {
    if (text == "true" || text == "false")
        return text == "true" ? 1.0 : 0.0;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw UsageError(
            fmt::format("--set takes name=value with a number, true or false, not '{}'", setting));
    return value;
}

}

void add_method_options(CLI::App& verb, MethodRequest& request, const std::string& method_help) {
    verb.add_option("--method", request.method, method_help + method_names())
        ->type_name("NAME")
        ->capture_default_str();
    verb.add_option("--samples", request.samples, "Probes a point, for methods that probe")->type_name("N");
    verb.add_option("--rays", request.rays, "Rays a point, for methods that trace (traced: 64)")
        ->type_name("N");
    verb.add_option("--seed", request.seed, "Seed of the directions")->type_name("N");
    verb.add_option(
            "--set", request.set,
            "A parameter, as `alcove methods` lists them, of the method or of the first that has it among "
            "those that supply what it does not give")
        ->type_name("NAME=VALUE");
}

const Method& parse_method(const std::string& name) {
    try {
        return find_method(name);
    } catch (const InputError& unknown) {
        throw UsageError(unknown.what());
    }
}

std::vector<const Method*> needed_methods(const Method& chosen, ChannelSet wanted) {
    try {
        return methods_for(chosen, wanted);
    } catch (const InputError& impossible) {
        throw UsageError(impossible.what());
    }
}

namespace {

/// The parameters that were set, as `check(settings)` lets them pass.
template <class Check>
Settings parse_settings_with(const MethodRequest& request, const Check& check) {
    Settings settings;
    const auto set = [&](const std::string& option, std::string name, double value) {
        const Settings one{.parameters = {{std::move(name), value}}};
        try {
            check(one);
        } catch (const InputError& wrong) {
            throw UsageError(option + ": " + wrong.what());
        }
        settings.parameters.push_back(one.parameters.front());
    };
    if (request.samples)
        set("--samples", "samples", *request.samples);
    if (request.rays)
        set("--rays", "rays", *request.rays);
    if (request.seed)
        set("--seed", "seed", *request.seed);
    for (const std::string& setting : request.set) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos)
            throw UsageError(fmt::format("--set takes name=value, not '{}'", setting));
        set("--set " + setting, setting.substr(0, equals), parse_value(setting, setting.substr(equals + 1)));
    }
    return settings;
}

}

Settings parse_settings(const MethodRequest& request, const Method& method, ChannelSet wanted) {
    const std::vector<const Method*> methods = needed_methods(method, wanted);
    return parse_settings_with(request, [&](const Settings& one) { check_settings(methods, one); });
}

Settings parse_settings(const MethodRequest& request, const MethodInfo& method) {
    return parse_settings_with(request, [&](const Settings& one) { check_settings(method, one); });
}

Needs needs_of(const Method& method, ChannelSet wanted) {
    Needs needs;
    for (const Method* needed : methods_for(method, wanted))
        needs = {needs.field || needed->needs_grid, needs.rays || needed->needs_mesh};
    return needs;
}

std::string method_names() {
    std::string names;
    for (const Method& method : catalog())
        if (method.gives.has(Channel::ao))
            names += (names.empty() ? "" : ", ") + std::string(method.name);
    return names;
}

}
