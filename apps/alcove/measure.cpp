#include "options.h"
#include "weld.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/measure/report.h"
#include "alcove/measure/sweep.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <memory>
#include <sstream>

namespace alcove::cli {
namespace {

struct MeasureOptions {
    CommonOptions common;
    std::vector<std::string> inputs;
    std::string radius = "10%", voxel = "auto", methods, report, json;
    std::optional<Length> weld;
};

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text + ',');
    for (std::string word; std::getline(stream, word, ',');)
        words.push_back(word);
    return words;
}

Length parse_length(const char* option, const std::string& word, std::string_view forms) {
    try {
        return length_without_vx(word, forms);
    } catch (const InputError& error) {
        throw UsageError(fmt::format("{} {}", option, error.what()));
    }
}

std::vector<WrittenLength> parse_radii(const std::string& text) {
    std::vector<WrittenLength> radii;
    for (const std::string& word : split(text))
        radii.push_back({word, parse_length("--radius", word, "0.2 (scene units), 10% (of the diagonal) or inf")});
    return radii;
}

/// Parses voxels, separated by commas. `auto` has the value 0.
std::vector<WrittenLength> parse_voxels(const std::string& text) {
    constexpr const char* voxel_forms = "0.2 (scene units), 0.5% (of the diagonal) or auto";
    std::vector<WrittenLength> voxels;
    for (const std::string& word : split(text)) {
        voxels.push_back({word, word == "auto" ? Length{} : parse_length("--voxel", word, voxel_forms)});
        if (std::isinf(voxels.back().length.value))
            throw UsageError(fmt::format("--voxel takes {}, not '{}'", voxel_forms, word));
    }
    return voxels;
}

MethodChoice parse_choice(const std::string& word) {
    const std::size_t colon = word.find(':');
    const Method& method = as_usage([&]() -> const Method& { return find_method(word.substr(0, colon)); });
    std::optional<int> samples;
    if (colon != std::string::npos) {
        int number = 0;
        const char* const end = word.data() + word.size();
        const auto [last, error] = std::from_chars(word.data() + colon + 1, end, number);
        if (error != std::errc() || last != end)
            throw UsageError(fmt::format("--methods takes NAME or NAME:N with a whole number, not '{}'", word));
        samples = number;
    }
    try {
        return choose(method, samples);
    } catch (const InputError& wrong) {
        throw UsageError(fmt::format("--methods {}: {}", word, wrong.what()));
    }
}

std::vector<MethodChoice> parse_choices(const std::string& text) {
    if (text.empty())
        return standard_choices();
    std::vector<MethodChoice> choices;
    for (const std::string& word : split(text))
        choices.push_back(parse_choice(word));
    return choices;
}

void print(const std::vector<Measurement>& measurements) {
    std::string mesh;
    for (const Measurement& m : measurements) {
        if (m.mesh != mesh)
            fmt::print("{}{}: {} vertices, compared at {}; radius and voxel are fractions of the diagonal\n"
                       "{:>22} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10}\n",
                       mesh.empty() ? "" : "\n", in_one_line(m.mesh), grouped(m.vertices), grouped(m.error.count),
                       "method", "radius", "voxel", "rmse", "bias", "ao sd", "CPU s");
        mesh = m.mesh;
        fmt::print("{:>22} {:>8.4g} {:>8} {:>8.4f} {:>+8.4f} {:>8.4f} {:>10.4g}\n", m.label(), m.radius,
                   m.voxel > 0.0 ? fmt::format("{:.4g}", m.voxel) : "-", m.error.rmse, m.error.bias, m.error.deviation,
                   m.seconds());
    }
}

void run(const MeasureOptions& options) {
    const ThreadLimit limit(options.common.threads);
    ProgressMeter meter(options.common.progress_mode(), "measuring");
    const SweepOptions request{.meshes = options.inputs,
                               .radii = parse_radii(options.radius),
                               .voxels = parse_voxels(options.voxel),
                               .methods = parse_choices(options.methods),
                               .weld = options.weld,
                               .results = options.json,
                               .pictures = options.report.empty() ? Pictures::none : Pictures::painted,
                               .progress = std::ref(meter)};
    if (!options.report.empty()) {
        if (extension(options.report) != ".html" && extension(options.report) != ".htm")
            throw UsageError(options.report + ": reports are written as .html: use this extension");
        const AtomicFile probe(options.report);
    }
    const Sweep done = sweep(request);
    if (!options.report.empty()) {
        AtomicFile page(options.report);
        page.write(report(done.measurements));
        page.commit();
    }
    if (!options.common.quiet)
        print(done.measurements);
    if (!done.failures.empty()) {
        print_warnings({done.failures.begin() + 1, done.failures.end()}, options.common);
        if (done.bad_input)
            throw InputError(done.failures.front());
        throw std::runtime_error(done.failures.front());
    }
}

}

void add_measure(CLI::App& program) {
    auto* verb = program.add_subcommand("measure", "Measure the error, time and memory of methods on meshes");
    auto options = std::make_shared<MeasureOptions>();
    verb->add_option(
            "input", options->inputs,
            "Meshes to run the methods on (ply, obj, off, stl, glb, gltf), or level sets (vdb), whose zero isosurface "
            "is meshed first")
        ->required();
    verb->add_option("--radius", options->radius,
                     "Maximum distances of occluders, separated by commas: 0.2 (scene units), 10%, or inf")
        ->type_name("LEN,...")
        ->capture_default_str();
    verb->add_option("--voxel", options->voxel, "Edges of the finest voxel, separated by commas: 0.2, 0.5%, or auto")
        ->type_name("LEN,...")
        ->capture_default_str();
    add_weld_option(*verb, options->weld);
    verb->add_option("--methods", options->methods,
                     "NAME, or NAME:N with N samples or rays. Default: all methods, some with several values of N")
        ->type_name("NAME[:N],...");
    verb->add_option("--report", options->report, "Write a page with charts and images (html)")->type_name("FILE");
    verb->add_option(
            "--json", options->json,
            "Write each result to this file as soon as it is measured; results already in it are not measured again")
        ->type_name("FILE");
    add_run_options(*verb, options->common);
    verb->footer(
        "The reference is 1,024 exact rays per vertex, at up to 20,000 vertices; each method bakes all vertices.\n"
        "Times are the CPU seconds that the process uses for one bake. A grid is built once per radius and voxel\n"
        "size, and its build time is included in the time of each method that uses it.\n\n"
        "Examples:\n"
        "  alcove measure scan.ply --report scan.html\n"
        "  alcove measure scan.ply part.stl --methods guided:3,exact:16,classic --json results.json\n"
        "  alcove measure scan.ply --radius 5%,10%,20% --voxel 0.2%,0.4%,0.8% --methods traced:64,classic "
        "--report voxels.html\n");
    verb->callback([options] { run(*options); });
}

}
