/// Options that several verbs share, and the parsing of their values.
#pragma once

#include "progress.h"

#include "alcove/base/types.h"
#include "alcove/grid/voxelize.h"
#include "alcove/occlusion/catalog.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace alcove::cli {

/// The command line is invalid: exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Returns the result of `work`. Rethrows an InputError as UsageError, for work where the command line is at fault, not
/// a file.
template <class Work>
decltype(auto) as_usage(const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw UsageError(error.what());
    }
}

/// A validator that accepts the values for which `parse` does not throw an InputError.
template <class Parse>
CLI::Validator parsable(const Parse& parse) {
    return CLI::Validator(
        [parse](const std::string& text) {
            try {
                parse(text);
                return std::string();
            } catch (const InputError& error) {
                return std::string(error.what());
            }
        },
        "");
}

/// Adds an option that takes the words of `choices`, and sets `value` to the choice for the word.
template <class T>
CLI::Option* add_choice(CLI::App& verb, const std::string& name, T& value,
                        const std::vector<std::pair<std::string, T>>& choices, const std::string& description) {
    std::map<std::string, T> known(choices.begin(), choices.end());
    std::string words;
    for (std::size_t i = 0; i < choices.size(); ++i)
        words += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i].first;
    return verb
        .add_option_function<std::string>(
            name, [&value, known](const std::string& word) { value = known.at(word); }, description)
        ->check(CLI::Validator(
            [known, words](const std::string& word) {
                return known.contains(word) ? "" : "takes " + words + ", not '" + word + "'";
            },
            ""));
}

struct CommonOptions {
    unsigned threads = 0;
    bool json = false;
    bool quiet = false;
    ProgressMode progress = ProgressMode::automatic;

    ProgressMode progress_mode() const { return quiet ? ProgressMode::none : progress; }
};

/// "alcove 0.2.0 (1a2b3c4, AVX2)": the version, the commit if it was built from one, and the SIMD target.
std::string version_text();

/// Adds --threads, --progress, --time-limit, --max-memory, --max-read, --quiet and --version.
void add_run_options(CLI::App& verb, CommonOptions& options);

/// Adds the run options and --json.
void add_common_options(CLI::App& verb, CommonOptions& options);

/// Parses a length that is not in vx. \throw InputError "takes <forms>, not '<text>'" for any other text.
Length length_without_vx(const std::string& text, std::string_view forms);

/// Adds --radius.
void add_radius_option(CLI::App& verb, Length& radius, const std::string& description);

/// Adds --voxel (empty: auto) and --sign.
void add_grid_options(CLI::App& verb, std::optional<Length>& voxel, SignChoice& sign);

/// Adds --point-size (empty: auto).
void add_point_size(CLI::App& verb, std::optional<Length>& size);

/// Adds --grid-name.
void add_grid_names(CLI::App& verb, std::vector<std::string>& names);

/// Adds an option that takes three numbers, such as `1,2.5,-3`. A direction must not be 0,0,0.
enum class Triple { point, direction };
CLI::Option* add_triple(CLI::App& verb, const std::string& name, std::optional<Vec3d>& value, Triple kind,
                        const std::string& description);

/// A method and its parameters from --method, --samples, --rays, --seed and --set.
struct MethodRequest {
    std::string method; ///< empty: no --method
    std::vector<std::pair<std::string, double>> parameters{};
    std::optional<std::uint32_t> seed{};
};

void add_method_options(CLI::App& verb, MethodRequest& request, const std::string& description);

/// The names of the estimators, separated by commas.
std::string method_names();

/// The extension of a file name in lower case, with the dot.
std::string extension(const std::string& file);

/// Checks the name of a grid to write. \throw UsageError unless the name ends in .vdb; what AtomicFile throws if the
/// file cannot be written.
void check_grid_output(const std::string& file);

/// Prints a line to stdout. As in messages on stderr, control characters (in names) are printed as '?'.
void say(std::string_view line);

/// Prints one line per warning to stderr, unless quiet.
void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options);

/// Prints the object to stdout, indented or in one line. Escapes control characters.
void print_json(const nlohmann::ordered_json& object, bool in_one_line = false);

/// "solid" or "sheet".
std::string_view name_of(Sign sign);

// Each of these functions adds a verb to the program, with a callback that runs the verb.
void add_bake(CLI::App& program);
void add_render(CLI::App& program);
void add_voxelize(CLI::App& program);
void add_info(CLI::App& program);
void add_measure(CLI::App& program);
void add_methods(CLI::App& program);

}
