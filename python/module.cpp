// bake() and add(), the exceptions, and the module itself.
#include "arrays.h"
#include "bindings.h"
#include "messages.h"
#include "run.h"

#include "alcove/bake/bake.h"
#include "alcove/base/detail/limits.h"
#include "alcove/maps/maps.h"

#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>

namespace alcove::python {
namespace {

ChannelSet channels_named(const std::vector<std::string>& names) {
    ChannelSet set;
    for (const std::string& name : names) {
        std::string known;
        bool found = false;
        for (const ChannelInfo& channel : channels) {
            known += (known.empty() ? "" : ", ") + std::string(channel.name);
            if (channel.name == name) {
                set = set | channel.channel;
                found = true;
            }
        }
        if (!found)
            throw InputError(fmt::format("attributes: takes {}, not '{}'", known, name));
    }
    return set;
}

template <class T>
T word(const std::string& text, const std::vector<std::pair<std::string, T>>& choices, const char* argument) {
    std::string known;
    for (const auto& [name, value] : choices) {
        if (name == text)
            return value;
        known += (known.empty() ? "" : ", ") + name;
    }
    throw InputError(fmt::format("{}: takes {}, not '{}'", argument, known, text));
}

BakeProgress progress_for(const py::object& callback) {
    if (callback.is_none())
        return {};
    // Shared, so that copying the function does not need the GIL.
    return [kept = std::make_shared<py::object>(callback)](std::string_view work, double done) {
        const py::gil_scoped_acquire acquired;
        (*kept)(std::string(work), done);
    };
}

struct Result {
    Baked baked;
};

py::object values_of(const py::object& self, Channel channel) {
    const Baked& baked = self.cast<const Result&>().baked;
    const std::vector<float>& values = baked[channel];
    if (!baked.attributes.has(channel))
        return py::none();
    const auto components = static_cast<py::ssize_t>(info(channel).components);
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(values.size()) / components};
    if (components > 1)
        shape.push_back(components);
    return view(values.data(), shape, self);
}

/// The options of bake(), from their values by name.
BakeOptions options_of(const py::dict& values) {
    BakeOptions options;
    const auto find = [&](const char* name) -> py::object {
        return values.contains(name) ? py::object(values[name]) : py::object();
    };
    const auto text = [&](const char* name) { return find(name).cast<std::string>(); };
    for (const auto& [key, value] : values)
        try {
            const auto name = key.cast<std::string>();
            if (name == "radius")
                options.radius = length(find("radius"), "radius");
            else if (name == "quality")
                options.quality = word<Quality>(
                    text("quality"), {{"draft", Quality::draft}, {"good", Quality::good}, {"fine", Quality::fine}},
                    "quality");
            else if (name == "error")
                options.error = value.cast<std::optional<double>>();
            else if (name == "method")
                options.method = text("method");
            else if (name == "parameters")
                for (const auto& [parameter, number] : value.cast<py::dict>())
                    options.parameters.emplace_back(parameter.cast<std::string>(), number.cast<double>());
            else if (name == "attributes")
                options.attributes =
                    channels_named(py::isinstance<py::str>(value) ? std::vector{value.cast<std::string>()}
                                                                  : value.cast<std::vector<std::string>>());
            else if (name == "occluders")
                for (const py::handle& occluder : value)
                    options.occluders.push_back(to_mesh(py::reinterpret_borrow<py::object>(occluder), "occluders"));
            else if (name == "ground")
                options.ground = value.cast<bool>();
            else if (name == "up") {
                const auto up = value.cast<std::array<double, 3>>();
                options.up = {up[0], up[1], up[2]};
            } else if (name == "self_only")
                options.self = value.cast<bool>();
            else if (name == "via")
                options.via =
                    word<Via>(text("via"), {{"grid", Via::grid}, {"auto", Via::automatic}, {"mesh", Via::mesh}}, "via");
            else if (name == "normals")
                options.normals = word<NormalSource>(text("normals"),
                                                     {{"auto", NormalSource::automatic},
                                                      {"file", NormalSource::file},
                                                      {"angle", NormalSource::angle},
                                                      {"area", NormalSource::area}},
                                                     "normals");
            else if (name == "sign")
                options.sign = word<SignChoice>(
                    text("sign"),
                    {{"auto", SignChoice::automatic}, {"solid", SignChoice::solid}, {"sheet", SignChoice::sheet}},
                    "sign");
            else if (name == "voxel") {
                if (!value.is_none())
                    options.voxel = length(find("voxel"), "voxel");
            } else if (name == "weld") {
                if (!value.is_none())
                    options.weld = length(find("weld"), "weld");
            } else if (name == "point_size") {
                if (!value.is_none())
                    options.point_size = length(find("point_size"), "point_size");
            } else if (name == "time_limit")
                options.time_limit = value.cast<std::optional<double>>();
            else if (name == "seed")
                options.seed = value.cast<std::uint32_t>();
            else if (name == "threads")
                options.threads = value.cast<unsigned>();
            else if (name != "progress")
                throw py::type_error(name + " is not an option of bake()");
        } catch (const py::cast_error&) {
            throw py::type_error(
                fmt::format("{}: cannot be {}", std::string(py::str(key)), std::string(py::repr(value))));
        }
    options.progress = progress_for(values.contains("progress") ? find("progress") : py::none());
    return options;
}

/// The mesh of an argument; made from arrays if the argument is a pair of arrays.
class MeshArgument {
  public:
    explicit MeshArgument(const py::object& object) : object_(object) {
        if (!py::isinstance<Mesh>(object))
            made_ = to_mesh(object, "mesh");
    }
    const Mesh& get() const { return made_ ? *made_ : object_.cast<const Mesh&>(); }

