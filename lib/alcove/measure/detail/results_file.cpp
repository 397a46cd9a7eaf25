#include "alcove/measure/detail/results_file.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/types.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace alcove {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Measurement& m) {
    Json json{{"mesh", m.mesh},
              {"vertices", m.vertices},
              {"triangles", m.triangles},
              {"method", m.method},
              {"samples", m.samples},
              {"radius", std::isinf(m.radius) ? Json("inf") : Json(m.radius)},
              {"voxel", m.voxel},
              {"asked_voxel", m.asked_voxel},
              {"levels", m.levels},
              {"active_voxels", m.active_voxels},
              {"compared", m.error.count},
              {"rmse", m.error.rmse},
              {"bias", m.error.bias},
              {"percentile_99", m.error.percentile_99},
              {"max", m.error.max},
              {"truth_deviation", m.error.deviation},
              {"cpu_seconds",
               {{"grid", m.grid_seconds},
                {"tree", m.tree_seconds},
                {"occlusion", m.occlusion_seconds},
                {"total", m.seconds()}}},
              {"map_calls", m.map_calls},
              {"rays", m.rays},
              {"grid_bytes", m.grid_bytes},
              {"peak_rss_bytes", m.peak_rss_bytes}};
    if (!m.picture.empty())
        json["picture"] = m.picture;
    return json;
}

Measurement measurement_of(const Json& json) {
    Measurement m;
    json.at("mesh").get_to(m.mesh);
    json.at("vertices").get_to(m.vertices);
    json.at("triangles").get_to(m.triangles);
    json.at("method").get_to(m.method);
    json.at("samples").get_to(m.samples);
    const Json& radius = json.at("radius");
    m.radius = radius.is_string() ? std::numeric_limits<float>::infinity() : radius.get<float>();
    json.at("voxel").get_to(m.voxel);
    json.at("asked_voxel").get_to(m.asked_voxel);
    json.at("levels").get_to(m.levels);
    json.at("active_voxels").get_to(m.active_voxels);
    json.at("compared").get_to(m.error.count);
    json.at("rmse").get_to(m.error.rmse);
    json.at("bias").get_to(m.error.bias);
    json.at("percentile_99").get_to(m.error.percentile_99);
    json.at("max").get_to(m.error.max);
    json.at("truth_deviation").get_to(m.error.deviation);
    const Json& seconds = json.at("cpu_seconds");
    seconds.at("grid").get_to(m.grid_seconds);
    seconds.at("tree").get_to(m.tree_seconds);
    seconds.at("occlusion").get_to(m.occlusion_seconds);
    json.at("map_calls").get_to(m.map_calls);
    json.at("rays").get_to(m.rays);
    json.at("grid_bytes").get_to(m.grid_bytes);
    json.at("peak_rss_bytes").get_to(m.peak_rss_bytes);
    m.picture = json.value("picture", "");
    return m;
}

}

ResultsFile::ResultsFile(std::string file) : file_(std::move(file)) {
    if (file_.empty())
        return;
    const AtomicFile probe(file_);
    if (!std::filesystem::exists(file_))
        return;
    try {
        std::ifstream input(file_);
        const Json whole = Json::parse(input);
        for (const Json& result : whole.at("measurements"))
            results_.push_back({result.at("asked"), measurement_of(result)});
    } catch (const Json::exception&) {
        throw InputError(file_ + ": exists but contains no measurements: name another file");
    }
}

const Measurement* ResultsFile::find(const MeasurementKey& key) const {
    const auto found =
        std::find_if(results_.begin(), results_.end(), [&](const Result& result) { return result.key == key; });
    return found == results_.end() ? nullptr : &found->measurement;
}

void ResultsFile::add(const MeasurementKey& key, Measurement measurement) {
    results_.push_back({key, std::move(measurement)});
    if (!file_.empty())
        write();
}

void ResultsFile::write() const {
    Json all = Json::array();
    for (const Result& result : results_) {
        Json json = json_of(result.measurement);
        json["asked"] = result.key;
        all.push_back(std::move(json));
    }
    AtomicFile target(file_);
    target.write(Json{{"measurements", std::move(all)}}.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    target.commit();
}

}
