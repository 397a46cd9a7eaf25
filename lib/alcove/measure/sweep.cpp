#include "alcove/measure/sweep.h"

#include "alcove/base/detail/file_kind.h"
#include "alcove/grid/voxelize.h"
#include "alcove/measure/detail/results_file.h"
#include "alcove/mesh/detail/join.h"
#include "alcove/mesh/files.h"
#include "alcove/vdb/vdb_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace alcove {
namespace {

/// A requested measurement.
struct Job {
    const std::string* mesh;
    const WrittenLength* radius;
    const WrittenLength* voxel; ///< null for methods without a grid
    MethodChoice choice;
    MeasurementKey key;
};

MeasurementKey key_of(const Job& job, const std::optional<Length>& weld) {
    std::error_code missing;
    const std::uintmax_t bytes = std::filesystem::file_size(*job.mesh, missing);
    MeasurementKey key{{"mesh", *job.mesh},
                       {"bytes", missing ? 0 : bytes},
                       {"method", job.choice.method->name},
                       {"samples", job.choice.samples},
                       {"radius", job.radius->text},
                       {"voxel", job.voxel ? MeasurementKey(job.voxel->text) : MeasurementKey()},
                       {"version", ALCOVE_VERSION}};
    if (weld)
        key["weld"] = weld->unit == Length::Unit::diagonal ? fmt::format("{}%", 100.0 * weld->value)
                                                           : fmt::format("{}", weld->value);
    return key;
}

/// All jobs without duplicates. Jobs with the same mesh, radius and grid are adjacent.
std::vector<Job> jobs_of(const SweepOptions& options) {
    std::vector<const WrittenLength*> grids{nullptr};
    for (const WrittenLength& voxel : options.voxels)
        grids.push_back(&voxel);
    std::vector<Job> jobs;
    const auto add = [&](Job job) {
        job.key = key_of(job, options.weld);
        if (std::none_of(jobs.begin(), jobs.end(), [&](const Job& known) { return known.key == job.key; }))
            jobs.push_back(std::move(job));
    };
    for (const std::string& mesh : options.meshes)
        for (const WrittenLength& radius : options.radii)
            for (const WrittenLength* voxel : grids)
                for (const MethodChoice& choice : options.methods)
                    if (choice.method->needs_grid == (voxel != nullptr))
                        add({&mesh, &radius, voxel, choice, {}});
    return jobs;
}

Mesh surface_of(const std::string& file, const std::optional<Length>& weld) {
    if (lower_extension(file) == ".vdb")
        return mesh_zero_surface(read_grids(file));
    Mesh mesh = read_mesh(file);
    return weld ? join_vertices(mesh, *weld).mesh : mesh;
}

/// Measures jobs in turn. Keeps data that consecutive jobs share, and reports progress over all jobs.
class JobRunner {
  public:
    JobRunner(const std::vector<Job>& jobs, const SweepOptions& options) : options_(options) {
        const Job* last = nullptr;
        for (const Job& job : jobs) {
            all_work_ += work_of(job.choice) + (same_truth(last, job) ? 0.0 : truth_work) +
                         (same_grid(last, job) ? 0.0 : grid_work);
            last = &job;
        }
    }

    /// Call with the jobs in the order given to the constructor.
    /// \throw as read_mesh(), build_grid() and alcove::measure().
    Measurement measure(const Job& job) {
        if (!last_ || last_->mesh != job.mesh) {
            mesh_.reset();
            mesh_.emplace(*job.mesh, surface_of(*job.mesh, options_.weld));
        }
        const double diagonal = mesh_->frame.diagonal;
        const float radius = job.radius->length.to_unit(diagonal);
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
        return alcove::measure(*mesh_, truth_, grid_ ? &*grid_ : nullptr, job.choice, options_.pictures,
                               next(work_of(job.choice)));
    }

  private:
    // In units of the work for one ray per vertex.
    static constexpr double truth_work = TruthOptions{}.rays, grid_work = 100.0;
    static double work_of(const MethodChoice& choice) { return 5.0 + choice.samples; }

    static bool same_truth(const Job* a, const Job& b) { return a && a->mesh == b.mesh && a->radius == b.radius; }
    static bool same_grid(const Job* a, const Job& b) { return !b.voxel || (same_truth(a, b) && a->voxel == b.voxel); }
    Progress next(double work) {
        done_work_ += step_;
        step_ = work;
        return [this](double done) {
            if (options_.progress)
                options_.progress((done_work_ + done * step_) / all_work_);
        };
    }

    const SweepOptions& options_;
    double all_work_ = 0.0, done_work_ = 0.0, step_ = 0.0;
    const Job* last_ = nullptr;
    std::optional<MeasuredMesh> mesh_;
    Truth truth_;
    std::optional<MeasuredGrid> grid_;
};

/// Measures the jobs whose results are not in the file. If a job fails, skips the other jobs of its mesh.
void measure_missing(const std::vector<Job>& jobs, const SweepOptions& options, ResultsFile& results, Sweep& to) {
    std::vector<Job> missing;
    std::copy_if(jobs.begin(), jobs.end(), std::back_inserter(missing),
                 [&](const Job& job) { return results.find(job.key) == nullptr; });
    JobRunner runner(missing, options);
    const std::string* failed = nullptr;
    for (const Job& job : missing) {
        if (job.mesh == failed)
            continue;
        const auto fail = [&](const std::exception& error) {
            const std::string what = error.what();
            to.failures.push_back(what.starts_with(*job.mesh) ? what : *job.mesh + ": " + what);
            to.bad_input |= dynamic_cast<const MemoryError*>(&error) == nullptr;
            failed = job.mesh;
        };
        try {
            results.add(job.key, runner.measure(job));
        } catch (const InputError& error) {
            fail(error);
        } catch (const LimitError& error) {
            fail(error);
        } catch (const MemoryError& error) {
            fail(error);
        }
    }
}

}

Sweep sweep(const SweepOptions& options) {
    const std::vector<Job> jobs = jobs_of(options);
    ResultsFile results(options.results);
    Sweep done;
    measure_missing(jobs, options, results, done);
    for (const Job& job : jobs)
        if (const Measurement* measurement = results.find(job.key))
            done.measurements.push_back(*measurement);
    return done;
}

}
