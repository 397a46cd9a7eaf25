/// Makes the examples on which the networks of `calibrated` are trained, and those on which they are evaluated.
///
///     alcove_fit_examples FOLDER [SCENES]
///
/// Writes train.bin, from the fitted half of the meshes and from random scenes, and test.bin, from the other half. A
/// row of a file contains the inputs of each network as 16-bit numbers (−1 is stored as 0, and 1.5 as 65535), then the
/// condition, the radius, the reference ao, and the index of the mesh or scene as 32-bit floats. Takes about ten
/// minutes.
#include "meshes.h"
#include "scenes.h"

#include "alcove/base/types.h"
#include "alcove/field/detail/trace.h"
#include "alcove/field/level_stack.h"
#include "alcove/mesh/files.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/methods/calibrated_probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numeric>

namespace alcove::fit {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

class ExampleFile {
  public:
    explicit ExampleFile(const std::string& path) : file_(path, std::ios::binary) {}

    /// Adds the surfels of a batch, all with the same radius.
    void add(const LevelStack& field, const SurfelBatch& batch, float radius, std::span<const float> ao, int scene) {
        const float probed = std::min(radius, 1.0f);
        CalibratedInputs<ThirteenProbes> small;
        CalibratedInputs<ThirtyEightProbes> medium;
        CalibratedInputs<SixtyThreeProbes> large;
        calibrated_inputs<ThirteenProbes>(field, batch, probed, small);
        calibrated_inputs<ThirtyEightProbes>(field, batch, probed, medium);
        calibrated_inputs<SixtyThreeProbes>(field, batch, probed, large);
        const RingNetwork::Condition condition = calibrated_condition(field, probed);
        for (std::size_t k = 0; k < batch.count; ++k) {
            std::vector<std::uint16_t> row;
            const auto put = [&](const auto& inputs) {
                for (const auto& values : inputs)
                    row.push_back(static_cast<std::uint16_t>(std::lround((values[k] + 1.0f) / 2.5f * 65535.0f)));
            };
            put(small), put(medium), put(large);
            const std::array<float, 5> rest{condition.resolution, condition.two_sided, radius, ao[k],
                                            static_cast<float>(scene)};
            file_.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(2 * row.size()));
            file_.write(reinterpret_cast<const char*>(rest.data()), sizeof rest);
        }
        rows_ += batch.count;
    }
    std::size_t rows() const { return rows_; }
    void finish() {
        if (!file_.flush())
            throw std::runtime_error("cannot write the examples; is the disk full?");
    }

  private:
    std::ofstream file_;
    std::size_t rows_ = 0;
};

/// A mesh with surfels, and for each surfel the distances at which its rays hit. Surfels and distances are in unit
/// space.
class LabelledMesh {
  public:
    LabelledMesh(const Mesh& of, std::vector<Surfel> at, int rays)
        : mesh(of), triangles(triangulate(of).triangles), surfels(std::move(at)), rays_(rays) {
        const Frame frame = frame_of(of.box());
        std::vector<Vec3> positions;
        for (const Vec3d& p : of.positions)
            positions.push_back(frame.to_unit(p));
        shoot(RaySurface(positions, triangles));
    }

    float ao(std::size_t surfel, float radius) const {
        const auto begin = distances_.begin() + static_cast<std::ptrdiff_t>(surfel * static_cast<std::size_t>(rays_));
        return static_cast<float>(std::count_if(begin, begin + rays_, [&](float d) { return d >= radius; })) /
               static_cast<float>(rays_);
    }

    const Mesh& mesh;
    std::vector<Triangle> triangles;
    std::vector<Surfel> surfels;

  private:
    void shoot(const RaySurface& surface) {
        distances_.resize(surfels.size() * static_cast<std::size_t>(rays_));
        const CosineLattice lattice(rays_);
        parallel_for(surfels.size(), 16, [&](std::size_t begin, std::size_t end) {
            std::array<SurfaceHit, RayBatch::capacity> hits;
            for (std::size_t i = begin; i < end; ++i) {
                const Basis basis(surfels[i].normal);
                const CosineLattice::Shift shift(hash(surfels[i].position, 0));
                for (int first = 0; first < rays_; first += static_cast<int>(RayBatch::capacity)) {
                    RayBatch batch;
                    for (int r = first; r < std::min(first + static_cast<int>(RayBatch::capacity), rays_); ++r)
                        batch.push_back(
                            {surfels[i].origin(ray_offset(1.0f)), basis.to_world(lattice.direction(r, shift))}, 0.0f);
                    surface.find_nearest(batch, infinity, hits);
                    for (std::size_t r = 0; r < batch.count; ++r)
                        distances_[i * static_cast<std::size_t>(rays_) + static_cast<std::size_t>(first) + r] =
                            batch.hit[r] ? batch.travelled[r] : infinity;
                }
            }
        });
    }

