#include "scenes.h"

#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "subdivided.h"

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace alcove::fit {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
using Matrix = glm::dmat3;

/// Draws the random numbers of a scene.
class Chance {
  public:
    explicit Chance(std::mt19937& random) : random_(random) {}
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    /// Uniform in the logarithm.
    double scale(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    double normal() { return std::normal_distribution<double>()(random_); }
    Vec3d normals() { return {normal(), normal(), normal()}; }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    bool happens(double probability) { return between(0.0, 1.0) < probability; }
    Matrix rotation() { return glm::mat3_cast(glm::normalize(glm::dquat(normal(), normal(), normal(), normal()))); }
    Matrix stretch(double by) {
        Matrix m(1.0);
        for (int axis = 0; axis < 3; ++axis)
            m[axis][axis] = std::exp(by * normal());
        return m;
    }
    const Mesh& one_of(std::span<const Mesh> meshes) {
        return meshes[static_cast<std::size_t>(whole(0, static_cast<int>(meshes.size()) - 1))];
    }

  private:
    std::mt19937& random_;
};

void append(Mesh& mesh, const Mesh& part, const Matrix& matrix, const Vec3d& move) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& p : part.positions)
        mesh.positions.push_back(matrix * p + move);
    const bool mirrored = glm::determinant(matrix) < 0.0;
    for (std::size_t f = 0; f < part.face_count(); ++f) {
        std::vector<std::uint32_t> face(part.face(f).begin(), part.face(f).end());
        for (std::uint32_t& corner : face)
            corner += first;
        if (mirrored)
            std::reverse(face.begin(), face.end());
        mesh.add_face(face);
    }
}

Mesh transformed(const Mesh& mesh, const Matrix& matrix) {
    Mesh moved;
    append(moved, mesh, matrix, Vec3d(0.0));
    return moved;
}

/// A sum of sines in random directions, in octaves.
class Noise {
  public:
    Noise(Chance& chance, double amplitude, double frequency) {
        const int octaves = chance.whole(1, 4);
        const double gain = chance.between(0.35, 0.7);
        for (int octave = 0; octave < octaves; ++octave)
            for (int i = 0; i < 6; ++i)
                waves_.push_back({chance.normals() * frequency * std::exp2(octave),
                                  amplitude / std::sqrt(6.0) * std::pow(gain, octave), chance.between(0.0, turn)});
    }
    double operator()(const Vec3d& p) const {
        double sum = 0.0;
        for (const Wave& wave : waves_)
            sum += wave.amplitude * std::sin(glm::dot(wave.frequency, p) + wave.phase);
        return sum;
    }

  private:
    struct Wave {
        Vec3d frequency;
        double amplitude, phase;
    };
    std::vector<Wave> waves_;
};

/// Subdivides a mesh to at least 40,000 triangles and displaces its vertices, like a scan of a rough surface.
Mesh displaced(Mesh mesh, Chance& chance) {
    while (triangulate(mesh).triangles.size() < 40'000)
        mesh = subdivided(mesh);
    const std::vector<Vec3> normals = area_weighted_normals(mesh, triangulate(mesh).triangles);
    const double frequency = chance.scale(15.0, 150.0), height = chance.between(0.15, 0.9) / frequency;
    const bool ridged = chance.happens(0.5), patchy = chance.happens(0.4);
    const double side = chance.happens(0.5) ? 1.0 : -1.0;
    const Noise noise(chance, ridged ? 2.0 : 1.0, 0.6 * frequency), where(chance, 1.0, chance.between(2.0, 8.0));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Vec3d& p = mesh.positions[v];
        double value = noise(p);
        if (ridged)
            value = side * (0.7 - 1.4 * std::fabs(std::sin(value)));
        if (patchy)
            value *= std::clamp(0.5 + where(p), 0.0, 1.0);
        p += height * value * Vec3d(normals[v]);
    }
    return mesh;
}

