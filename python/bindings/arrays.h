// SPDX-License-Identifier: MIT
// Conversion between numpy and the golden models: dtypes of packets from their fields, arrays that
// refer to a model's memory without a copy, and checked arguments.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "golden/c/handle.h"

namespace deburr::python {

namespace py = pybind11;

template <class T>
py::dtype dtype_of();

// The members of a record at the offsets that the compiler chose.
class DtypeFields {
 public:
  explicit DtypeFields(const void* record) : record_(static_cast<const std::byte*>(record)) {}
  template <class Member, class... Description>
  void operator()(const char* name, const Member& member, const Description&...) {
    names_.append(name);
    formats_.append(dtype_of<Member>());
    offsets_.append(reinterpret_cast<const std::byte*>(&member) - record_);
  }
  py::dtype dtype(std::size_t size) const {
    return {names_, formats_, offsets_, static_cast<py::ssize_t>(size)};
  }

 private:
  const std::byte* record_;
  py::list names_, formats_, offsets_;
};

// A record that does not list its fields has a function record_fields(record, visit) here.
template <class Record, class Visit>
void visit_fields(const Record& record, Visit& visit) {
  if constexpr (requires { Record::fields(record, visit); }) {
    Record::fields(record, visit);
  } else {
    record_fields(record, visit);
  }
}

template <class T>
struct IsArray : std::false_type {};
template <class Element, std::size_t N>
struct IsArray<std::array<Element, N>> : std::true_type {};

template <class T>
py::dtype dtype_of() {
  if constexpr (std::is_enum_v<T>) {
    return py::dtype::of<std::underlying_type_t<T>>();
  } else if constexpr (std::is_arithmetic_v<T>) {
    return py::dtype::of<T>();
  } else if constexpr (IsArray<T>::value) {
    return py::dtype::from_args(
        py::make_tuple(dtype_of<typename T::value_type>(), py::make_tuple(std::tuple_size_v<T>)));
  } else {
    const T record{};
    DtypeFields fields(&record);
    visit_fields(record, fields);
    return fields.dtype(sizeof(T));
  }
}

using Shape = std::vector<py::ssize_t>;

// A read-only array that keeps `owner` alive.
template <class T>
py::array view(const std::vector<T>& values, Shape shape, const py::handle& owner) {
  const py::dtype dtype = dtype_of<T>();
  // numpy turns the dimensions of a dtype's subarray into array dimensions and is given its
  // strides.
  py::array array(dtype, std::move(shape), values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}
template <class T>
py::array view(const std::vector<T>& values, const py::handle& owner) {
  return view(values, {static_cast<py::ssize_t>(values.size())}, owner);
}
// An array that owns its values.
template <class T>
py::array owned(std::vector<T>&& values, Shape shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return {dtype_of<T>(), std::move(shape), kept->data(), owner};
}
template <class T>
py::array owned(std::vector<T>&& values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return owned(std::move(values), {size});
}

// "float64 of (480, 640, 3)", "None".
std::string described(const py::handle& given);

// ArgumentError: "pixels: expected uint8 of (height, width, 4), got None".
[[noreturn]] void reject_array(std::string_view name, std::string_view wanted,
                               const py::handle& given);
// A C-contiguous array of this dtype and number of dimensions.
py::array checked(const py::handle& given, std::string_view name, const py::dtype& dtype,
                  py::ssize_t dimensions, std::string_view wanted);
// The elements of a one-dimensional array.
template <class T>
std::span<const T> elements(const py::array& array) {
  return {static_cast<const T*>(array.data()), static_cast<std::size_t>(array.size())};
}
template <class T>
py::array checked_list(const py::handle& given, std::string_view name, std::string_view wanted) {
  return checked(given, name, dtype_of<T>(), 1, wanted);
}

}  // namespace deburr::python
