// SPDX-License-Identifier: MIT
// Shared by the parts of the module `deburr._golden`: parameters, figures, errors.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/c/parameter_texts.h"
#include "spec/check_build.h"

namespace deburr::python {

namespace py = pybind11;

// The value of a parameter as a command line has it.
std::string text_of(const py::handle& value);
// Maps a Python name ('_' for '.') to one of `names`; returns an unknown name unchanged.
std::string spelled(std::string_view name, std::span<const std::string> names);

template <class Parameters>
void set_all(golden::c::ParameterTexts<Parameters>& texts, const py::dict& given) {
  for (const auto& [name, value] : given)
    texts.set(spelled(py::cast<std::string>(name), texts.names()), text_of(value));
}

// A visitor (spec/parameters.h) that lists parameters: name, default, range, unit, meaning.
class ParameterRows {
 public:
  void integer(std::string_view name, std::int32_t value, std::int32_t min, std::int32_t max,
               std::string_view unit, std::string_view meaning) {
    add(name, py::int_(value), std::to_string(min) + ".." + std::to_string(max), unit, meaning);
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum value, const std::array<std::string_view, N>& names,
              std::string_view meaning) {
    std::string range;
    for (const std::string_view one : names) {
      if (!range.empty()) range += " | ";
      range += one;
    }
    add(name, py::str(std::string(names[static_cast<std::size_t>(value)])), range, "", meaning);
  }
  void boolean(std::string_view name, bool value, std::string_view meaning) {
    add(name, py::bool_(value), "true | false", "", meaning);
  }
  py::list rows;

 private:
  void add(std::string_view name, const py::object& value, const std::string& range,
           std::string_view unit, std::string_view meaning);
};
template <class Parameters>
py::list parameter_rows(Parameters parameters) {
  ParameterRows visitor;
  describe(parameters, visitor);
  return visitor.rows;
}

// A dictionary whose keys are attributes too (deburr/_figures.py). It has its own type so that
// signatures name it.
struct Figures : py::object {
  explicit Figures(py::object figures) : py::object(std::move(figures)) {}
};
Figures figures(const py::dict& values);
Figures figures(std::span<const golden::c::Counter> counters);
template <class Bins>
void add_bins(py::dict& all, const Bins& bins) {
  for (const auto& bin : bins) all[py::str(bin.name)] = bin.hits;
}

// Releases the GIL while a model runs. Ctrl-C ends the model with KeyboardInterrupt, between two
// rows (spec/poll.h).
class WithoutGil {
 public:
  WithoutGil();
  ~WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  py::gil_scoped_release release_;
};

// Registers the submodules: one per engine with bindings, and the ideal filters.
void add_engines(py::module_& module);
void add_ideal(py::module_& module);

}  // namespace deburr::python

template <>
struct pybind11::detail::handle_type_name<deburr::python::Figures> {
  static constexpr auto name = const_name("deburr._figures.Figures");
};