/// The boundary of the filled cells of a grid with planes at `cuts`.
template <class Filled>
Mesh blocks(const std::array<std::vector<double>, 3>& cuts, Filled filled) {
    Mesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> known;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [it, added] = known.try_emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added)
            mesh.positions.emplace_back(cuts[0][static_cast<std::size_t>(at[0])],
                                        cuts[1][static_cast<std::size_t>(at[1])],
                                        cuts[2][static_cast<std::size_t>(at[2])]);
        return it->second;
    };
    std::array<int, 3> size;
    for (std::size_t axis = 0; axis < 3; ++axis)
        size[axis] = static_cast<int>(cuts[axis].size()) - 1;
    const auto is_filled = [&](const std::array<int, 3>& c) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (c[axis] < 0 || c[axis] >= size[axis])
                return false;
        return filled(c);
    };
    std::array<int, 3> c;
    for (c[0] = 0; c[0] < size[0]; ++c[0])
        for (c[1] = 0; c[1] < size[1]; ++c[1])
            for (c[2] = 0; c[2] < size[2]; ++c[2])
                for (std::size_t axis = 0; axis < 3 && is_filled(c); ++axis)
                    for (const int side : {0, 1}) {
                        std::array<int, 3> next = c;
                        next[axis] += 2 * side - 1;
                        if (is_filled(next))
                            continue;
                        const auto corner = [&](int u, int v) {
                            std::array<int, 3> at = c;
                            at[axis] += side;
                            at[(axis + 1) % 3] += u;
                            at[(axis + 2) % 3] += v;
                            return vertex(at);
                        };
                        std::array<std::uint32_t, 4> quad{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                        if (side == 0)
                            std::swap(quad[1], quad[3]);
                        mesh.add_face(quad);
                    }
    return mesh;
}

Mesh unit_cube() {
    return blocks({{{-0.5, 0.5}, {-0.5, 0.5}, {-0.5, 0.5}}}, [](const auto&) { return true; });
}

/// Planes at random distances, some of them as close as the two sides of a wall.
std::vector<double> random_cuts(Chance& chance, int cells) {
    std::vector<double> cuts{0.0};
    for (int i = 0; i < cells; ++i)
        cuts.push_back(cuts.back() + (chance.happens(0.35) ? chance.scale(0.004, 0.05) : chance.between(0.05, 0.5)));
    for (double& cut : cuts)
        cut -= 0.5 * cuts.back();
    return cuts;
}

/// A block from which boxes are removed, and to which ribs and bosses are added.
Mesh block_part(Chance& chance) {
    std::array<std::vector<double>, 3> cuts;
    std::array<int, 3> size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        size[axis] = chance.whole(2, axis == 2 ? 6 : 13);
        cuts[axis] = random_cuts(chance, size[axis]);
    }
    std::vector<std::uint8_t> cells(static_cast<std::size_t>(size[0] * size[1] * size[2]), chance.happens(0.7));
    const auto cell = [&](const std::array<int, 3>& c) -> std::uint8_t& {
        return cells[static_cast<std::size_t>((c[0] * size[1] + c[1]) * size[2] + c[2])];
    };
    const int boxes = chance.whole(2, 24);
    for (int box = 0; box < boxes; ++box) {
        std::array<int, 3> low, high, c;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = chance.whole(0, size[axis] - 1);
            high[axis] = std::min(low[axis] + chance.whole(0, 3), size[axis] - 1);
        }
        if (chance.happens(0.5)) // through, or up to the top
            high[2] = size[2] - 1;
        const bool fills = chance.happens(0.45);
        for (c[0] = low[0]; c[0] <= high[0]; ++c[0])
            for (c[1] = low[1]; c[1] <= high[1]; ++c[1])
                for (c[2] = low[2]; c[2] <= high[2]; ++c[2])
                    cell(c) = fills;
    }
    cell({0, 0, 0}) = 1;
    return blocks(cuts, [&](const std::array<int, 3>& c) { return cell(c) != 0; });
}