  private:
    py::object object_;
    std::optional<Mesh> made_;
};

std::vector<SurfacePoint> points_of(const py::object& points, const Mesh& mesh) {
    if (!py::isinstance<py::tuple>(points) || py::len(points) < 2 || py::len(points) > 3)
        throw py::type_error("points: expected (positions, normals) or (positions, normals, faces)");
    const auto parts = points.cast<py::tuple>();
    const auto positions = rows<double>(parts[0], 3, "points[0]");
    const auto normals = rows<float>(parts[1], 3, "points[1]");
    const auto faces = parts.size() == 3 ? indices(parts[2], mesh.face_count(), "points[2]")
                                         : std::vector<std::uint32_t>(std::size_t(positions.shape(0)), no_face);
    if (normals.shape(0) != positions.shape(0) || faces.size() != static_cast<std::size_t>(positions.shape(0)))
        throw py::value_error("points: the arrays have different numbers of rows");
    std::vector<SurfacePoint> result;
    result.reserve(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const double* const p = positions.data() + 3 * i;
        const float* const n = normals.data() + 3 * i;
        result.push_back({{p[0], p[1], p[2]}, {n[0], n[1], n[2]}, faces[i]});
    }
    return result;
}

Result bake_any(const py::object& mesh_argument, const py::object& radius, const std::string& quality,
                const std::optional<double>& error, const std::string& method, const py::dict& parameters,
                const py::object& attributes, const py::list& occluders, bool ground, const std::array<double, 3>& up,
                bool self_only, const std::string& via, const std::string& normals, const std::string& sign,
                const py::object& voxel, const py::object& weld, const py::object& point_size, const py::object& points,
                std::uint32_t seed, unsigned threads, const std::optional<double>& time_limit,
                const py::object& progress) {
    using namespace py::literals;
    const MeshArgument mesh(mesh_argument);
    const BakeOptions options = options_of(
        py::dict("radius"_a = radius, "quality"_a = quality, "error"_a = error, "method"_a = method,
                 "parameters"_a = parameters, "attributes"_a = attributes, "occluders"_a = occluders,
                 "ground"_a = ground, "up"_a = up, "self_only"_a = self_only, "via"_a = via, "normals"_a = normals,
                 "sign"_a = sign, "voxel"_a = voxel, "weld"_a = weld, "point_size"_a = point_size, "seed"_a = seed,
                 "threads"_a = threads, "time_limit"_a = time_limit, "progress"_a = progress));
    const Mesh& baked_mesh = mesh.get();
    Result result;
    if (points.is_none()) {
        run([&] { result.baked = bake(baked_mesh, options); });
    } else {
        const std::vector<SurfacePoint> surface_points = points_of(points, baked_mesh);
        run([&] { result.baked = bake(baked_mesh, surface_points, options); });
    }
    return result;
}

/// Texture maps of one tile.
struct MapResult {
    BakedMaps maps;
};

MapResult bake_maps_any(const py::object& mesh_argument, const py::object& size, int subsamples,
                        const std::optional<int>& margin, int uv_set, const std::string& space, const py::list& high,
                        const py::object& reach, const py::kwargs& others) {
    const MeshArgument mesh(mesh_argument);
    const BakeOptions options = options_of(others);
    MapOptions map;
    if (py::isinstance<py::int_>(size)) {
        map.width = map.height = size.cast<int>();
    } else {
        try {
            const auto sides = size.cast<std::array<int, 2>>();
            map.width = sides[0];
            map.height = sides[1];
        } catch (const py::cast_error&) {
            throw py::type_error("size: expected a number of texels, or (width, height)");
        }
    }
    map.subsamples = subsamples;
    map.margin = margin;
    map.uv_set = uv_set;
    map.space = word<MapSpace>(space, {{"tangent", MapSpace::tangent}, {"object", MapSpace::object}}, "space");
    for (const py::handle& item : high)
        map.high.push_back(to_mesh(py::reinterpret_borrow<py::object>(item), "high"));
    if (!reach.is_none())
        map.reach = length(reach, "reach");
    const Mesh& baked_mesh = mesh.get();
    MapResult result;
    run([&] { result.maps = bake_maps(baked_mesh, options, map); });
    return result;
}

py::object layer_of(const py::object& self, Channel channel) {
    const BakedMaps& maps = self.cast<const MapResult&>().maps;
    for (const MapLayer& layer : maps.tiles.front().layers)
        if (layer.attribute == attribute_of(channel)) {
            std::vector<py::ssize_t> shape{maps.height, maps.width};
            if (info(layer.attribute).components > 1)
                shape.push_back(static_cast<py::ssize_t>(info(layer.attribute).components));
            return view(layer.values.data(), shape, self);
        }
    return py::none();
}

void add_maps(py::module_& module) {
    py::class_<MapResult> result(module, "BakedMaps",
                                 "Texture maps; rows from the top. Read-only views, without a copy.");
    for (const ChannelInfo& channel : channels)
        result.def_property_readonly(
            std::string(channel.name).c_str(),
            [id = channel.channel](const py::object& self) { return layer_of(self, id); },
            channel.components == 3 ? "(height, width, 3) float32, or None" : "(height, width) float32, or None");
    result
        .def_property_readonly(
            "coverage",
            [](const py::object& self) {
                const BakedMaps& maps = self.cast<const MapResult&>().maps;
                return view(reinterpret_cast<const std::uint8_t*>(maps.tiles.front().coverage.data()),
                            {maps.height, maps.width}, self);
            },
            "(height, width) uint8: 0 background, 1 a face, 2 the margin of an island, 3 no high mesh within reach")
        .def_property_readonly(
            "texels", [](const MapResult& r) { return r.maps.texels; }, "number of baked texels")
        .def_property_readonly(
            "overlaps", [](const MapResult& r) { return r.maps.overlaps; }, "number of texels that several faces cover")
        .def_property_readonly(
            "baked", [](const MapResult& r) { return Result{r.maps.baked}; },
            "method, rmse, radius, warnings and seconds");
    module.def("bake_maps", &bake_maps_any, py::arg("mesh"), py::kw_only(), py::arg("size") = 2048,
               py::arg("subsamples") = 1, py::arg("margin") = py::none(), py::arg("uv_set") = 0,
               py::arg("space") = "tangent", py::arg("high") = py::list(), py::arg("reach") = py::none(),
               R"(Bakes texture maps on the UVs of a mesh.

size: texels along each side, or (width, height). subsamples: samples along each side of a texel.
margin: texels to fill around islands.
uv_set: the set of UVs of a glTF file. space: "tangent" or "object", the coordinate space of directions.
high: meshes whose surface is baked instead. reach: a length, how far to look for them.
All other options are those of bake(). Returns a BakedMaps. Raises what bake() raises, and InputError if the mesh has no
UVs.)");
}

void add_result(py::module_& module) {
    py::class_<Result> result(module, "Baked", "The result of bake(). Its arrays are read-only views, without a copy.");
    for (const ChannelInfo& channel : channels)
        result.def_property_readonly(
            std::string(channel.name).c_str(),
            [id = channel.channel](const py::object& self) { return values_of(self, id); },
            channel.components == 3 ? "(n, 3) float32, or None if it was not requested"
                                    : "(n,) float32, or None if it was not requested");
    result
        .def_property_readonly(
            "method", [](const Result& r) { return r.baked.method; },
            "the method, with its number of rays or samples, such as 'guided:3'")
        .def_property_readonly(
            "rmse", [](const Result& r) { return r.baked.rmse; },
            "estimated RMSE of ao against exact rays; None if it was not measured")
        .def_property_readonly(
            "radius", [](const Result& r) { return r.baked.radius; }, "in scene units")
        .def_property_readonly(
            "warnings", [](const Result& r) { return in_python(r.baked.warnings); }, "one line each, with a fix")
        .def_property_readonly(
            "seconds",
            [](const Result& r) {
                py::dict seconds;
                seconds["grid"] = r.baked.seconds.grid;
                seconds["pilot"] = r.baked.seconds.pilot;
                seconds["occlusion"] = r.baked.seconds.occlusion;
                return seconds;
            },
            "wall-clock seconds of the stages: grid, pilot, occlusion")
        .def("__repr__", [](const Result& r) {
            return fmt::format("<alcove.Baked {} by {}{}>", names_of(r.baked.attributes), r.baked.method,
                               r.baked.rmse ? fmt::format(", RMSE about {:.2g}", *r.baked.rmse) : "");
        });
}

void add_exceptions(py::module_& module) {
    // Each exception derives from the built-in exception that callers would expect. The module and this function keep
    // these exceptions forever.
    const auto derived = [&](const char* name, PyObject* base, const char* doc) {
        PyObject* const made = PyErr_NewExceptionWithDoc(fmt::format("alcove.{}", name).c_str(), doc, base, nullptr);
        module.attr(name) = py::reinterpret_borrow<py::object>(made);
        return made;
    };
    static PyObject* const input = derived("InputError", PyExc_ValueError, "An input or an option is invalid.");
    static PyObject* const io = derived("IoError", PyExc_OSError, "A file could not be written.");
    static PyObject* const limit = derived("LimitError", PyExc_ValueError, "A request exceeds a limit.");
    static PyObject* const memory = derived("MemoryError", PyExc_MemoryError, "The system has too little memory.");
    static PyObject* const time = derived("TimeLimitError", PyExc_RuntimeError, "The time limit is too short.");
    // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 gives the type
    py::register_exception_translator([](std::exception_ptr pointer) {
        try {
            if (pointer)
                std::rethrow_exception(pointer);
        } catch (const InputError& error) {
            PyErr_SetString(input, in_python(error.what()).c_str());
        } catch (const IoError& error) {
            PyErr_SetString(io, in_python(error.what()).c_str());
        } catch (const LimitError& error) {
            PyErr_SetString(limit, in_python(error.what()).c_str());
        } catch (const alcove::MemoryError& error) {
            PyErr_SetString(memory, in_python(error.what()).c_str());
        } catch (const TimeLimitError& error) {
            PyErr_SetString(time, in_python(error.what()).c_str());
        }
    });
}

}
}

