#include "arrays.h"

#include <fmt/format.h>

namespace alcove::python {
namespace {

std::string shape_text(const py::array& array) {
    return py::str(array.attr("shape"));
}

py::array numeric(const py::object& object, const std::string& argument, const char* kinds, const char* wanted) {
    py::array array;
    try {
        array = py::array::ensure(object);
    } catch (const py::error_already_set&) {
        PyErr_Clear();
    }
    if (!array)
        throw py::type_error(fmt::format("{}: expected an array of {}", argument, wanted));
    const char kind = array.dtype().kind();
    if (std::string(kinds).find(kind) == std::string::npos && array.size() > 0)
        throw py::type_error(fmt::format("{}: expected {}, not values of type {}", argument, wanted,
                                         std::string(py::str(array.dtype()))));
    return array;
}

}

template <class T>
py::array_t<T, py::array::c_style> rows(const py::object& object, py::ssize_t columns, const std::string& argument) {
    const py::array array = numeric(object, argument, "fiu", "numbers");
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw py::value_error(
            fmt::format("{}: expected the shape (n, {}), not {}", argument, columns, shape_text(array)));
    return py::array_t<T, py::array::c_style | py::array::forcecast>(array);
}
template py::array_t<float, py::array::c_style> rows<float>(const py::object&, py::ssize_t, const std::string&);
template py::array_t<double, py::array::c_style> rows<double>(const py::object&, py::ssize_t, const std::string&);

namespace {

template <class T>
std::vector<std::uint32_t> checked(const py::array& array, std::size_t limit, const std::string& argument) {
    const py::array_t<T, py::array::c_style | py::array::forcecast> numbers(array);
    std::vector<std::uint32_t> result(static_cast<std::size_t>(numbers.size()));
    const T* const values = numbers.data();
    for (std::size_t i = 0; i < result.size(); ++i) {
        if (values[i] < 0 || static_cast<std::size_t>(values[i]) >= limit)
            throw py::value_error(fmt::format("{}: element {} is {}, not from 0 to {}", argument, i, values[i],
                                              limit == 0 ? 0 : limit - 1));
        result[i] = static_cast<std::uint32_t>(values[i]);
    }
    return result;
}

}

std::vector<std::uint32_t> indices(const py::object& object, std::size_t limit, const std::string& argument) {
    const py::array array = numeric(object, argument, "iu", "whole numbers");
    // The usual types are not copied. All other types are converted to 64 bits.
    if (py::isinstance<py::array_t<std::uint32_t>>(array))
        return checked<std::uint32_t>(array, limit, argument);
    if (py::isinstance<py::array_t<std::int32_t>>(array))
        return checked<std::int32_t>(array, limit, argument);
    return checked<std::int64_t>(array, limit, argument);
}

py::array_t<float> to_array(std::vector<float> values, std::size_t columns) {
    auto* const kept = new std::vector<float>(std::move(values));
    const py::capsule owner(kept, [](void* vector) { delete static_cast<std::vector<float>*>(vector); });
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(kept->size() / columns)};
    if (columns > 1)
        shape.push_back(static_cast<py::ssize_t>(columns));
    return py::array_t<float>(shape, kept->data(), owner);
}

Length length(const py::object& value, const std::string& argument) {
    try {
        if (py::isinstance<py::str>(value))
            return Length(value.cast<std::string>());
        const auto number = value.cast<double>();
        if (!(number > 0.0))
            throw InputError(fmt::format("takes a positive length, not {}", number));
        return Length(number);
    } catch (const py::cast_error&) {
        throw py::type_error(argument + ": expected a number, or a text such as '10%'");
    } catch (const InputError& error) {
        throw InputError(argument + " " + error.what());
    }
}

}
