// Measures the error of baked points: samples points of meshes, bakes the points, and compares them with exact rays on
// the mesh at the same points. Prints one line per mesh and kind of sampling.
//
//     alcove_point_errors MESH... [--points N=100000]
#include "alcove/bake/bake.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/mesh/triangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace alcove {
namespace {

enum class Sampling { uniform, half, noisy };

struct Samples {
    Mesh points;
    std::vector<SurfacePoint> truth; ///< the points before noise is added
};

Samples sampled(const Mesh& mesh, std::size_t count, Sampling sampling) {
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const std::vector<std::uint32_t> faces = faces_of_triangles(mesh);
    const Vec3d center = mesh.box().center();
    std::vector<double> weights;
    double area = 0.0;
    for (const Triangle& t : triangles) {
        const Vec3d& a = mesh.positions[t[0]];
        const double own = glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a)) / 2.0;
        area += own;
        weights.push_back(sampling == Sampling::half && a.x > center.x ? 0.5 * own : own);
    }
    std::mt19937_64 random(1);
    std::discrete_distribution<std::size_t> pick(weights.begin(), weights.end());
    std::uniform_real_distribution<double> uniform;
    constexpr double noise = 0.01; // relative to the spacing of the points
    std::normal_distribution<double> offset(0.0, noise * std::sqrt(area / static_cast<double>(count)));
    Samples samples;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t t = pick(random);
        const double r = std::sqrt(uniform(random)), s = uniform(random);
        const auto corner = [&](std::size_t k) { return mesh.positions[triangles[t][k]]; };
        const Vec3d p = (1.0 - r) * corner(0) + r * (1.0 - s) * corner(1) + r * s * corner(2);
        const Vec3 normal = unit_or_zero(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
        samples.truth.push_back({p, normal, faces[t]});
        const Vec3d moved(offset(random), offset(random), offset(random));
        samples.points.positions.push_back(sampling == Sampling::noisy ? p + moved : p);
        samples.points.normals.push_back(normal);
    }
    return samples;
}

void report(const std::string& file, std::size_t count) {
    const Mesh mesh = read_mesh(file);
    for (const auto& [sampling, name] : {std::pair(Sampling::uniform, "uniform"), std::pair(Sampling::half, "half"),
                                         std::pair(Sampling::noisy, "noisy")}) {
        const Samples samples = sampled(mesh, count, sampling);
        Stopwatch watch;
        const Baked baked = bake(samples.points, {.threads = 1});
        const double seconds = watch.lap();
        constexpr std::size_t compared = 20000;
        const std::size_t stride = std::max<std::size_t>(count / compared, 1);
        std::vector<SurfacePoint> some;
        for (std::size_t i = 0; i < count; i += stride)
            some.push_back(samples.truth[i]);
        const Baked exact =
            bake(mesh, some,
                 {.radius = Length(baked.radius), .method = "exact", .parameters = {{"rays", 512}}, .pilot = false});
        double squares = 0.0;
        for (std::size_t i = 0; i < some.size(); ++i)
            squares += std::pow(double(baked.ao()[i * stride]) - double(exact.ao()[i]), 2);
        fmt::print("{:40} {:8} RMSE {:.4f}  {:5.2f} s  {}\n", file.substr(file.rfind('/') + 1), name,
                   std::sqrt(squares / static_cast<double>(some.size())), seconds, baked.method);
    }
}

}
}

int main(int argc, char** argv) try {
    std::size_t count = 100'000;
    std::vector<std::string> files;
    for (int i = 1; i < argc; ++i)
        if (std::string(argv[i]) == "--points" && i + 1 < argc)
            count = std::stoul(argv[++i]);
        else
            files.emplace_back(argv[i]);
    for (const std::string& file : files)
        alcove::report(file, count);
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "alcove_point_errors: {}\n", error.what());
    return 1;
}
