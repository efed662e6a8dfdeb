// SPDX-License-Identifier: MIT
#include "python/bindings/arrays.h"

namespace deburr::python {

std::string described(const py::handle& given) {
  if (given.is_none()) return "None";
  if (!py::isinstance<py::array>(given))
    return "an object of type " +
           py::cast<std::string>(py::type::handle_of(given).attr("__name__"));
  return py::cast<std::string>(py::str(given.attr("dtype"))) + " of " +
         py::cast<std::string>(py::str(given.attr("shape")));
}

void reject_array(std::string_view name, std::string_view wanted, const py::handle& given) {
  throw golden::c::ArgumentError(std::string(name) + ": expected " + std::string(wanted) +
                                 ", got " + described(given));
}

py::array checked(const py::handle& given, std::string_view name, const py::dtype& dtype,
                  py::ssize_t dimensions, std::string_view wanted) {
  if (!py::isinstance<py::array>(given)) reject_array(name, wanted, given);
  const auto array = py::reinterpret_borrow<py::array>(given);
  if (array.ndim() != dimensions || !array.dtype().equal(dtype)) reject_array(name, wanted, given);
  constexpr int kOrdered = int{py::array::c_style} | int{py::detail::npy_api::NPY_ARRAY_ALIGNED_};
  auto ordered = py::array::ensure(array, kOrdered);
  if (!ordered) throw py::error_already_set();
  return ordered;
}

}  // namespace deburr::python
