// SPDX-License-Identifier: MIT
// The module deburr._golden: the golden models used by deburr.golden and deburr.ideal.
#include "python/bindings/module.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>

#include "golden/c/handle.h"
#include "python/bindings/frames.h"
#include "spec/error.h"
#include "spec/poll.h"

namespace deburr::python {

std::string text_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.ptr() == Py_True ? "true" : "false";
  // numpy scalars become Python scalars first.
  if (py::hasattr(value, "item") && !py::isinstance<py::array>(value))
    return text_of(value.attr("item")());
  return py::cast<std::string>(py::str(value));
}

std::string spelled(std::string_view name, std::span<const std::string> names) {
  for (const std::string& known : names) {
    std::string flat = known;
    std::replace(flat.begin(), flat.end(), '.', '_');
    if (flat == name) return known;
  }
  return std::string(name);
}

void ParameterRows::add(std::string_view name, const py::object& value, const std::string& range,
                        std::string_view unit, std::string_view meaning) {
  py::dict row;
  row["name"] = std::string(name);
  row["default"] = value;
  row["range"] = range;
  row["unit"] = std::string(unit);
  row["meaning"] = std::string(meaning);
  rows.append(row);
}

Figures figures(const py::dict& values) {
  return Figures(py::module_::import("deburr._figures").attr("Figures")(values));
}

Figures figures(std::span<const golden::c::Counter> counters) {
  py::dict values;
  for (const golden::c::Counter& counter : counters) values[py::str(counter.name)] = counter.value;
  return figures(values);
}

namespace {

// Takes the GIL only now and then: other threads may hold it for some milliseconds.
void check_signals() {
  using std::chrono::steady_clock;
  constexpr auto kPeriod = std::chrono::milliseconds(50);
  static thread_local steady_clock::time_point next;
  const auto now = steady_clock::now();
  if (now < next) return;
  next = now + kPeriod;
  const py::gil_scoped_acquire own_turn;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// Errors in arguments raise ValueError; errors of the models raise RuntimeError.
void translate(std::exception_ptr exception) {
  try {
    if (exception) std::rethrow_exception(exception);
  } catch (const golden::c::ArgumentError& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  } catch (const spec::ConfigError& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  } catch (const std::length_error&) {
    PyErr_NoMemory();
  } catch (const spec::CheckFailed& error) {
    const std::string text = std::string("a fault of the model, please report it: ") + error.what();
    PyErr_SetString(PyExc_RuntimeError, text.c_str());
  }
}

}  // namespace

WithoutGil::WithoutGil() { spec::poll_function = &check_signals; }
WithoutGil::~WithoutGil() { spec::poll_function = nullptr; }

PYBIND11_MODULE(_golden, module) {
  module.doc() = "The golden models of deburr.golden and deburr.ideal.";
  module.attr("version") = DEBURR_VERSION;
  py::register_exception_translator(translate);
  module.def("check_depths", [](const py::array& depths, py::ssize_t level) {
    check_depths(py::array::ensure(depths, py::array::c_style), level);
  });
  add_engines(module);
  add_ideal(module);
}

}  // namespace deburr::python
