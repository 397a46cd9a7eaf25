#include "inputs.h"
#include "measured_results.h"
#include "options.h"
#include "weld.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/measure/report.h"
#include "alcove/mesh/files.h"
#include "alcove/vdb/vdb_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
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

/// A length and its text on the command line.
struct WrittenLength {
    std::string text;
    Length length;
};

/// A requested measurement.
struct Job {
    const std::string* mesh;
    const WrittenLength* radius;
    const WrittenLength* voxel; ///< null for methods without a grid
    MethodChoice choice;
    Asked asked;
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

/// `auto` has the value 0.
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

Asked asked_of(const std::string& mesh, const WrittenLength& radius, const WrittenLength* voxel,
               const MethodChoice& choice) {
    std::error_code missing;
    const std::uintmax_t bytes = std::filesystem::file_size(mesh, missing);
    return {{"mesh", mesh},
            {"bytes", missing ? 0 : bytes},
            {"method", choice.method->name},
            {"samples", choice.samples},
            {"radius", radius.text},
            {"voxel", voxel ? Asked(voxel->text) : Asked()},
            {"version", ALCOVE_VERSION}};
}

/// All jobs without duplicates. Jobs with the same mesh, radius and grid are adjacent.
std::vector<Job> plan_jobs(const std::vector<std::string>& meshes, const std::vector<WrittenLength>& radii,
                           const std::vector<WrittenLength>& voxels, const std::vector<MethodChoice>& choices) {
    std::vector<const WrittenLength*> grids{nullptr};
    for (const WrittenLength& voxel : voxels)
        grids.push_back(&voxel);
    std::vector<Job> jobs;
    for (const std::string& mesh : meshes)
        for (const WrittenLength& radius : radii)
            for (const WrittenLength* voxel : grids)
                for (const MethodChoice& choice : choices) {
                    if (choice.method->needs_grid != (voxel != nullptr))
                        continue;
                    Job job{&mesh, &radius, voxel, choice, asked_of(mesh, radius, voxel, choice)};
                    if (std::none_of(jobs.begin(), jobs.end(),
                                     [&](const Job& known) { return known.asked == job.asked; }))
                        jobs.push_back(std::move(job));
                }
    return jobs;
}

/// Caches the inputs that consecutive jobs share, and shows the progress of all jobs.
class MeasurementInputs {
  public:
    MeasurementInputs(const std::vector<Job>& jobs, const std::optional<Length>& weld, Pictures pictures,
                      ProgressMode mode)
        : weld_(weld), pictures_(pictures), meter_(mode, "measuring") {
        const Job* last = nullptr;
        for (const Job& job : jobs) {
            all_work_ += work_of(job.choice) + (same_truth(last, job) ? 0.0 : truth_work) +
                         (same_grid(last, job) ? 0.0 : grid_work);
            last = &job;
        }
    }

    /// Call with the jobs in the order given to the constructor. Reuses the inputs shared with the previous job.
    /// \throw as read_mesh(), build_grid() and alcove::measure().
    Measurement measure(const Job& job) {
        if (!last_ || last_->mesh != job.mesh) {
            mesh_.reset();
            mesh_.emplace(*job.mesh, is_grid(*job.mesh) ? surface_of(read_grids(*job.mesh), *job.mesh)
                                                        : read_welded(*job.mesh, weld_));
        }
        const double diagonal = mesh_->frame.diagonal;
        const float radius = as_usage([&] { return job.radius->length.to_unit(diagonal); });
        if (!same_truth(last_, job)) {
            grid_.reset();
            truth_ = make_truth(*mesh_, radius, {.labels = labels_of_pilot}, next(truth_work));
        }
        if (!same_grid(last_, job)) {
            grid_.reset();
            const Length& voxel = job.voxel->length;
            grid_.emplace(
                build_grid(*mesh_, radius, voxel.value > 0.0 ? voxel.to_unit(diagonal) : 0.0f, next(grid_work)));
        }
        last_ = &job;
        return alcove::measure(*mesh_, truth_, grid_ ? &*grid_ : nullptr, job.choice, pictures_,
                               next(work_of(job.choice)));
    }

  private:
    // In rays per vertex, or work that takes about as long.
    static constexpr double truth_work = TruthOptions{}.rays, grid_work = 100.0;
    static double work_of(const MethodChoice& choice) { return 5.0 + choice.samples; }

    static bool same_truth(const Job* a, const Job& b) { return a && a->mesh == b.mesh && a->radius == b.radius; }
    static bool same_grid(const Job* a, const Job& b) { return !b.voxel || (same_truth(a, b) && a->voxel == b.voxel); }
    Progress next(double work) {
        done_work_ += step_;
        step_ = work;
        return [this](double done) { meter_((done_work_ + done * step_) / all_work_); };
    }

