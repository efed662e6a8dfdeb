// SPDX-License-Identifier: MIT
// Inputs of the smoothing engines: pixels and depths.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <unordered_set>
#include <utility>
#include <vector>

#include "golden/morphological/planes.h"
#include "python/bindings/arrays.h"

namespace deburr::python {

using Rgba8 = std::array<std::uint8_t, 4>;

// The views refer to the arrays, or to a copy where the layout differs.
struct FramePixels {
  py::array array;
  golden::morphological::ViewOf<Rgba8> view;
};
FramePixels frame_pixels(const py::handle& given);

// Depths of a frame: near / w, 0..1, as float32, or U24 codes as uint32.
struct FrameDepth {
  std::vector<std::uint32_t> codes;
  golden::morphological::ViewOf<std::uint32_t> view;  // empty: no depth was given
};
// Raises a ValueError or a warning by spec/depth_check.h. `depths` is float32 or uint32, in rows
// without gaps. The warning names the caller at this stack level: 1 is the calling Python function,
// 2 its caller.
void check_depths(const py::array& depths, py::ssize_t level);
FrameDepth frame_depth(const py::handle& given, int width, int height);

// A class of results, whose properties are also what is pickled. Frame has `golden`, `detail` and
// `kept`: the properties of an unpickled frame, which has no model.
template <class Frame>
class ResultClass {
 public:
  ResultClass(py::module_& module, const char* name, const char* meaning)
      : class_(module, name, meaning) {}
  ~ResultClass() {
    class_.def_property_readonly("detail", [](const Frame& frame) { return frame.detail; });
    class_.def(py::pickle([all = all_](const py::object& self) { return state(all, self); },
                          [](const py::dict& state) {
                            for (const auto& [name, value] : state)
                              if (py::isinstance<py::array>(value))
                                value.attr("setflags")(py::arg("write") = false);
                            Frame frame;
                            frame.kept = state;
                            frame.detail = py::cast<bool>(state["detail"]);
                            return frame;
                          }));
  }
  ResultClass(const ResultClass&) = delete;
  ResultClass& operator=(const ResultClass&) = delete;

  // `get(frame, self)`; arrays that refer to the model keep `self` alive.
  template <class Get>
  ResultClass& property(const char* name, const char* meaning, Get get) {
    return add(name, false, meaning, std::move(get));
  }
  // Recorded only with detail.
  template <class Get>
  ResultClass& detail(const char* name, const char* meaning, Get get) {
    return add(name, true, meaning, std::move(get));
  }

 private:
  struct Property {
    const char* name;
    bool detail;
  };
  template <class Get>
  ResultClass& add(const char* name, bool detail, const char* meaning, Get get) {
    using Value = std::invoke_result_t<Get, const Frame&, const py::object&>;
    class_.def_property_readonly(
        name,
        [name, detail, get](const py::object& self) -> Value {
          const auto& frame = py::cast<const Frame&>(self);
          golden::c::require(!detail || frame.detail,
                             std::string(name) + " were not recorded: give detail=True");
          if (!frame.kept) return get(frame, self);
          const py::object value = frame.kept[name];
          if constexpr (std::is_base_of_v<py::object, Value>)
            return Value(value);
          else
            return py::cast<Value>(value);
        },
        meaning);
    all_.push_back({name, detail});
    return *this;
  }
  static py::dict state(const std::vector<Property>& all, const py::object& self) {
    py::dict state;
    state["detail"] = self.attr("detail");
    for (const Property& each : all)
      if (!each.detail || py::cast<const Frame&>(self).detail)
        state[each.name] = self.attr(each.name);
    return state;
  }

  py::class_<Frame> class_;
  std::vector<Property> all_;
};

// A predicate: memory answers the line at this address with an error. `given` lists the addresses.
std::function<bool(std::uint32_t)> error_lines(const py::handle& given);

}  // namespace deburr::python
