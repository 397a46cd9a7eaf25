#include "options.h"

#include "alcove/occlusion/catalog.h"
#include "alcove/render/detail/image_method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace alcove::cli {
namespace {

std::string value_of(const ParameterInfo& parameter, double value) {
    if (parameter.flag)
        return value != 0.0 ? "true" : "false";
    return parameter.integer ? fmt::format("{:.0f}", value) : fmt::format("{:g}", value);
}

nlohmann::ordered_json json_of(const ParameterInfo& parameter) {
    const auto number = [&](double value) -> nlohmann::ordered_json {
        if (parameter.flag)
            return value != 0.0;
        if (parameter.integer)
            return static_cast<std::int64_t>(value);
        return value;
    };
    return {{"name", parameter.name},       {"default", number(parameter.standard)},
            {"min", number(parameter.min)}, {"max", number(parameter.max)},
            {"unit", parameter.unit},       {"summary", parameter.summary}};
}

std::vector<std::string_view> list_of(ChannelSet gives) {
    std::vector<std::string_view> names;
    for (const ChannelInfo& channel : channels)
        if (gives.has(channel.channel))
            names.push_back(channel.name);
    return names;
}

nlohmann::ordered_json json_of(const MethodInfo& method, ChannelSet gives) {
    nlohmann::ordered_json parameters = nlohmann::ordered_json::array();
    for (const ParameterInfo& parameter : method.parameters())
        parameters.push_back(json_of(parameter));
    return {{"name", method.name},       {"summary", method.summary}, {"gives", list_of(gives)},
            {"formula", method.formula}, {"source", method.source},   {"cost_in_map_calls", method.cost},
            {"good", method.good},       {"bad", method.bad},         {"parameters", parameters}};
}

void print(const MethodInfo& method, ChannelSet gives) {
    const auto line = [](std::string_view key, std::string_view text) { fmt::print("  {:<9}{}\n", key, text); };
    fmt::print("{}: {}\n", method.name, method.summary);
    line("gives", names_of(gives));
    line("formula", method.formula);
    line("source", method.source);
    line("cost", method.cost);
    line("good", method.good);
    line("bad", method.bad);
    std::string_view key = "set";
    for (const ParameterInfo& p : method.parameters()) {
        const std::string range = p.flag ? "" : fmt::format(" ({} to {})", value_of(p, p.min), value_of(p, p.max));
        line(key, fmt::format("{}={}{}{}: {}", p.name, value_of(p, p.standard),
                              p.unit.empty() ? "" : fmt::format(" {}", p.unit), range, p.summary));
        key = "";
    }
    fmt::print("\n");
}

void run(const CommonOptions& options) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    const auto list = [&](const MethodInfo& method, ChannelSet gives) {
        if (options.json)
            all.push_back(json_of(method, gives));
        else
            print(method, gives);
    };
    for (const Method& method : catalog())
        list(method, method.gives);
    for (const ImageMethod& method : image_methods())
        list(method, Channel::ao);
    if (options.json)
        print_json({{"methods", all}});
}

}

void add_methods(CLI::App& program) {
    auto* verb = program.add_subcommand("methods", "List every method: formula, source, cost, parameters");
    auto options = std::make_shared<CommonOptions>();
    add_common_options(*verb, *options);
    verb->footer("In bake and render, --radius sets the radius, and --set sets any other parameter by name:\n"
                 "  alcove bake scan.ply -o scan_ao.ply --method hemisphere --set surfel_frame=true\n");
    verb->callback([options] { run(*options); });
}

}
