/// Converts NumPy arrays from and to C++, with messages that name the argument.
#pragma once

#include "alcove/base/types.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace alcove::python {

namespace py = pybind11;

/// Rows of `columns` numbers each, as C-contiguous doubles or floats; copied only if the array has another layout or
/// type. \throw py::type_error for values that are not numbers, py::value_error for the wrong shape; both messages name
/// `argument`.
template <class T>
py::array_t<T, py::array::c_style> rows(const py::object& array, py::ssize_t columns, const std::string& argument);

/// Whole numbers in [0, limit). \throw as rows()
std::vector<std::uint32_t> indices(const py::object& array, std::size_t limit, const std::string& argument);

/// An array that takes over the vector without a copy. If there is one column, the array has one dimension.
py::array_t<float> to_array(std::vector<float> values, std::size_t columns = 1);

/// A read-only view of memory that `owner` keeps alive.
template <class T>
py::array view(const T* values, std::vector<py::ssize_t> shape, const py::object& owner) {
    py::array_t<T> array(std::move(shape), values, owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

/// A length: a number in scene units, or a text such as "10%".
Length length(const py::object& value, const std::string& argument);

}
