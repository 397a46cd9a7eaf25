// Field: signed distances of meshes, grids and shapes.
#include "arrays.h"
#include "bindings.h"
#include "run.h"

#include "alcove/base/parallel.h"
#include "alcove/field/detail/trace.h"
#include "alcove/field/level_stack.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/vdb/vdb_file.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace alcove::python {
namespace {

constexpr std::size_t grain = 4096;

/// Runs `work`, which processes this many points. For few points, runs it on this thread, to avoid the cost of another.
void run_on(std::size_t points, const std::function<void()>& work) {
    constexpr std::size_t few = 256;
    if (points > few)
        return run(work);
    const py::gil_scoped_release released;
    work();
}

/// A field in unit space, and the frame of its scene.
struct SceneField {
    AnyField field;
    Frame frame;
};

/// The size as a float. \throw InputError if it is not positive and finite.
float size_of(double size, const char* argument) {
    if (!(size > 0.0) || !std::isfinite(size))
        throw InputError(fmt::format("{}: takes a positive number, not {}", argument, size));
    return static_cast<float>(size);
}

Vec3 direction_of(const std::array<double, 3>& v, const char* argument) {
    const Vec3d direction(v[0], v[1], v[2]);
    const double size = glm::length(direction);
    if (!(size > 0.0) || !std::isfinite(size))
        throw InputError(fmt::format("{}: takes a direction, not zero", argument));
    return Vec3(direction / size);
}

SceneField of_stack(const GridStack& stack) {
    return {LevelStack(stack), stack.frame};
}

SceneField of_mesh(const py::object& object, const py::object& radius, const py::object& voxel,
                   const std::string& sign) {
    Mesh given = to_mesh(object, "mesh");
    Mesh mesh;
    run([&] { mesh = with_surface(std::move(given)); });
    const Frame frame = frame_of(mesh.box());
    VoxelizeOptions options;
    if (!voxel.is_none())
        options.grid.voxel = length(voxel, "voxel").to_unit(frame.diagonal);
    options.grid.radius = length(radius, "radius").to_unit(frame.diagonal, options.grid.voxel);
    options.grid.inner_band = options.grid.outer_band;
    options.sign = sign == "solid" ? SignChoice::solid : sign == "sheet" ? SignChoice::sheet : SignChoice::automatic;
    if (sign != "solid" && sign != "sheet" && sign != "auto")
        throw InputError("sign: takes auto, solid or sheet, not '" + sign + "'");
    std::optional<SceneField> field;
    run([&] { field = of_stack(voxelize(mesh, triangulate(mesh).triangles, options)); });
    return *std::move(field);
}

/// Calls f(points in unit space, index of the first point) for each block of points.
template <class F>
void for_blocks(const SceneField& self, const double* positions, std::size_t count, const F& f) {
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> x(end - begin), y(end - begin), z(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
            const double* const p = positions + 3 * i;
            const Vec3 unit = self.frame.to_unit({p[0], p[1], p[2]});
            x[i - begin] = unit.x, y[i - begin] = unit.y, z[i - begin] = unit.z;
        }
        f(Points{x.data(), y.data(), z.data(), end - begin}, begin);
    });
}

py::array_t<float> map(const SceneField& self, const py::object& points) {
    const auto positions = rows<double>(points, 3, "points");
    std::vector<float> distances(static_cast<std::size_t>(positions.shape(0)));
    run_on(distances.size(), [&] {
        for_blocks(self, positions.data(), distances.size(), [&](const Points& block, std::size_t first) {
            self.field.map(block, any_reach, distances.data() + first);
            for (std::size_t i = 0; i < block.count; ++i)
                distances[first + i] = static_cast<float>(double(distances[first + i]) * self.frame.diagonal);
        });
    });
    return to_array(std::move(distances));
}

py::array_t<float> gradient(const SceneField& self, const py::object& points) {
    const auto positions = rows<double>(points, 3, "points");
    const auto count = static_cast<std::size_t>(positions.shape(0));
    std::vector<float> gradients(3 * count);
    run_on(count, [&] {
        const float step = std::max(0.5f * self.field.resolution(), 1e-3f);
        parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const double* const p = positions.data() + 3 * i;
                const Vec3 unit = self.frame.to_unit({p[0], p[1], p[2]});
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3 offset(0.0f);
                    offset[axis] = step;
                    gradients[3 * i + static_cast<std::size_t>(axis)] =
                        (self.field.map(unit + offset) - self.field.map(unit - offset)) / (2.0f * step);
                }
            }
        });
    });
    return to_array(std::move(gradients), 3);
}