    std::optional<Length> weld_;
    Pictures pictures_;
    ProgressMeter meter_;
    double all_work_ = 0.0, done_work_ = 0.0, step_ = 0.0;
    const Job* last_ = nullptr;
    std::optional<MeasuredMesh> mesh_;
    Truth truth_;
    std::optional<MeasuredGrid> grid_;
};

/// The error messages of meshes that cannot be measured, and whether one of the meshes is to blame.
struct Failures {
    std::vector<std::string> messages;
    bool bad_input = false;
};

/// Measures the jobs that are not in the results. Skips meshes that cannot be measured.
Failures measure_missing(const std::vector<Job>& jobs, MeasuredResults& results, const MeasureOptions& options) {
    std::vector<Job> missing;
    std::copy_if(jobs.begin(), jobs.end(), std::back_inserter(missing),
                 [&](const Job& job) { return results.find(job.asked) == nullptr; });
    MeasurementInputs inputs(missing, options.weld, options.report.empty() ? Pictures::none : Pictures::painted,
                             options.common.progress_mode());
    Failures failures;
    const std::string* failed = nullptr;
    for (const Job& job : missing) {
        if (job.mesh == failed)
            continue;
        const auto fail = [&](const std::exception& error) {
            const std::string what = error.what();
            failures.messages.push_back(what.starts_with(*job.mesh) ? what : *job.mesh + ": " + what);
            failures.bad_input |= dynamic_cast<const MemoryError*>(&error) == nullptr;
            failed = job.mesh;
        };
        try {
            results.add(job.asked, inputs.measure(job));
        } catch (const InputError& error) {
            fail(error);
        } catch (const LimitError& error) {
            fail(error);
        } catch (const MemoryError& error) {
            fail(error);
        }
    }
    return failures;
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
    const std::vector<WrittenLength> radii = parse_radii(options.radius);
    const std::vector<WrittenLength> voxels = parse_voxels(options.voxel);
    std::vector<Job> jobs = plan_jobs(options.inputs, radii, voxels, parse_choices(options.methods));
    for (Job& job : jobs)
        if (options.weld)
            job.asked["weld"] = options.weld->unit == Length::Unit::diagonal
                                    ? fmt::format("{}%", 100.0 * options.weld->value)
                                    : fmt::format("{}", options.weld->value);
    if (!options.report.empty()) {
        if (extension(options.report) != ".html" && extension(options.report) != ".htm")
            throw UsageError(options.report + ": reports are written as .html: use this extension");
        const AtomicFile probe(options.report);
    }
    MeasuredResults results(options.json);
    const auto [failures, bad_input] = measure_missing(jobs, results, options);

    std::vector<Measurement> measurements;
    for (const Job& job : jobs)
        if (const Measurement* measurement = results.find(job.asked))
            measurements.push_back(*measurement);
    if (!options.report.empty()) {
        AtomicFile page(options.report);
        page.write(report(measurements));
        page.commit();
    }
    if (!options.common.quiet)
        print(measurements);
    if (!failures.empty()) {
        print_warnings({failures.begin() + 1, failures.end()}, options.common);
        if (bad_input)
            throw InputError(failures.front());
        throw std::runtime_error(failures.front());
    }
}

}

void add_measure(CLI::App& program) {
    auto* verb = program.add_subcommand("measure", "Measure the error, time and memory of estimators on meshes");
    auto options = std::make_shared<MeasureOptions>();
    verb->add_option("input", options->inputs,
                     "Meshes to measure on (ply, obj, off, stl, glb, gltf), or level sets (vdb), whose zero isosurface "
                     "is meshed first")
        ->required();
    verb->add_option("--radius", options->radius,
                     "Maximum distances of occluders, separated by commas: 0.2 (scene units), 10%, inf")
        ->type_name("LEN,...")
        ->capture_default_str();
    verb->add_option("--voxel", options->voxel, "Edges of the finest voxel, separated by commas: 0.2, 0.5%, auto")
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
        "size, and its time is added to each method that uses it.\n\n"
        "Examples:\n"
        "  alcove measure scan.ply --report scan.html\n"
        "  alcove measure scan.ply part.stl --methods guided:3,exact:16,classic --json results.json\n"
        "  alcove measure scan.ply --radius 5%,10%,20% --voxel 0.2%,0.4%,0.8% --methods traced:64,classic "
        "--report voxels.html\n");
    verb->callback([options] { run(*options); });
}

}