    int rays_;
    std::vector<float> distances_;
};

/// Random surfels: a share `of_vertices` are vertices, the others are points of faces, with the normal of the face or
/// an interpolated normal.
std::vector<Surfel> random_surfels(const Mesh& mesh, std::size_t count, double of_vertices, std::mt19937& random) {
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    const std::vector<Surfel> vertices = make_surfels(mesh, triangles, frame);
    std::vector<double> areas;
    for (const Triangle& t : triangles)
        areas.push_back(glm::length(
            glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])));
    std::discrete_distribution<std::size_t> any_triangle(areas.begin(), areas.end());
    std::uniform_int_distribution<std::size_t> any_vertex(0, vertices.size() - 1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Surfel> surfels;
    for (std::size_t tries = 0; surfels.size() < count && tries < 20 * count; ++tries) {
        if (unit(random) < of_vertices) {
            if (const Surfel& vertex = vertices[any_vertex(random)]; vertex.has_normal())
                surfels.push_back(vertex);
            continue;
        }
        const Triangle& t = triangles[any_triangle(random)];
        const Vec3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        Vec3 normal = unit_or_zero(glm::cross(b - a, c - a));
        if (normal == Vec3(0.0f))
            continue;
        const double u = std::sqrt(unit(random)), v = unit(random);
        const Vec3d weights(1.0 - u, u * (1.0 - v), u * v);
        if (unit(random) < 0.3) {
            const Vec3 smooth =
                unit_or_zero(weights.x * Vec3d(vertices[t[0]].normal) + weights.y * Vec3d(vertices[t[1]].normal) +
                             weights.z * Vec3d(vertices[t[2]].normal));
            if (glm::dot(smooth, normal) > 0.5f)
                normal = smooth;
        }
        surfels.push_back({frame.to_unit(weights.x * a + weights.y * b + weights.z * c), normal});
    }
    return surfels;
}

/// Adds `draws` examples per surfel, at random radii from `least` to `most`, and also at an infinite radius if `most`
/// is 1.
void add_random(ExampleFile& file, const LabelledMesh& labelled, const GridOptions& grid, SignChoice sign, float least,
                float most, int draws, int scene, std::mt19937& random) {
    const LevelStack field(voxelize(labelled.mesh, labelled.triangles, {.grid = grid, .sign = sign}));
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::vector<std::size_t> order(labelled.surfels.size());
    std::iota(order.begin(), order.end(), 0u);
    for (int draw = 0; draw < draws; ++draw) {
        std::shuffle(order.begin(), order.end(), random);
        constexpr std::size_t same_radius = 16;
        for (std::size_t begin = 0; begin < order.size(); begin += same_radius) {
            float radius = least * std::pow(1.25f * most / least, unit(random));
            if (radius > most)
                radius = most < 1.0f ? most : infinity;
            SurfelBatch batch;
            std::vector<float> ao;
            for (std::size_t i = begin; i < std::min(begin + same_radius, order.size()); ++i) {
                const float value = labelled.ao(order[i], radius);
                if (value == 0.0f && unit(random) > 0.2f) // buried in another part
                    continue;
                batch.push_back(labelled.surfels[order[i]]);
                ao.push_back(value);
            }
            file.add(field, batch, radius, ao, scene);
        }
    }
}