PYBIND11_MODULE(_alcove, module) {
    using namespace alcove;
    using namespace alcove::python;
    module.doc() = "Ambient occlusion on sparse signed-distance grids.";
    module.attr("__version__") = ALCOVE_VERSION;
    add_exceptions(module);
    add_mesh(module);
    add_result(module);
    add_maps(module);
    add_field(module);
    module.def("bake", &bake_any, py::arg("mesh"), py::kw_only(), py::arg("radius") = "10%",
               py::arg("quality") = "good", py::arg("error") = py::none(), py::arg("method") = "",
               py::arg("parameters") = py::dict(), py::arg("attributes") = std::vector<std::string>{"ao"},
               py::arg("occluders") = py::list(), py::arg("ground") = false,
               py::arg("up") = std::array<double, 3>{0.0, 1.0, 0.0}, py::arg("self_only") = false,
               py::arg("via") = "grid", py::arg("normals") = "auto", py::arg("sign") = "auto",
               py::arg("voxel") = py::none(), py::arg("weld") = py::none(), py::arg("point_size") = py::none(),
               py::arg("points") = py::none(), py::arg("seed") = 0, py::arg("threads") = 0,
               py::arg("time_limit") = py::none(), py::arg("progress") = py::none(),
               R"(Bakes ambient occlusion and masks at the vertices of a mesh, or at points on it.

    baked = alcove.bake(mesh, radius="10%", quality="good")
    baked.ao          # (n,) float32: 1 open, 0 fully occluded

mesh: a Mesh, or a pair (vertices, faces) of (n, 3) and (m, 3) arrays; a Mesh without faces is a set of points, which
    are baked on their reconstructed surface.
radius: maximum distance of occluders: scene units, "10%" of the diagonal, or "inf".
quality: "draft", "good" or "fine": an RMSE of at most 0.05, 0.02 or 0.005; error: any other RMSE.
method: a name from `alcove methods` instead of the planner's choice, with parameters such as {"rays": 64}.
attributes: "ao", "convexity", "bent_normal" (n, 3), "thickness" (scene units).
occluders: a list of meshes that also occlude. ground: add an occluding plane through the lowest vertex.
up: up direction for ground.
self_only: each connected part is occluded only by itself, the occluders and the ground.
via: "grid", "auto" or "mesh": the methods that the planner may choose. normals: "auto", "file", "angle" or "area".
sign: "auto", "solid" or "sheet". voxel: the edge of the finest voxel, a length.
weld: joins vertices within this length before the bake. point_size: the distance between neighbouring points of a Mesh
    without faces, a length.
points: (positions, normals) or (positions, normals, faces): bake these points instead of the vertices.
threads: 0 for one per core. time_limit: seconds; a bake that would clearly take longer is refused.
progress: called with the name of the stage and the fraction completed, on any thread; an exception that it raises ends
    the bake. So does Ctrl-C.

Returns a Baked. Raises InputError, LimitError, MemoryError or TimeLimitError. The GIL is released, so several threads
can bake at once.)");
    module.def(
        "limit_memory", &limit_memory, py::arg("bytes"),
        "Limits the memory for grids and maps; the default is half of the machine's memory. Applies to all threads.");
    module.def("limit_reading", &limit_reading, py::arg("bytes"),
               "Limits the bytes that are read from one file; the default is half of the memory limit, at most 4 GB.");
    module.def(
        "add",
        [](Mesh& mesh, const Result& result, const std::string& color) {
            return add(mesh, result.baked,
                       {.color = word<ColorUse>(color,
                                                {{"auto", ColorUse::automatic},
                                                 {"ao", ColorUse::ao},
                                                 {"multiply", ColorUse::multiply},
                                                 {"none", ColorUse::none}},
                                                "color")});
        },
        py::arg("mesh"), py::arg("baked"), py::arg("color") = "auto",
        R"(Adds baked values to the mesh, as attributes that write() stores; ao also as colours.

color: "auto" (colours, unless the mesh has its own), "ao" (replaces them), "multiply" or "none".
Returns whether colours were added.)");
}