py::array_t<float> trace_rays(const SceneField& self, const py::object& origins, const py::object& directions,
                              const py::object& radius) {
    const auto starts = rows<double>(origins, 3, "origins");
    const auto ways = rows<double>(directions, 3, "directions");
    if (starts.shape(0) != ways.shape(0))
        throw py::value_error("directions: has a different number of rows from origins");
    for (py::ssize_t i = 0; i < ways.shape(0); ++i)
        direction_of({ways.at(i, 0), ways.at(i, 1), ways.at(i, 2)}, "directions");
    const float far = length(radius, "radius").to_unit(self.frame.diagonal);
    std::vector<float> distances(static_cast<std::size_t>(starts.shape(0)));
    run_on(distances.size(), [&] {
        TraceOptions options;
        options.far = far;
        options.hit_distance = options.shortest_step = std::max(0.05f * self.field.resolution(), 1e-5f);
        options.two_sided = self.field.two_sided();
        parallel_for(distances.size(), RayBatch::capacity, [&](std::size_t begin, std::size_t end) {
            RayBatch rays;
            for (std::size_t i = begin; i < end; ++i) {
                const double *const o = starts.data() + 3 * i, *const d = ways.data() + 3 * i;
                const Vec3 direction(glm::normalize(Vec3d(d[0], d[1], d[2])));
                rays.push_back({self.frame.to_unit({o[0], o[1], o[2]}), direction}, 0.0f);
            }
            trace(self.field, rays, options);
            for (std::size_t i = begin; i < end; ++i)
                distances[i] = rays.hit[i - begin]
                                   ? static_cast<float>(double(rays.travelled[i - begin]) * self.frame.diagonal)
                                   : std::numeric_limits<float>::infinity();
        });
    });
    return to_array(std::move(distances));
}

py::array_t<float> ao(const SceneField& self, const py::object& points, const py::object& normals,
                      const std::string& method, const py::object& radius, const py::dict& parameters) {
    const auto positions = rows<double>(points, 3, "points");
    const auto directions = rows<double>(normals, 3, "normals");
    if (positions.shape(0) != directions.shape(0))
        throw py::value_error("normals: has a different number of rows from points");
    const Method& chosen = find_method(method);
    if (chosen.needs_mesh)
        throw InputError("method: " + method + " needs a mesh; a field has none: use bake()");
    Settings settings{.radius = length(radius, "radius").to_unit(self.frame.diagonal)};
    for (const auto& [name, value] : parameters)
        settings.parameters.emplace_back(name.cast<std::string>(), value.cast<double>());
    check_settings(chosen, settings);
    std::vector<Surfel> surfels(static_cast<std::size_t>(positions.shape(0)));
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const double *const p = positions.data() + 3 * i, *const n = directions.data() + 3 * i;
        const Vec3d normal(n[0], n[1], n[2]);
        const double size = glm::length(normal);
        surfels[i] = {self.frame.to_unit({p[0], p[1], p[2]}),
                      size > 0.0 && std::isfinite(size) ? Vec3(normal / size) : Vec3(0.0f)};
    }
    ChannelValues values;
    run_on(surfels.size(), [&] { values = evaluate(surfels, Occluders(self.field), chosen, settings, Channel::ao); });
    return to_array(std::move(values[Channel::ao]));
}

using Corner = std::array<double, 3>;

py::tuple dense(const SceneField& self, const std::array<std::size_t, 3>& shape,
                const std::optional<std::pair<Corner, Corner>>& box) {
    constexpr std::size_t most = std::size_t(1) << 31;
    std::size_t count = 1;
    for (const std::size_t n : shape) {
        if (n < 2 || n > most / count)
            throw py::value_error("shape: takes three numbers of at least 2, and at most 2^31 values");
        count *= n;
    }
    Vec3d low, high;
    if (box) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = box->first[static_cast<std::size_t>(axis)];
            high[axis] = box->second[static_cast<std::size_t>(axis)];
        }
    } else {
        const float extent = self.field.extent();
        if (!std::isfinite(extent))
            throw InputError("box: a shape has no bounds: give the corners of the lattice");
        low = self.frame.to_scene(Vec3(-extent));
        high = self.frame.to_scene(Vec3(extent));
    }
    const Vec3d step = (high - low) / Vec3d(shape[0] - 1, shape[1] - 1, shape[2] - 1);
    std::vector<float> values(count);
    run_on(count, [&] {
        parallel_for(shape[0], 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t j = 0; j < shape[1]; ++j)
                    for (std::size_t k = 0; k < shape[2]; ++k)
                        values[(i * shape[1] + j) * shape[2] + k] =
                            static_cast<float>(double(self.field.map(self.frame.to_unit(low + step * Vec3d(i, j, k)))) *
                                               self.frame.diagonal);
        });
    });
    const py::array_t<float> array =
        to_array(std::move(values))
            .reshape({static_cast<py::ssize_t>(shape[0]), static_cast<py::ssize_t>(shape[1]),
                      static_cast<py::ssize_t>(shape[2])});
    return py::make_tuple(array, std::array{low.x, low.y, low.z}, std::array{step.x, step.y, step.z});
}

