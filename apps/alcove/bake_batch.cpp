#include "bake_batch.h"

#include "alcove/base/detail/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace alcove::cli {
namespace {

namespace fs = std::filesystem;

/// Whether a mesh can be written to a file of this name.
bool is_mesh_output(const std::string& file) {
    const std::string end = extension(file);
    return end == ".ply" || end == ".obj" || end == ".glb" || end == ".gltf";
}

bool is_folder(const std::string& output) {
    const bool is_mesh = is_mesh_output(output);
    std::error_code missing;
    return output.ends_with('/') || (!is_mesh && fs::is_directory(output, missing));
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code missing;
    return a == b || fs::equivalent(a, b, missing);
}

std::string name_in_folder(const fs::path& input, bool with_folder) {
    const std::string kept = is_mesh_output(input.string()) ? input.extension().string() : ".ply";
    const std::string name = input.stem().string() + kept;
    const std::string folder = fs::absolute(input).parent_path().filename().string();
    return with_folder && !folder.empty() ? folder + "_" + name : name;
}

}

std::vector<BatchFile> batch_files(const std::vector<std::string>& inputs, const std::string& output) {
    if (inputs.size() == 1 && !is_folder(output))
        return {{inputs.front(), output}};
    if (!is_folder(output))
        throw UsageError(fmt::format("{} inputs need a folder as output: use -o {}/", inputs.size(),
                                     fs::path(output).stem().string()));
    std::map<std::string, int> uses;
    for (const std::string& input : inputs)
        ++uses[name_in_folder(input, false)];
    std::vector<BatchFile> files;
    std::map<std::string, std::string> input_of;
    for (const std::string& input : inputs) {
        const std::string name = name_in_folder(input, uses[name_in_folder(input, false)] > 1);
        const std::string file = (fs::path(output) / name).string();
        if (const auto [other, is_new] = input_of.emplace(file, input); !is_new)
            throw UsageError(same_file(other->second, input)
                                 ? fmt::format("{} is given twice", input)
                                 : fmt::format("{} and {} would both become {}: bake them in separate runs",
                                               other->second, input, file));
        files.push_back({input, file});
    }
    for (const BatchFile& file : files)
        for (const std::string& input : inputs)
            if (same_file(file.output, input))
                throw UsageError(
                    fmt::format("{} would replace the input {}: choose another folder", file.output, input));
    std::error_code failed;
    fs::create_directories(output, failed);
    if (failed)
        throw IoError(fmt::format("{}: cannot be created: {}", output, failed.message()));
    return files;
}

void run_batch(const std::vector<BatchFile>& files, const CommonOptions& common,
               const std::function<void(const BatchFile&, const BakeProgress&)>& work) {
    const bool single = files.size() == 1;
    ProgressMeter meter(common.progress_mode(), single ? "baking" : fmt::format("baking {} files", files.size()));
    std::size_t failures = 0;
    bool bad_input = false;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const BakeProgress progress = [&](std::string_view label, double done) {
            if (single)
                meter.show(label, done);
            else
                meter((static_cast<double>(i) + done) / static_cast<double>(files.size()));
        };
        try {
            work(files[i], progress);
        } catch (const std::exception& error) {
            if (single)
                throw;
            const std::string message = error.what();
            meter.clear();
            std::fputs(fmt::format(
                           "alcove: {}\n",
                           in_one_line(message.starts_with(files[i].input) ? message : files[i].input + ": " + message))
                           .c_str(),
                       stderr);
            ++failures;
            bad_input = bad_input || dynamic_cast<const InputError*>(&error) || dynamic_cast<const LimitError*>(&error);
        }
    }
    if (failures > 0)
        throw BatchError(fmt::format("{} of {} inputs failed; the others were baked", failures, files.size()),
                         bad_input);
}

}