/// A closed ring of points (radius, height), turned around the z axis: a tube, a torus, a shaft or a gear.
Mesh lathe(const std::vector<std::array<double, 2>>& ring, int around, double teeth, double depth, const Noise& noise) {
    Mesh mesh;
    const auto count = static_cast<int>(ring.size());
    for (int i = 0; i < around; ++i)
        for (const auto& [radius, height] : ring) {
            const double angle = turn * i / around;
            const double tooth = depth * std::clamp(3.0 * std::sin(teeth * angle), -1.0, 1.0);
            const Vec3d out(std::cos(angle), std::sin(angle), 0.0);
            const double r = radius * (1.0 + tooth) * (1.0 + noise(out + Vec3d(0, 0, 3.0 * height)));
            mesh.positions.push_back(r * out + Vec3d(0, 0, height));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i % around * count + j % count); };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < count; ++j)
            mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

Mesh primitive(Chance& chance) {
    const bool rough = chance.happens(0.4);
    const Noise noise(chance, rough ? chance.between(0.02, 0.15) : 0.0, chance.between(3.0, 14.0));
    const int around = rough ? 200 : chance.whole(5, 72);
    std::vector<std::array<double, 2>> ring;
    const int kind = chance.whole(0, 5);
    if (kind == 0) // a box
        return unit_cube();
    if (kind <= 2) { // a ball, or a torus
        const double inner = kind == 1 ? 0.0 : chance.between(0.3, 0.45), tube = 0.5 - inner;
        const int steps = rough ? 100 : chance.whole(6, 40);
        const double half = kind == 1 ? 0.5 * turn : turn;
        for (int j = 0; j < steps + (kind == 1); ++j) {
            const double angle = half * j / steps - 0.25 * turn;
            ring.push_back({std::max(inner + tube * std::cos(angle), 0.0), tube * std::sin(angle)});
        }
        return lathe(ring, around, 0.0, 0.0, noise);
    }
    // A profile of steps, with or without a bore. Its radius changes suddenly or smoothly.
    const int steps = chance.whole(1, 7);
    const bool smooth = chance.happens(0.4);
    const double bore = kind == 3 ? 0.0 : chance.between(0.02, 0.3), height = chance.scale(0.1, 1.5);
    double wall = kind == 5 ? chance.scale(0.006, 0.05) : 0.0; // thickness of a shell
    ring.push_back({bore, -0.5 * height});
    double radius = 0.0;
    for (int step = 0; step <= steps; ++step) {
        const double next = wall > 0.0 ? bore + wall : bore + chance.between(0.05, 0.5);
        const double low = height * (double(step) / (steps + 1) - 0.5),
                     high = height * (double(step + 1) / (steps + 1) - 0.5);
        if (smooth && step > 0)
            for (int k = 1; k < 6; ++k) {
                const double t = k / 6.0, eased = t * t * (3.0 - 2.0 * t);
                ring.push_back({radius + eased * (next - radius), low + 0.3 * t * (high - low)});
            }
        else
            ring.push_back({next, low});
        ring.push_back({next, high});
        radius = next;
    }
    ring.push_back({bore, 0.5 * height});
    const bool toothed = chance.happens(0.4);
    const int teeth = toothed ? chance.whole(0, 16) : 0;
    if (toothed && teeth > 0)
        return lathe(ring, 8 * teeth, teeth, chance.between(0.03, 0.3), noise);
    return lathe(ring, around, 0.0, 0.0, noise);
}

/// A plate that other shapes stand on or sink into.
void add_plate(Mesh& mesh, Chance& chance, double top, double thickness) {
    Matrix size(1.0);
    size[0][0] = chance.between(0.8, 3.0);
    size[1][1] = chance.between(0.8, 3.0);
    size[2][2] = thickness;
    append(mesh, unit_cube(), size, {0, 0, top - 0.5 * thickness});
}