Vec3 vector(const std::array<double, 3>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}

void add_field(py::module_& module) {
    py::class_<SceneField>(module, "Field", R"(Signed distances: positive outside, negative inside, in scene units.

Field(mesh, radius="10%", voxel=None, sign="auto") voxelizes a mesh. Distances are correct up to the radius; beyond
it, they are lower bounds. Field.read() reads a .vdb. Field.sphere(), box(), plane(), torus() and capsule() make
shapes.)")
        .def(py::init(&of_mesh), py::arg("mesh"), py::arg("radius") = "10%", py::arg("voxel") = py::none(),
             py::arg("sign") = "auto")
        .def_static(
            "read",
            [](const std::filesystem::path& file) {
                std::optional<SceneField> field;
                run([&] { field = of_stack(read_grids(file)); });
                return *std::move(field);
            },
            py::arg("file"), "The level sets of a .vdb file")
        .def_static(
            "sphere",
            [](const std::array<double, 3>& center, double radius) {
                return SceneField{Sphere{vector(center), size_of(radius, "radius")}, {}};
            },
            py::arg("center"), py::arg("radius"))
        .def_static(
            "box",
            [](const std::array<double, 3>& center, const std::array<double, 3>& half_extent) {
                return SceneField{Cuboid{vector(center), vector(half_extent)}, {}};
            },
            py::arg("center"), py::arg("half_extent"))
        .def_static(
            "plane",
            [](const std::array<double, 3>& normal, double offset) {
                return SceneField{Plane{direction_of(normal, "normal"), static_cast<float>(offset)}, {}};
            },
            py::arg("normal"), py::arg("offset") = 0.0, "The half-space below the plane {p: normal . p = offset}")
        .def_static(
            "torus",
            [](const std::array<double, 3>& center, double ring, double tube) {
                return SceneField{Torus{vector(center), size_of(ring, "ring_radius"), size_of(tube, "tube_radius")},
                                  {}};
            },
            py::arg("center"), py::arg("ring_radius"), py::arg("tube_radius"),
            "A torus around the y axis through its centre")
        .def_static(
            "capsule",
            [](const std::array<double, 3>& start, const std::array<double, 3>& end, double radius) {
                return SceneField{Capsule{vector(start), vector(end), size_of(radius, "radius")}, {}};
            },
            py::arg("start"), py::arg("end"), py::arg("radius"))
        .def("map", &map, py::arg("points"), "(n,) float32: the signed distance of each of (n, 3) points")
        .def("gradient", &gradient, py::arg("points"),
             "(n, 3) float32: central differences of map(), of about unit length. Six map() calls per point")
        .def("trace", &trace_rays, py::arg("origins"), py::arg("directions"), py::arg("radius") = "inf",
             "(n,) float32: how far each ray travels to the surface by sphere tracing; inf without a hit within the "
             "radius")
        .def("ao", &ao, py::arg("points"), py::arg("normals"), py::arg("method") = "traced", py::arg("radius") = "10%",
             py::arg("parameters") = py::dict(),
             "(n,) float32: ambient occlusion at points with normals, by a method that needs no mesh")
        .def("dense", &dense, py::arg("shape"), py::arg("box") = py::none(),
             "(values, origin, spacing): the distances on a regular lattice of that shape between two corners, by "
             "default those of a cube around the surface")
        .def_property_readonly(
            "resolution", [](const SceneField& self) { return double(self.field.resolution()) * self.frame.diagonal; },
            "edge of the finest voxel, in scene units; 0 for shapes");
}

}
