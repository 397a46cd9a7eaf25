/// Fits the coefficients of the calibrated estimator to exact rays on half of the real meshes, and measures its error
/// on both halves. Writes the table that the library is compiled with, and docs/calibrated.md.
///
///     cmake --build build --target alcove_fit && build/fit/alcove_fit
///
/// Run this in a checkout whose meshes tools/setup.sh has unpacked; it takes a few minutes. It reproduces the existing
/// table byte for byte with any number of threads, as `git diff` shows. Another compiler may round differently, and
/// arrive at other coefficients with the same error.
#include "meshes.h"
#include "write.h"

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <fstream>

namespace alcove::fit {
namespace {

constexpr std::size_t max_surfels = 1000; // per mesh
constexpr int fitted_rays = 256, measured_rays = 1024;

struct MeshExamples {
    MeshFile file;
    std::array<Examples, radii.size()> at;
};

/// Weights the examples so that every mesh counts the same at every radius.
TrainingSet training_set(const std::vector<MeshExamples>& meshes, Eigen::MatrixXf Examples::*inputs) {
    Eigen::Index count = 0;
    float sets = 0.0f;
    for (const MeshExamples& mesh : meshes)
        if (mesh.file.fitted)
            for (const Examples& examples : mesh.at)
                count += examples.truth.size(), ++sets;
    TrainingSet set;
    set.inputs.resize((meshes.front().at.front().*inputs).rows(), count);
    set.truth.resize(count);
    set.weights.resize(count);
    Eigen::Index at = 0;
    for (const MeshExamples& mesh : meshes)
        if (mesh.file.fitted)
            for (const Examples& examples : mesh.at) {
                const Eigen::Index size = examples.truth.size();
                set.inputs.middleCols(at, size) = examples.*inputs;
                set.truth.segment(at, size) = examples.truth;
                set.weights.segment(at, size).setConstant(static_cast<float>(count) /
                                                          (sets * static_cast<float>(size)));
                at += size;
            }
    return set;
}

double rmse(const Network& network, const Eigen::MatrixXf& inputs, const Eigen::VectorXf& truth) {
    const Eigen::RowVectorXf ao = network(inputs).cwiseMax(0.0f).cwiseMin(1.0f);
    return std::sqrt((ao.transpose() - truth).cast<double>().squaredNorm() / static_cast<double>(truth.size()));
}

void write(const std::string& path, const std::string& text) {
    std::ofstream file(std::string(ALCOVE_TREE) + "/" + path);
    file << text;
    if (!file.flush())
        throw std::runtime_error("cannot write " + path);
}

void run() {
    std::vector<MeshExamples> meshes;
    for (const MeshFile& file : split_meshes(std::string(ALCOVE_TREE) + "/build/meshes/meshes")) {
        fmt::print("{} ({})\n", file.path.filename().string(), file.fitted ? "fitted" : "measured");
        std::fflush(stdout);
        meshes.push_back({file, file.fitted ? make_examples(file.path, max_surfels, fitted_rays)
                                            : make_examples(file.path, max_surfels, measured_rays)});
    }
    fmt::print("training\n");
    std::fflush(stdout);
    Fit fit{train(training_set(meshes, &Examples::ten)), train(training_set(meshes, &Examples::twenty_four)), {}};
    for (const MeshExamples& mesh : meshes) {
        MeshErrors errors{mesh.file.path.filename().string(), mesh.file.fitted, {}};
        for (std::size_t r = 0; r < radii.size(); ++r) {
            const Examples& examples = mesh.at[r];
            const Eigen::ArrayXd truth = examples.truth.cast<double>();
            errors.at[r] = {std::sqrt((truth - truth.mean()).square().mean()),
                            rmse(fit.ten, examples.ten, examples.truth),
                            rmse(fit.twenty_four, examples.twenty_four, examples.truth)};
        }
        fit.errors.push_back(std::move(errors));
    }
    write("lib/alcove/occlusion/methods/calibrated_table.h", table_of(fit));
    write("docs/calibrated.md", report_of(fit));
}

}
}

int main() {
    try {
        alcove::fit::run();
        return EXIT_SUCCESS;
    } catch (const std::exception& failure) {
        fmt::print(stderr, "alcove_fit: {}\n", failure.what());
        return EXIT_FAILURE;
    }
}
