#include "common.h"

#include "ending.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

namespace alcove::cli {

void add_run_options(CLI::App& verb, CommonOptions& options) {
    static const std::map<std::string_view, ProgressMode> modes{{"auto", ProgressMode::automatic},
                                                                {"bar", ProgressMode::bar},
                                                                {"plain", ProgressMode::plain},
                                                                {"none", ProgressMode::none}};
    verb.add_option("--threads", options.threads, "Threads to use; 0: one per core")->capture_default_str();
    verb.add_option_function<std::string>(
            "--progress",
            [&options](const std::string& mode) {
                if (!modes.contains(mode))
                    throw UsageError(
                        fmt::format("--progress takes auto, bar, plain or none, not '{}'", mode));
                options.progress = modes.at(mode);
            },
            "Progress on stderr: auto (a bar on a terminal), bar, plain, none")
        ->option_text("MODE");
    verb.add_option_function<double>(
            "--time-limit",
            [](const double& seconds) {
                if (!(seconds > 0.0 && seconds <= 1e9))
                    throw UsageError(fmt::format(
                        "--time-limit takes seconds, above 0 and up to 1e9, not '{:g}'", seconds));
                limit_time(seconds);
            },
            "End with exit code 1 after that many seconds, and leave files as they were; a bake or picture "
            "that clearly takes longer is not begun, and told what fits")
        ->option_text("SECONDS");
    verb.add_flag("--quiet", options.quiet, "Neither progress nor warnings");
    verb.set_version_flag("--version", "alcove " ALCOVE_VERSION);
}

void add_common_options(CLI::App& verb, CommonOptions& options) {
    verb.add_flag("--json", options.json, "Print the result as one JSON object on stdout");
    add_run_options(verb, options);
}

void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options) {
    if (options.quiet)
        return;
    for (const std::string& warning : warnings)
        std::fputs(fmt::format("alcove: warning: {}\n", warning).c_str(), stderr);
}

std::string extension(const std::string& file) {
    std::string text = std::filesystem::path(file).extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

void print_json(const nlohmann::ordered_json& object) {
    fmt::print("{}\n", object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

double Stopwatch::lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
}

}