void make_training_examples(const std::string& folder, std::span<const MeshFile> files, int scenes) {
    ExampleFile file(folder + "/train.bin");
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    constexpr int rays = 512;
    constexpr float finest = 1.0f / 256.0f;
    int scene = 0;
    const auto add = [&](const Mesh& mesh, std::size_t count, double of_vertices, SignChoice sign) {
        const LabelledMesh labelled(mesh, random_surfels(mesh, count, of_vertices, random), rays);
        const float voxel = unit(random) < 0.75f ? finest : std::exp2(-6.0f - 2.0f * unit(random));
        add_random(file, labelled, {.radius = 1.0f, .largest_voxel = voxel}, sign, 4.0f * voxel, 1.0f, 3, scene,
                   random);
        if (unit(random) < 0.35f) { // small radii, for which the grid is finer
            const float radius = 0.01f * std::pow(3.0f, unit(random));
            add_random(file, labelled, {.radius = radius}, sign, radius, radius, 1, scene, random);
        }
        ++scene;
    };
    std::vector<Mesh> meshes;
    for (const MeshFile& mesh_file : files) {
        if (!mesh_file.fitted)
            continue;
        const Mesh read = read_mesh(mesh_file.path.string());
        Mesh mesh;
        const Box box = read.box();
        for (const Vec3d& p : read.positions)
            mesh.positions.push_back(is_finite(p) ? (p - box.center()) / box.diagonal() : Vec3d(0.0));
        for (std::size_t f = 0; f < read.face_count(); ++f)
            mesh.add_face(read.face(f));
        add(turned(mesh, random), 1500, 0.7, SignChoice::automatic);
        meshes.push_back(std::move(mesh));
    }
    for (int i = 0; i < scenes; ++i) {
        const TrainingScene made = random_scene(meshes, random);
        try {
            add(made.mesh, 900, made.kind == "parts" || made.kind == "primitives" || made.kind == "rooms" ? 0.3 : 0.5,
                made.sign);
        } catch (const InputError& error) {
            fmt::print("scene {} ({}): {}\n", i, made.kind, error.what());
        }
        if (i % 50 == 49) {
            fmt::print("{} scenes, {} examples\n", i + 1, file.rows());
            std::fflush(stdout);
        }
    }
    file.finish();
}

void make_test_examples(const std::string& folder, std::span<const MeshFile> files) {
    ExampleFile file(folder + "/test.bin");
    constexpr std::size_t most = 1000;
    constexpr int rays = 1024;
    for (std::size_t m = 0; m < files.size(); ++m) {
        if (files[m].fitted)
            continue;
        const Mesh mesh = read_mesh(files[m].path.string());
        const std::vector<Surfel> all = make_surfels(mesh, triangulate(mesh).triangles, frame_of(mesh.box()));
        std::vector<Surfel> some;
        const std::size_t count = std::min(most, all.size());
        for (std::size_t i = 0; i < count; ++i)
            if (const Surfel& surfel = all[i * all.size() / count]; surfel.has_normal())
                some.push_back(surfel);
        const LabelledMesh labelled(mesh, some, rays);
        for (const float radius : {0.02f, 0.05f, 0.1f, 0.2f, 0.5f, infinity}) {
            const LevelStack field(voxelize(mesh, labelled.triangles, {.grid = {.radius = std::min(radius, 1.0f)}}));
            for (std::size_t begin = 0; begin < some.size(); begin += SurfelBatch::capacity) {
                SurfelBatch batch;
                std::vector<float> ao;
                for (std::size_t i = begin; i < std::min(begin + SurfelBatch::capacity, some.size()); ++i) {
                    batch.push_back(some[i]);
                    ao.push_back(labelled.ao(i, radius));
                }
                file.add(field, batch, radius, ao, static_cast<int>(m));
            }
        }
    }
    file.finish();
}

}
}

int main(int argc, char** argv) {
    try {
        if (argc < 2)
            throw std::runtime_error("usage: alcove_fit_examples FOLDER [SCENES]");
        const std::string folder = argv[1];
        std::filesystem::create_directories(folder);
        const std::vector<alcove::fit::MeshFile> files =
            alcove::fit::split_meshes(std::string(ALCOVE_TREE) + "/build/meshes/meshes");
        alcove::fit::make_test_examples(folder, files);
        alcove::fit::make_training_examples(folder, files, argc > 2 ? std::atoi(argv[2]) : 640);
        return EXIT_SUCCESS;
    } catch (const std::exception& failure) {
        fmt::print(stderr, "alcove_fit_examples: {}\n", failure.what());
        return EXIT_FAILURE;
    }
}