double lowest(const Mesh& mesh) {
    return mesh.box().min.z;
}

}

Mesh turned(const Mesh& mesh, std::mt19937& random) {
    return transformed(mesh, Chance(random).rotation());
}

TrainingScene random_scene(std::span<const Mesh> meshes, std::mt19937& random) {
    Chance chance(random);
    TrainingScene scene;
    const double which = chance.between(0.0, 1.0);
    const auto stretched = [&](const Mesh& mesh, double by) {
        return transformed(mesh, chance.rotation() * chance.stretch(by) * chance.rotation());
    };
    if (which < 0.15) {
        scene = {"stretched", stretched(chance.one_of(meshes), 0.3)};
    } else if (which < 0.32) {
        scene = {"displaced", displaced(stretched(chance.one_of(meshes), 0.3), chance)};
    } else if (which < 0.45) {
        scene.kind = "together";
        const int count = chance.whole(1, 4);
        for (int i = 0; i < count; ++i)
            append(scene.mesh, stretched(chance.one_of(meshes), 0.2), Matrix(chance.between(0.5, 1.2)),
                   {0.45 * chance.normal(), 0.45 * chance.normal(), i > 0 ? 0.3 * chance.normal() : 0.0});
        if (count == 1 || chance.happens(0.6))
            add_plate(scene.mesh, chance, lowest(scene.mesh) + chance.between(-0.02, 0.1), 0.1);
        if (chance.happens(0.3))
            scene.sign = SignChoice::solid;
    } else if (which < 0.65) {
        scene.kind = "primitives";
        const auto count = 1 + static_cast<int>(chance.scale(1.0, 24.0));
        const double spread = chance.between(0.2, 0.9);
        for (int i = 0; i < count; ++i)
            append(scene.mesh, primitive(chance),
                   (chance.happens(0.3) ? Matrix(1.0) : chance.rotation()) * chance.stretch(0.5) *
                       std::exp(0.5 * chance.normal() - 0.4),
                   count > 1 ? spread * chance.normals() : Vec3d(0.0));
        if (chance.happens(0.4))
            add_plate(scene.mesh, chance, chance.between(-0.8, 0.2), 0.2);
        if (chance.happens(0.6))
            scene.sign = SignChoice::solid;
    } else if (which < 0.73) {
        // Two or three walls with a few objects between them.
        scene.kind = "rooms";
        const int walls = chance.whole(2, 3);
        for (int axis = 0; axis < walls; ++axis) {
            Matrix size(1.0);
            Vec3d move(0.0);
            for (int other = 0; other < 3; ++other)
                size[other][other] = chance.between(0.6, 2.0);
            size[axis][axis] = chance.scale(0.01, 0.2);
            for (int other = 0; other < 3; ++other)
                move[other] = other == axis ? -0.5 * size[axis][axis] : 0.5 * size[other][other] - 0.2;
            append(scene.mesh, unit_cube(), size, move);
        }
        for (int i = chance.whole(0, 3); i > 0; --i)
            append(scene.mesh, primitive(chance), chance.rotation() * chance.stretch(0.3) * chance.scale(0.1, 0.6),
                   {chance.between(0.1, 0.8), chance.between(0.1, 0.8), chance.between(0.1, 0.8)});
        if (chance.happens(0.6))
            scene.sign = SignChoice::solid;
    } else {
        scene.kind = "parts";
        append(scene.mesh, chance.happens(0.65) ? block_part(chance) : primitive(chance), Matrix(1.0), Vec3d(0.0));
        if (chance.happens(0.25))
            add_plate(scene.mesh, chance, lowest(scene.mesh) + chance.between(-0.01, 0.0), 0.1);
    }
    scene.mesh = turned(scene.mesh, random);
    return scene;
}

}
