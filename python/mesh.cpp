// Mesh, read() and write().
#include "arrays.h"
#include "bindings.h"
#include "messages.h"
#include "run.h"

#include "alcove/mesh/files.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstring>
#include <filesystem>

namespace alcove::python {
namespace {

static_assert(sizeof(Vec3d) == 3 * sizeof(double) && sizeof(Vec3) == 3 * sizeof(float) &&
              sizeof(Vec2) == 2 * sizeof(float));

py::ssize_t signed_size(std::size_t size) {
    return static_cast<py::ssize_t>(size);
}

bool is_pair(const py::object& object) {
    return py::isinstance<py::tuple>(object) && py::len(object) == 2;
}

void set_faces(Mesh& mesh, const py::object& faces) {
    if (faces.is_none())
        return;
    if (is_pair(faces)) { // corners and offsets of polygons
        const auto pair = faces.cast<py::tuple>();
        mesh.corners = indices(pair[0], mesh.vertex_count(), "faces[0]");
        mesh.face_begin = indices(pair[1], mesh.corners.size() + 1, "faces[1]");
        if (mesh.face_begin.empty() || mesh.face_begin.front() != 0 || mesh.face_begin.back() != mesh.corners.size() ||
            !std::is_sorted(mesh.face_begin.begin(), mesh.face_begin.end()))
            throw py::value_error(
                fmt::format("faces[1]: offsets must rise from 0 to the number of corners, {}", mesh.corners.size()));
        return;
    }
    const py::array array = py::array::ensure(faces);
    if (!array || array.ndim() != 2 || array.shape(1) < 3)
        throw py::value_error(
            fmt::format("faces: expected the shape (m, 3) or (m, k), or a pair (corners, offsets), not {}",
                        array ? std::string(py::str(array.attr("shape"))) : "this"));
    mesh.corners = indices(faces, mesh.vertex_count(), "faces");
    const auto corners = static_cast<std::uint32_t>(array.shape(1));
    mesh.face_begin.resize(static_cast<std::size_t>(array.shape(0)) + 1);
    for (std::uint32_t f = 0; f < mesh.face_begin.size(); ++f)
        mesh.face_begin[f] = f * corners;
}

Mesh make_mesh(const py::object& vertices, const py::object& faces, const py::object& normals, const py::object& uvs,
               const py::object& corner_normals, const py::object& corner_uvs) {
    Mesh mesh;
    const auto positions = rows<double>(vertices, 3, "vertices");
    mesh.positions.resize(static_cast<std::size_t>(positions.shape(0)));
    if (!mesh.positions.empty())
        std::memcpy(&mesh.positions.front().x, positions.data(), mesh.positions.size() * sizeof(Vec3d));
    set_faces(mesh, faces);
    const auto set = [&](auto& to, const py::object& from, py::ssize_t columns, const char* argument, std::size_t count,
                         const char* what) {
        if (from.is_none())
            return;
        const auto values = rows<float>(from, columns, argument);
        if (static_cast<std::size_t>(values.shape(0)) != count)
            throw py::value_error(fmt::format("{}: {} rows for {} {}", argument, values.shape(0), count, what));
        to.resize(static_cast<std::size_t>(values.shape(0)));
        if (!to.empty())
            std::memcpy(&to.front().x, values.data(), to.size() * sizeof(to.front()));
    };
    set(mesh.normals, normals, 3, "normals", mesh.vertex_count(), "vertices");
    set(mesh.vertex_uvs, uvs, 2, "uvs", mesh.vertex_count(), "vertices");
    set(mesh.corner_normals, corner_normals, 3, "corner_normals", mesh.corners.size(), "corners");
    set(mesh.corner_uvs, corner_uvs, 2, "corner_uvs", mesh.corners.size(), "corners");
    if (!mesh.vertex_uvs.empty() && !mesh.corner_uvs.empty())
        throw py::value_error("uvs and corner_uvs: give one of them");
    return mesh;
}

py::object faces_of(const py::object& self) {
    const auto& mesh = self.cast<const Mesh&>();
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        if (mesh.face(f).size() != 3)
            return py::none();
    return view(mesh.corners.data(), {signed_size(mesh.face_count()), 3}, self);
}

std::string summary(const Mesh& mesh) {
    return fmt::format("<alcove.Mesh {}{} vertices, {} faces>", mesh.name.empty() ? "" : mesh.name + ": ",
                       mesh.vertex_count(), mesh.face_count());
}

py::object optional_view(const py::object& self, const auto& values, py::ssize_t columns) {
    if (values.empty())
        return py::none();
    return view(&values.front().x, {signed_size(values.size()), columns}, self);
}

}

Mesh to_mesh(const py::object& object, const std::string& argument) {
    if (py::isinstance<Mesh>(object))
        return object.cast<const Mesh&>();
    if (is_pair(object)) {
        const auto pair = object.cast<py::tuple>();
        return make_mesh(pair[0], pair[1], py::none(), py::none(), py::none(), py::none());
    }
    throw py::type_error(argument + ": expected a Mesh, or a pair of arrays (vertices, faces)");
}

void add_mesh(py::module_& module) {
    py::class_<Mesh>(module, "Mesh", R"(A polygon mesh, or points if it has no faces.

Mesh(vertices, faces=None, normals=None, uvs=None, corner_normals=None, corner_uvs=None)

vertices: (n, 3) numbers, copied once as float64. faces: (m, 3) or (m, k) whole numbers, or a pair (corners, offsets)
for polygons: face i has the vertices corners[offsets[i]:offsets[i + 1]]. normals: (n, 3). uvs: (n, 2).
corner_normals, corner_uvs: the same per corner.
The arrays that its properties return are read-only views, without a copy.)")
        .def(py::init(&make_mesh), py::arg("vertices"), py::arg("faces") = py::none(), py::arg("normals") = py::none(),
             py::arg("uvs") = py::none(), py::arg("corner_normals") = py::none(), py::arg("corner_uvs") = py::none())
        .def_property_readonly(
            "vertices",
            [](const py::object& self) {
                const auto& mesh = self.cast<const Mesh&>();
                return view(reinterpret_cast<const double*>(mesh.positions.data()),
                            {signed_size(mesh.vertex_count()), 3}, self);
            },
            "(n, 3) float64, in scene units")
        .def_property_readonly("faces", &faces_of,
                               "(m, 3) uint32; None if a face is not a triangle: see corners, offsets")
        .def_property_readonly(
            "corners",
            [](const py::object& self) {
                const auto& mesh = self.cast<const Mesh&>();
                return view(mesh.corners.data(), {signed_size(mesh.corners.size())}, self);
            },
            "uint32: the vertices of one face after another")
        .def_property_readonly(
            "offsets",
            [](const py::object& self) {
                const auto& mesh = self.cast<const Mesh&>();
                return view(mesh.face_begin.data(), {signed_size(mesh.face_begin.size())}, self);
            },
            "(m + 1,) uint32: where the faces begin in corners")
        .def_property_readonly(
            "normals", [](const py::object& self) { return optional_view(self, self.cast<const Mesh&>().normals, 3); },
            "(n, 3) float32: the normals that it was read or made with; or None")
        .def_property_readonly(
            "uvs", [](const py::object& self) { return optional_view(self, self.cast<const Mesh&>().vertex_uvs, 2); },
            "(n, 2) float32, v upwards; or None")
        .def_property_readonly(
            "name", [](const Mesh& mesh) { return mesh.name; }, "the file that it was read from")
        .def_property_readonly(
            "warnings", [](const Mesh& mesh) { return in_python(mesh.warnings); }, "what the reader had to leave out")
        .def(
            "attribute",
            [](const Mesh& mesh, const std::string& name) {
                const Attribute* attribute = mesh.find_attribute(name);
                if (attribute == nullptr)
                    throw py::key_error("no attribute " + name + " was added");
                return to_array(attribute->values, static_cast<std::size_t>(attribute->components));
            },
            py::arg("name"), "(n,) or (n, k) float32: a copy of values that add() or set_attribute() added")
        .def(
            "set_attribute",
            [](Mesh& mesh, const std::string& name, const py::object& values) {
                py::array array = py::array::ensure(values);
                const bool is_flat = array && array.ndim() == 1;
                const auto table = rows<float>(is_flat ? array.reshape({array.shape(0), py::ssize_t(1)}) : values,
                                               is_flat || !array || array.ndim() != 2 ? 1 : array.shape(1), "values");
                if (static_cast<std::size_t>(table.shape(0)) != mesh.vertex_count())
                    throw py::value_error(
                        fmt::format("values: {} rows for {} vertices", table.shape(0), mesh.vertex_count()));
                mesh.set_attribute(
                    {name, static_cast<int>(table.shape(1)), {table.data(), table.data() + table.size()}});
            },
            py::arg("name"), py::arg("values"), "Adds one value, or k values, per vertex, which write() stores")
        .def("__repr__", &summary);
    module.def(
        "read",
        [](const std::filesystem::path& file) {
            Mesh mesh;
            run([&] { mesh = read_mesh(file); });
            return mesh;
        },
        py::arg("file"), R"(Reads a mesh: PLY, OBJ, OFF, STL or glTF. A PLY without faces is a set of points.

Raises InputError; its message names the file, the line or byte, and a fix.)");
    module.def(
        "write",
        [](const Mesh& mesh, const std::filesystem::path& file) {
            std::vector<std::string> messages;
            run([&] { messages = write_mesh(mesh, file); }, Gil::kept);
            return in_python(std::move(messages));
        },
        py::arg("mesh"), py::arg("file"), R"(Writes a mesh as PLY, OBJ or glTF; everything in its file is kept.

The file is written completely or not at all. Returns what the format could not store, as messages. Raises InputError
for any other extension, and IoError if the file cannot be written.)");
}

}
