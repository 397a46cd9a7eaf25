#include "options.h"

#include "ending.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/simd.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace alcove::cli {
namespace {

std::optional<Length> parse_voxel(const std::string& text) {
    if (text == "auto")
        return {};
    const Length voxel = length_without_vx(text, "0.2 (scene units), 0.5% (of the diagonal) or auto");
    if (std::isinf(voxel.value))
        throw InputError("takes a finite length, not 'inf': write 0.2 (scene units) or 0.5%");
    return voxel;
}

Vec3d parse_triple(const std::string& text, Triple kind) {
    Vec3d v;
    const char* at = text.c_str();
    for (int axis = 0; axis < 3; ++axis) {
        char* end = nullptr;
        v[axis] = std::strtod(at, &end);
        if (end == at || !std::isfinite(v[axis]) || *end != (axis == 2 ? '\0' : ','))
            throw InputError(fmt::format("takes three numbers, not '{}': write 1,2.5,-3", text));
        at = end + 1;
    }
    if (kind == Triple::direction && v == Vec3d(0.0))
        throw InputError("takes a direction, not 0,0,0: write 0,1,0 or 0,0,1");
    return v;
}

/// A number of bytes, such as 500MB or 1.5GiB.
double parse_size(const std::string& text) {
    static const std::map<std::string, double> units{
        {"", 1.0},   {"b", 1.0},  {"k", 1e3},   {"kb", 1e3},     {"m", 1e6},      {"mb", 1e6},     {"g", 1e9},
        {"gb", 1e9}, {"t", 1e12}, {"tb", 1e12}, {"kib", 1024.0}, {"mib", 0x1p20}, {"gib", 0x1p30}, {"tib", 0x1p40}};
    double number = 0.0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    std::string unit(rest, end);
    std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto known = units.find(unit);
    if (error != std::errc() || known == units.end() || !(number * known->second >= 1.0) || !std::isfinite(number))
        throw InputError(fmt::format("takes a size, not '{}': write 2GB, 500MB or 1.5GiB", text));
    return number * known->second;
}

/// Adds --max-memory and --max-read.
void add_limits(CLI::App& verb) {
    const auto add = [&](const char* name, void (*limit)(double), const char* description) {
        verb.add_option_function<std::string>(
                name, [limit](const std::string& text) { limit(parse_size(text)); }, description)
            ->check(parsable(parse_size))
            ->type_name("SIZE");
    };
    add("--max-memory", limit_memory,
        "Limit on memory for level sets and images, for example 2GB, 500MB or 1.5GiB. Default: half of the machine's "
        "memory");
    add("--max-read", limit_reading,
        "Largest file to read; a pipe that delivers more is refused. Default: half of --max-memory, at most 4GB");
}

std::pair<std::string, double> parse_setting(const std::string& setting) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
        throw InputError(fmt::format("takes name=value, not '{}'", setting));
    const std::string text = setting.substr(equals + 1);
    double value = text == "true" ? 1.0 : 0.0;
    if (text != "true" && text != "false") {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            throw InputError(fmt::format("takes name=value with a number, true or false, not '{}'", setting));
    }
    return {setting.substr(0, equals), value};
}

/// Escapes DEL and U+0080 to U+009F in a JSON text, which has escapes for all other control characters.
std::string with_escaped_controls(std::string_view json) {
    std::string text;
    text.reserve(json.size());
    for (std::size_t at = 0; at < json.size(); ++at) {
        const auto byte = [&](std::size_t i) { return i < json.size() ? static_cast<unsigned char>(json[i]) : 0u; };
        if (byte(at) == 0x7f)
            text += "\\u007f";
        else if (byte(at) == 0xc2 && byte(at + 1) >= 0x80 && byte(at + 1) < 0xa0)
            text += fmt::format("\\u{:04x}", byte(++at));
        else
            text += json[at];
    }
    return text;
}

}

Length length_without_vx(const std::string& text, std::string_view forms) {
    try {
        if (const Length length(text); length.unit != Length::Unit::voxels)
            return length;
    } catch (const InputError&) { // the message below fits better
    }
    throw InputError(fmt::format("takes {}, not '{}'", forms, text));
}

std::string version_text() {
    const std::string commit = ALCOVE_COMMIT;
    return fmt::format("alcove {} ({}{}{})", ALCOVE_VERSION, commit, commit.empty() ? "" : ", ", simd_target());
}

void add_run_options(CLI::App& verb, CommonOptions& options) {
    verb.add_option("--threads", options.threads, "Threads to use; 0: one per core")->capture_default_str();
    add_choice<ProgressMode>(verb, "--progress", options.progress,
                             {{"auto", ProgressMode::automatic},
                              {"bar", ProgressMode::bar},
                              {"plain", ProgressMode::plain},
                              {"none", ProgressMode::none}},
                             "Progress on stderr: auto (a bar on a terminal), bar, plain, none")
        ->option_text("MODE");
    verb.add_option_function<double>(
            "--time-limit", [](const double& seconds) { limit_time(seconds); },
            "Stop after this many seconds with exit code 1, without writing unfinished files; a bake or image that "
            "would clearly take longer is refused, and the message names settings that stay within the limit")
        ->check(parsable([](const std::string& text) {
            char* end = nullptr;
            const double seconds = std::strtod(text.c_str(), &end);
            if (!(seconds > 0.0 && seconds <= 1e9) || *end != '\0')
                throw InputError(fmt::format("takes a number of seconds above 0 and up to 1e9, not '{}'", text));
        }))
        ->option_text("SECONDS");
    add_limits(verb);
    verb.add_flag("--quiet", options.quiet, "Print only errors and the result of --json");
    verb.set_version_flag("--version", version_text());
}

