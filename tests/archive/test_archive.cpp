// Bakes every mesh of the archive, compares the output with the input and prints a line for each.
#include "off_oracle.h"
#include "scratch_folder.h"

#include "alcove/bake/bake.h"
#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/files.h"
#include "alcove/mesh/formats/ply/ply_document.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/reference/classic.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <set>
#include <sstream>

namespace alcove::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> archive() {
    static const std::set<std::string> formats{".off", ".ply", ".obj", ".stl"};
    std::vector<std::string> files;
    std::error_code missing;
    for (const auto& entry : fs::recursive_directory_iterator(ALCOVE_ARCHIVE, missing))
        if (formats.contains(entry.path().extension()))
            files.push_back(fs::relative(entry.path(), ALCOVE_ARCHIVE).string());
    std::sort(files.begin(), files.end());
    return files;
}

class Archive : public testing::TestWithParam<std::string> {
  protected:
    const ScratchFolder folder_;
    const fs::path baked_ = folder_ / "baked.ply";
};

/// Whether the file declares no faces, only points.
bool declares_no_faces(const fs::path& file) {
    if (file.extension() == ".off")
        return read_plain_off(file).value().faces.empty();
    std::ifstream input(file, std::ios::binary);
    std::string word, line;
    if (!std::getline(input, line) || !line.starts_with("ply"))
        return false;
    while (std::getline(input, line) && !line.starts_with("end_header")) {
        std::istringstream words(line);
        std::size_t count = 0;
        if (words >> word && word == "element" && words >> word >> count && word == "face" && count > 0)
            return false;
    }
    return true;
}

std::vector<float> column(const Mesh& mesh, const char* name) {
    const auto& document = dynamic_cast<const PlyDocument&>(*mesh.source);
    const PlyElement& vertices = *document.find("vertex");
    std::size_t offset = 0, row = 0;
    for (const PlyProperty& property : vertices.properties) {
        if (property.name == name)
            offset = row;
        row += size_of(property.type);
    }
    std::vector<float> values;
    for (std::size_t v = 0; v < vertices.count; ++v)
        values.push_back(static_cast<float>(number_at(vertices.rows.data() + v * row + offset, PlyType::float32)));
    return values;
}

void expect_same(const PlainMesh& wanted, const Mesh& mesh, double tolerance) {
    ASSERT_EQ(mesh.vertex_count(), wanted.positions.size());
    ASSERT_EQ(mesh.face_count(), wanted.faces.size());
    for (std::size_t v = 0; v < wanted.positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(mesh.positions[v][axis], wanted.positions[v][static_cast<std::size_t>(axis)], tolerance)
                << "vertex " << v;
    for (std::size_t f = 0; f < wanted.faces.size(); ++f)
        ASSERT_TRUE(
            std::equal(wanted.faces[f].begin(), wanted.faces[f].end(), mesh.face(f).begin(), mesh.face(f).end()))
            << "face " << f;
}

PlainMesh plain(const Mesh& mesh) {
    PlainMesh result;
    for (const Vec3d& p : mesh.positions)
        result.positions.push_back({p.x, p.y, p.z});
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        result.faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
    return result;
}

double peak_megabytes() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_maxrss) / 1024.0;
}

TEST_P(Archive, ComesBackWithOcclusionAndNothingElseChanged) {
    const fs::path file = fs::path(ALCOVE_ARCHIVE) / GetParam();
    const auto start = std::chrono::steady_clock::now();
    Mesh mesh;
    std::string refusal;
    try {
        mesh = read_mesh(file);
    } catch (const InputError& error) {
        refusal = error.what();
    }
    if (!refusal.empty())
        fmt::print("| {} | refused | {} |\n", GetParam(), refusal.substr(refusal.rfind('/') + 1));
    ASSERT_EQ(!refusal.empty(), declares_no_faces(file) && file.extension() == ".off") << refusal;
    if (!refusal.empty())
        return;
    if (declares_no_faces(file)) { // points, which come back with the ao of their surface
        const Baked baked = bake(mesh);
        ASSERT_TRUE(
            std::all_of(baked.ao().begin(), baked.ao().end(), [](float ao) { return ao >= 0.0f && ao <= 1.0f; }));
        const PlainMesh points = plain(mesh);
        mesh.set_attribute({"ao", 1, baked.ao()});
        write_mesh(mesh, baked_);
        const Mesh back = read_mesh(baked_);
        expect_same(points, back, 0.0);
        ASSERT_EQ(column(back, "ao"), baked.ao());
        return;
    }
    if (file.extension() == ".off") {
        const std::optional<PlainMesh> oracle = read_plain_off(file);
        ASSERT_TRUE(oracle.has_value());
        expect_same(*oracle, mesh, 0.0);
    }

    const PlainMesh input = plain(mesh);
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    VoxelizeOptions options;
    options.grid.voxel = 1.0f / 128;
    const GridStack stack = voxelize(mesh, triangles, options);
    const std::vector<Surfel> surfels = make_surfels(mesh, triangles, frame);
    const std::vector<float> ao = evaluate_ao(surfels, LevelStack(stack), Classic{});
    mesh.set_attribute({"ao", 1, ao});
    const std::vector<std::string> lost = write_mesh(mesh, baked_);

    const Mesh back = read_mesh(baked_);
    expect_same(input, back, 1e-6 * frame.diagonal);
    ASSERT_EQ(column(back, "ao"), ao);
    float least = 1.0f, most = 0.0f;
    double sum = 0.0;
    for (std::size_t v = 0; v < ao.size(); ++v) {
        ASSERT_TRUE(ao[v] >= 0.0f && ao[v] <= 1.0f) << "vertex " << v << ": " << ao[v];
        if (!surfels[v].has_normal()) {
            ASSERT_EQ(ao[v], 1.0f) << "vertex " << v;
        }
        least = std::min(least, ao[v]);
        most = std::max(most, ao[v]);
        sum += ao[v];
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("| {} | {:.2f} s | {:.0f} MB | {} vertices | {} faces | {} | ao {:.2f} to {:.2f}, mean {:.2f} "
               "|{}{} |\n",
               GetParam(), seconds.count(), peak_megabytes(), ao.size(), back.face_count(),
               stack.sign == Sign::solid ? "solid" : "sheet", least, most, sum / static_cast<double>(ao.size()),
               mesh.warnings.empty() ? "" : " " + mesh.warnings.front(), lost.empty() ? "" : " " + lost.front());
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Files, Archive, testing::ValuesIn(archive()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Archive);

}
}