void add_common_options(CLI::App& verb, CommonOptions& options) {
    verb.add_flag("--json", options.json, "Print the result as one JSON object on stdout");
    add_run_options(verb, options);
}

void add_radius_option(CLI::App& verb, Length& radius, const std::string& description) {
    verb.add_option_function<std::string>(
            "--radius", [&radius](const std::string& text) { radius = Length(text); }, description)
        ->check(parsable([](const std::string& text) { return Length(text); }))
        ->type_name("LEN")
        ->default_str("10%");
}

void add_grid_options(CLI::App& verb, std::optional<Length>& voxel, SignChoice& sign) {
    verb.add_option_function<std::string>(
            "--voxel", [&voxel](const std::string& text) { voxel = parse_voxel(text); },
            "Edge of the finest voxel: 0.2, 0.5%, or auto (derived from the radius and, in a bake, the error)")
        ->check(parsable(parse_voxel))
        ->type_name("LEN")
        ->default_str("auto");
    add_choice<SignChoice>(
        verb, "--sign", sign,
        {{"auto", SignChoice::automatic}, {"solid", SignChoice::solid}, {"sheet", SignChoice::sheet}},
        "Sign of the distances. solid: negative inside, for closed meshes; sheet: both sides of the faces count as "
        "outside; auto: chosen to suit the mesh")
        ->type_name("SIGN")
        ->default_str("auto");
}

void add_point_size(CLI::App& verb, std::optional<Length>& size) {
    constexpr const char* forms = "auto, 0.2 (scene units) or 0.1% (of the diagonal)";
    verb.add_option_function<std::string>(
            "--point-size",
            [&size](const std::string& text) {
                if (text != "auto")
                    size = length_without_vx(text, forms);
            },
            "Distance between neighbouring points, for inputs without faces. Holes up to twice this size are closed")
        ->check(parsable([](const std::string& text) {
            if (text != "auto")
                length_without_vx(text, forms);
        }))
        ->type_name("LEN")
        ->default_str("auto");
}

void add_grid_names(CLI::App& verb, std::vector<std::string>& names) {
    verb.add_option("--grid-name", names,
                    "Use the level set of this name from the .vdb; repeat the option for the union of several. "
                    "Default: all level sets")
        ->allow_extra_args(false)
        ->option_text("NAME");
}

CLI::Option* add_triple(CLI::App& verb, const std::string& name, std::optional<Vec3d>& value, Triple kind,
                        const std::string& description) {
    return verb
        .add_option_function<std::string>(
            name, [&value, kind](const std::string& text) { value = parse_triple(text, kind); }, description)
        ->check(parsable([kind](const std::string& text) { return parse_triple(text, kind); }))
        ->type_name("X,Y,Z");
}

void add_method_options(CLI::App& verb, MethodRequest& request, const std::string& description) {
    CLI::Option* method = verb.add_option("--method", request.method, description + method_names())->type_name("NAME");
    const auto set = [&request](const char* name) {
        return [&request, name](const int& value) { request.parameters.emplace_back(name, value); };
    };
    verb.add_option_function<int>("--samples", set("samples"), "Probes per point, for methods that use probes")
        ->needs(method)
        ->type_name("N");
    verb.add_option_function<int>("--rays", set("rays"), "Rays per point, for methods that trace rays")
        ->needs(method)
        ->type_name("N");
    verb.add_option("--seed", request.seed, "Random seed for the ray directions")->type_name("N");
    verb.add_option_function<std::vector<std::string>>(
            "--set",
            [&request](const std::vector<std::string>& settings) {
                for (const std::string& setting : settings)
                    request.parameters.push_back(parse_setting(setting));
            },
            "Set a parameter of the method; `alcove methods` lists all parameters")
        ->check(parsable(parse_setting))
        ->needs(method)
        ->type_name("NAME=VALUE");
}

std::string method_names() {
    std::string names;
    for (const Method& method : catalog())
        if (method.gives.has(Channel::ao))
            names += (names.empty() ? "" : ", ") + std::string(method.name);
    return names;
}

std::string extension(const std::string& file) {
    std::string text = std::filesystem::path(file).extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

void check_grid_output(const std::string& file) {
    if (extension(file) != ".vdb")
        throw UsageError(file + ": grids are written as .vdb: use this extension");
    const AtomicFile probe(file);
}

void say(std::string_view line) {
    fmt::print("{}\n", in_one_line(line));
}

void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options) {
    if (options.quiet)
        return;
    for (const std::string& warning : warnings)
        std::fputs(fmt::format("alcove: warning: {}\n", in_one_line(warning)).c_str(), stderr);
}

void print_json(const nlohmann::ordered_json& object, bool in_one_line) {
    constexpr auto replace = nlohmann::ordered_json::error_handler_t::replace;
    fmt::print("{}\n", with_escaped_controls(object.dump(in_one_line ? -1 : 2, ' ', false, replace)));
}

std::string_view name_of(Sign sign) {
    return sign == Sign::solid ? "solid" : "sheet";
}

}
